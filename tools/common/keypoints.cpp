// SPDX-License-Identifier: Apache-2.0

#include "keypoints.hpp"

#include <algorithm>

#include "metrics.hpp"
#include "opencv2/features2d.hpp"

namespace iib_tools {
namespace {

bool rosInside(const cv::Point2d& centre, float radius, cv::Size size)
{
    return centre.x >= radius && centre.y >= radius && centre.x <= size.width - radius &&
           centre.y <= size.height - radius;
}

}  // namespace

std::vector<cv::KeyPoint> sampleUniformly(const std::vector<cv::KeyPoint>& keypoints, int count)
{
    if (int(keypoints.size()) <= count)
        return keypoints;
    std::vector<cv::KeyPoint> sample;
    for (int i = 0; i < count; i++)
        sample.push_back(keypoints[size_t(uint64(i) * keypoints.size() / count)]);
    return sample;
}

SeedPoints projectSeeds(const std::vector<cv::KeyPoint>& reference, const cv::Matx33d& homography,
        cv::Size referenceSize, cv::Size targetSize, float radius, int count)
{
    std::vector<cv::KeyPoint> visible;
    for (const cv::KeyPoint& keypoint : reference)
        if (rosInside(keypoint.pt, radius, referenceSize) &&
                rosInside(project(homography, keypoint.pt), radius, targetSize))
            visible.push_back(keypoint);

    SeedPoints seeds;
    seeds.reference = sampleUniformly(visible, count);
    for (size_t i = 0; i < seeds.reference.size(); i++)
    {
        seeds.reference[i].angle = -1;
        seeds.reference[i].response = float(i);
        seeds.target.push_back(seeds.reference[i]);
        seeds.target[i].pt = project(homography, seeds.reference[i].pt);
    }
    return seeds;
}

std::vector<cv::KeyPoint> fastCorners(const cv::Mat& image, float radius, int count)
{
    std::vector<cv::KeyPoint> corners;
    for (int threshold = 20; threshold > 0; threshold /= 2)
    {
        cv::FAST(image, corners, threshold, true);
        const auto inside = std::count_if(corners.begin(), corners.end(),
                [&](const cv::KeyPoint& k) { return rosInside(k.pt, radius, image.size()); });
        if (inside >= count)
            break;
    }
    return corners;
}

SeedPoints fastSeeds(const cv::Mat& reference, const cv::Mat& target, const cv::Matx33d& homography,
        float radius, int count)
{
    std::vector<cv::KeyPoint> corners = fastCorners(reference, radius, count);
    for (cv::KeyPoint& corner : corners)
        corner.size = 2 * radius;
    return projectSeeds(corners, homography, reference.size(), target.size(), radius, count);
}

void orientByCentroid(const cv::Mat& image, float radius, std::vector<cv::KeyPoint>& keypoints)
{
    const int r = cvFloor(radius);
    for (cv::KeyPoint& keypoint : keypoints)
    {
        const cv::Point centre(cvRound(keypoint.pt.x), cvRound(keypoint.pt.y));
        double mx = 0, my = 0;
        for (int dy = -r; dy <= r; dy++)
            for (int dx = -r; dx <= r; dx++)
            {
                const cv::Point at(centre.x + dx, centre.y + dy);
                if (dx * dx + dy * dy > r * r || !cv::Rect(cv::Point(), image.size()).contains(at))
                    continue;
                mx += dx * image.at<uchar>(at);
                my += dy * image.at<uchar>(at);
            }
        keypoint.angle = cv::fastAtan2(float(my), float(mx));
    }
}

}  // namespace iib_tools

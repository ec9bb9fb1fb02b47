// SPDX-License-Identifier: Apache-2.0

#include "keypoints.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

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

void readKeypoints(const std::string& file, std::vector<cv::KeyPoint>& keypoints, cv::Mat& descriptors)
{
    std::ifstream in(file);
    if (!in)
        CV_Error(cv::Error::StsObjectNotFound, file + ": cannot be read");
    keypoints.clear();
    descriptors.release();
    std::string line, field;
    for (int number = 1; std::getline(in, line); number++)
    {
        std::vector<float> v;
        bool bad = false;
        std::istringstream fields(line.substr(0, line.find_last_not_of('\r') + 1));
        while (std::getline(fields, field, ','))
        {
            char* end = nullptr;
            v.push_back(std::strtof(field.c_str(), &end));
            bad = bad || end == field.c_str() || *end != '\0' || !std::isfinite(v.back());
        }
        if (number == 1 && line.compare(0, 3, "x,y") == 0)
            continue;
        if (bad || v.size() < 5 || v[2] <= 0 || (descriptors.rows && int(v.size()) != descriptors.cols + 5) ||
                (v.size() > 5 && int(keypoints.size()) != descriptors.rows))
            CV_Error(cv::Error::StsParseError,
                    file + ", line " + std::to_string(number) +
                            ": not x,y,size,angle,response with a size above 0, and "
                            "as many numbers behind it as in other lines");
        keypoints.push_back(cv::KeyPoint(v[0], v[1], v[2], v[3], v[4]));
        if (v.size() > 5)
            descriptors.push_back(cv::Mat(v, true).reshape(1, 1).colRange(5, int(v.size())));
    }
}

}  // namespace iib_tools

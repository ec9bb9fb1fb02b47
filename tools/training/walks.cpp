// SPDX-License-Identifier: Apache-2.0

#include "walks.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/dataset.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

const double DEPTH_TOLERANCE = 0.02;  // relative difference of depth of a point that both pictures see

//! Whether a picture is one of the first two of four: this gives steps of one and three to five, and few repeated views.
bool isUsed(const ViewFolder& walk, int k) { return k % 4 < 2 && fs::exists(depthFile(walk.views[k].file)); }

}  // namespace

std::vector<ViewPair> findWalkPairs(const std::vector<std::string>& roots, int farthest)
{
    std::vector<ViewPair> pairs;
    for (const auto& place : findViewFolders(roots))
        for (const ViewFolder& from : place.second)
            for (const ViewFolder& to : place.second)
                for (int a = 0; a < int(from.views.size()); a++)
                    for (int b = std::max(0, a - farthest);
                            b <= std::min(int(to.views.size()) - 1, a + farthest); b++)
                        if (a != b && isUsed(from, a) && isUsed(to, b))
                            pairs.push_back(
                                    pairOf(baseName(fs::getParent(place.first)) + "/" + baseName(place.first),
                                            from, from.views[a], to, to.views[b]));
    return pairs;
}

cv::KeyPoint Relief::project(const cv::KeyPoint& keypoint) const
{
    cv::KeyPoint seen = keypoint;
    seen.size = 0;
    const cv::Rect picture(cv::Point(), reference.size());
    const cv::Point from(cvRound(keypoint.pt.x), cvRound(keypoint.pt.y));
    const double depth = picture.contains(from) ? reference(from) : 0;
    if (depth == 0 || depth == USHRT_MAX)
        return seen;
    const cv::Vec3d ray = camera.inv() * cv::Vec3d(keypoint.pt.x, keypoint.pt.y, 1);
    const cv::Vec3d there = rotation * ray * depth + translation, image = camera * there;
    if (!(there[2] > 0))
        return seen;
    seen.pt = cv::Point2f(float(image[0] / image[2]), float(image[1] / image[2]));
    const cv::Point to(cvRound(seen.pt.x), cvRound(seen.pt.y));
    if (picture.contains(to) && std::abs(target(to) - there[2]) <= DEPTH_TOLERANCE * there[2])
        seen.size = float(keypoint.size * depth / there[2]);
    return seen;
}

void Relief::mirror()
{
    const cv::Matx33d flip(-1, 0, 0, 0, 1, 0, 0, 0, 1);
    cv::flip(reference, reference, 1);
    cv::flip(target, target, 1);
    camera(0, 2) = reference.cols - 1 - camera(0, 2);
    rotation = flip * rotation * flip;
    translation = flip * translation;
}

Relief loadRelief(const ViewPair& pair)
{
    cv::Mat depths[2];
    const std::string files[2] = {depthFile(pair.referenceFile), depthFile(pair.targetFile)};
    for (int i = 0; i < 2; i++)
    {
        depths[i] = readImage(files[i], cv::IMREAD_UNCHANGED);
        if (depths[i].type() != CV_16U || depths[i].size() != depths[0].size())
            CV_Error(cv::Error::StsBadArg, files[i] + ": not a 16-bit depth map of the picture's size");
    }
    return {depths[0], depths[1], pair.referenceCamera, pair.rotation, pair.translation / DEPTH_STEP};
}

}  // namespace iib_tools

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "detected_matches.hpp"

namespace opencv_test {

DetectedMatches matchDetected(const Ptr<Feature2D>& detector, const Mat images[2], int most)
{
    const Ptr<IIB> iib = IIB::create(IIB::scaleFactorFor(detector));
    std::vector<KeyPoint> keypoints[2];
    Mat descriptors[2];
    for (int i = 0; i < 2; i++)
    {
        detector->detect(images[i], keypoints[i]);
        KeyPointsFilter::retainBest(keypoints[i], most);
        descriptors[i] = describe(*iib, images[i], keypoints[i]);
    }
    std::vector<DMatch> matches;
    HierarchicalMatcher::create(iib->levelSizes(), HierarchicalMatcher::EXACT, 0.35f, true)
            ->match(descriptors[0], descriptors[1], matches);
    int correct = 0;
    for (const DMatch& m : matches)
        correct += cv::norm(keypoints[0][m.queryIdx].pt - keypoints[1][m.trainIdx].pt) <= 3;
    return {{keypoints[0].size(), keypoints[1].size()}, matches.size(), correct};
}

}  // namespace opencv_test

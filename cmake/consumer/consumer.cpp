// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <opencv2/iib.hpp>

// Describes random noise twice and matches it with itself: success if every keypoint finds itself.
int main()
{
    cv::Mat image(100, 100, CV_8U);
    cv::randu(image, 0, 256);
    std::vector<cv::KeyPoint> keypoints;
    for (int i = 0; i < 20; i++)
        keypoints.push_back(cv::KeyPoint(20.f + 3 * i, 50.f, 10.f));

    cv::Mat descriptors;
    cv::Ptr<cv::iib::IIB> iib = cv::iib::IIB::create();
    iib->compute(image, keypoints, descriptors);

    std::vector<cv::DMatch> matches;
    cv::iib::HierarchicalMatcher::create(iib->levelSizes())->match(descriptors, descriptors, matches);
    for (size_t i = 0; i < matches.size(); i++)
        if (matches[i].queryIdx != matches[i].trainIdx || matches[i].distance != 0)
            return 1;
    return matches.size() == keypoints.size() ? 0 : 1;
}

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "describe.hpp"

#include "descriptor_oracle.hpp"

namespace opencv_test {

Mat describe(IIB& iib, InputArray image, const std::vector<KeyPoint>& keypoints, InputArrayOfArrays extra)
{
    std::vector<KeyPoint> copy = keypoints;
    Mat descriptors;
    iib.compute(image, extra, copy, descriptors);
    expectSameKeyPoints(keypoints, copy);
    EXPECT_EQ(Size(iib.descriptorSize(), (int)keypoints.size()), descriptors.size());
    EXPECT_EQ(CV_8U, descriptors.type());
    return descriptors;
}

void expectOracle(
        IIB& iib, const Mat& image, const std::vector<KeyPoint>& keypoints, const std::vector<Mat>& extra)
{
    const Mat expected = oracle::describe(iib, image, extra, keypoints),
              actual = describe(iib, image, keypoints, extra);
    ASSERT_EQ(expected.size(), actual.size());
    for (int i = 0; i < expected.rows; i++)
        ASSERT_EQ(0, differingBits(expected.row(i), actual.row(i)))
                << "keypoint " << i << " at " << keypoints[i].pt << " size " << keypoints[i].size << " angle "
                << keypoints[i].angle;
}

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
    BFMatcher(NORM_HAMMING, true).match(descriptors[0], descriptors[1], matches);
    return {{keypoints[0].size(), keypoints[1].size()}, matches.size(),
            countCorrect(matches, keypoints[0], keypoints[1])};
}

}  // namespace opencv_test

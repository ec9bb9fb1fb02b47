// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_images.hpp"

namespace opencv_test {
namespace {

const Size SIZE(180, 160);

//! Regions that leave the image by little, by much and altogether.
std::vector<KeyPoint> aroundTheBorder()
{
    std::vector<KeyPoint> keypoints = scatter(SIZE, 150, 8.f, 90.f, 1);
    for (float far : {-FLT_MAX, -1e9f, -400.f, -179.f, -60.f, 239.f, 358.f, 700.f, 1e9f, 1e20f, FLT_MAX})
        for (float size : {20.f, 150.f, 900.f})
        {
            keypoints.push_back(KeyPoint(far, 70, size, 20));
            keypoints.push_back(KeyPoint(70, far, size, -1));
            keypoints.push_back(KeyPoint(far, far, size, 300));
        }
    return keypoints;
}

TEST(IIB_Border, every_mode_as_the_oracle)
{
    for (int depth : {CV_8U, CV_16U})
    {
        const Mat image = texture(SIZE, depth, 2);
        const std::vector<Mat> extra(1, texture(SIZE, CV_8U, 3));
        const std::vector<KeyPoint> keypoints = aroundTheBorder();
        for (int border : {IIB::BORDER_CLAMP, IIB::BORDER_REFLECT})
            for (int orientation :
                    {IIB::ORIENTATION_NONE, IIB::ORIENTATION_KEYPOINT, IIB::ORIENTATION_GRADIENT})
            {
                const Ptr<IIB> iib = IIB::create(1.f, 4, 63, IIB::MAPPING_SORT, false, false, 1);
                iib->setBorder(border);
                iib->setOrientation(orientation);
                SCOPED_TRACE(format("depth %d border %d orientation %d", depth, border, orientation));
                expectOracle(*iib, image, keypoints, extra);
            }
    }
}

// A region that is the mirror image of its other half: left and right cells are alike.
TEST(IIB_Border, reflects_the_image)
{
    const Mat image = texture(SIZE, CV_8U, 8);
    Mat larger;
    cv::copyMakeBorder(image, larger, 64, 64, 64, 64, cv::BORDER_REFLECT_101);
    // Gradients of the border's pixels differ, as their neighbours repeat those of the image.
    const Ptr<IIB> iib = IIB::create(1.f, 4, IIB::CHANNEL_INTENSITY);
    std::vector<KeyPoint> keypoints = scatter(SIZE, 300, 8.f, 60.f, 9), moved;
    keypoints.erase(std::remove_if(keypoints.begin(), keypoints.end(),
                            [](const KeyPoint& kp) {
                                return kp.pt.x < -10 || kp.pt.y < -10 || kp.pt.x > SIZE.width + 10 ||
                                       kp.pt.y > SIZE.height + 10;
                            }),
            keypoints.end());
    for (const KeyPoint& kp : keypoints)
        moved.push_back(KeyPoint(kp.pt + Point2f(64, 64), kp.size, kp.angle));
    for (int orientation : {IIB::ORIENTATION_NONE, IIB::ORIENTATION_KEYPOINT})
    {
        iib->setOrientation(orientation);
        EXPECT_EQ(0, differingBits(describe(*iib, larger, moved), describe(*iib, image, keypoints)));
    }
}

}  // namespace
}  // namespace opencv_test

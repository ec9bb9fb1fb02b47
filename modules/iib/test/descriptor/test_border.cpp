// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/descriptor_oracle.hpp"
#include "../support/test_images.hpp"

namespace opencv_test {
namespace {

const Size SIZE(180, 160);

//! Regions that leave the image by little, by much and altogether.
std::vector<KeyPoint> aroundTheBorder()
{
    std::vector<KeyPoint> keypoints = scatter(SIZE, 150, 8.f, 90.f, 1);
    for (float far : {-1e9f, -400.f, -179.f, -60.f, 239.f, 358.f, 700.f, 1e9f})
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
                EXPECT_EQ(0, differingBits(oracle::describe(*iib, image, extra, keypoints),
                                     describe(*iib, image, keypoints, extra)))
                        << "depth " << depth << " border " << border << " orientation " << orientation;
            }
    }
}

TEST(IIB_Border, narrow_images_as_the_oracle)
{
    for (const Size size : {Size(1, 40), Size(40, 1), Size(2, 3), Size(5, 33), Size(33, 4)})
    {
        const Mat image = texture(size, CV_8U, 4);
        const std::vector<KeyPoint> keypoints = scatter(size, 40, 8.f, 60.f, 5);
        for (int orientation = IIB::ORIENTATION_NONE; orientation <= IIB::ORIENTATION_GRADIENT; orientation++)
        {
            const Ptr<IIB> iib = IIB::create(1.f, 3);
            iib->setOrientation(orientation);
            EXPECT_EQ(0, differingBits(oracle::describe(*iib, image, std::vector<Mat>(), keypoints),
                                 describe(*iib, image, keypoints)))
                    << size << " orientation " << orientation;
        }
    }
}

// As long as no pixel of the region lies outside, the modes may not differ.
TEST(IIB_Border, inside_the_image_modes_are_alike)
{
    const Mat image = texture(SIZE, CV_8U, 6);
    std::vector<KeyPoint> keypoints = scatter(SIZE, 400, 8.f, 40.f, 7);
    for (int orientation : {IIB::ORIENTATION_NONE, IIB::ORIENTATION_KEYPOINT})
    {
        const Ptr<IIB> iib = IIB::create(1.f);
        iib->setOrientation(orientation);
        std::vector<KeyPoint> inside;
        for (const KeyPoint& kp : keypoints)
        {
            const float reach = kp.size * 0.7072f + 2;
            if (kp.pt.x >= reach && kp.pt.y >= reach && kp.pt.x <= SIZE.width - reach &&
                    kp.pt.y <= SIZE.height - reach)
                inside.push_back(kp);
        }
        ASSERT_GT(inside.size(), 50u);
        iib->setBorder(IIB::BORDER_REFLECT);
        const Mat reflected = describe(*iib, image, inside);
        iib->setBorder(IIB::BORDER_CLAMP);
        EXPECT_EQ(0, differingBits(reflected, describe(*iib, image, inside)));
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

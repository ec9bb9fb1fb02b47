// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"

namespace opencv_test { namespace {

const Size SIZE(180, 160);

TEST(IIB_KeyPoints, order_number_and_fields_are_kept)
{
    std::vector<KeyPoint> keypoints = scatter(SIZE, 200, 8.f, 90.f, 1);
    for (size_t i = 0; i < keypoints.size(); i++)
    {
        keypoints[i].octave = (int)i * 77777;
        keypoints[i].class_id = -(int)i;
        keypoints[i].response = i * 0.5f;
    }
    keypoints.push_back(keypoints[7]);  // twice the same is no mistake
    const Mat image = texture(SIZE, CV_8U, 2);
    const Ptr<IIB> iib = IIB::create(1.f);
    const Mat descriptors = describe(*iib, image, keypoints);
    EXPECT_EQ(0, differingBits(descriptors.row(7), descriptors.row(200)));
    // each row is that of its keypoint alone
    for (int i = 0; i < 200; i += 11)
        EXPECT_EQ(0, differingBits(descriptors.row(i),
                             describe(*iib, image, std::vector<KeyPoint>(1, keypoints[i]))));
}

TEST(IIB_KeyPoints, border_drop_removes_those_whose_ros_leaves_the_image)
{
    const Mat image = texture(SIZE, CV_8U, 3);
    std::vector<KeyPoint> keypoints = scatter(SIZE, 200, 8.f, 90.f, 4);
    // a region of 40 pixels on an odd number of pixels on either side: the first and last places that fit
    for (float x : {19.f, 19.5f, 160.f, 159.5f, 18.5f, 18.f, 160.5f, 161.f})
        keypoints.push_back(KeyPoint(x, 80, 20));
    const Ptr<IIB> iib = IIB::create(2.f);
    EXPECT_EQ(IIB::BORDER_REFLECT, iib->getBorder());
    const Mat all = describe(*iib, image, keypoints);

    std::vector<KeyPoint> inside;
    Mat expected;
    for (size_t i = 0; i < keypoints.size(); i++)
    {
        const KeyPoint& kp = keypoints[i];
        const double side = std::max(2. * kp.size, 16.);
        // the first and last pixel, which count from the centre of pixel 0
        const double left = std::floor(kp.pt.x + 1 - side / 2), top = std::floor(kp.pt.y + 1 - side / 2);
        const double right = std::floor(kp.pt.x + 1 + side / 2), bottom = std::floor(kp.pt.y + 1 + side / 2);
        if (left < 0 || top < 0 || right > SIZE.width || bottom > SIZE.height)
            continue;
        inside.push_back(kp);
        expected.push_back(all.row((int)i));
    }
    ASSERT_GT(inside.size(), 10u);
    ASSERT_EQ(159.5f, inside.back().pt.x);

    iib->setBorder(IIB::BORDER_DROP);
    Mat descriptors;
    iib->compute(image, keypoints, descriptors);
    expectSameKeyPoints(inside, keypoints);
    EXPECT_EQ(0, differingBits(expected, descriptors));
    EXPECT_EQ(0, differingBits(expected, describe(*iib, image, inside)));

    std::vector<KeyPoint> outside(3, KeyPoint(2, 2, 30));
    iib->compute(image, outside, descriptors);
    EXPECT_TRUE(outside.empty());
    EXPECT_TRUE(descriptors.empty());
}

TEST(IIB_KeyPoints, nothing_to_describe_releases_the_output)
{
    const Ptr<IIB> iib = IIB::create();
    std::vector<KeyPoint> keypoints(2, KeyPoint(20, 20, 10)), none;
    Mat descriptors(3, 4, CV_32F, Scalar(1));
    iib->compute(Mat(), keypoints, descriptors);
    EXPECT_TRUE(descriptors.empty());
    EXPECT_EQ(2u, keypoints.size());
    descriptors.create(3, 4, CV_32F);
    iib->compute(texture(SIZE, CV_8U, 5), none, descriptors);
    EXPECT_TRUE(descriptors.empty());
    UMat udescriptors(3, 4, CV_32F);
    iib->compute(UMat(), keypoints, udescriptors);
    EXPECT_TRUE(udescriptors.empty());
}

// All kinds of arguments that ORB accepts.
TEST(IIB_KeyPoints, lists_of_images_and_kinds_of_outputs)
{
    const Ptr<IIB> iib = IIB::create();
    const std::vector<Mat> images = {texture(SIZE, CV_8U, 5), Mat(), texture(SIZE, CV_8U, 6)};
    std::vector<std::vector<KeyPoint>> keypoints = {
            scatter(SIZE, 9, 8.f, 30.f, 1), {}, scatter(SIZE, 5, 8.f, 30.f, 2)};
    std::vector<Mat> codes;
    std::vector<UMat> ucodes;
    iib->compute(images, keypoints, codes);
    iib->compute(images, keypoints, ucodes);
    iib->compute(images, keypoints, noArray());
    iib->compute(images[0], keypoints[0], noArray());
    for (int i : {0, 2})
    {
        const Mat expected = describe(*iib, images[(size_t)i], keypoints[(size_t)i]);
        EXPECT_EQ(0, differingBits(expected, codes[(size_t)i]));
        EXPECT_EQ(0, differingBits(expected, ucodes[(size_t)i].getMat(ACCESS_READ)));
    }
    EXPECT_TRUE(codes[1].empty() && ucodes[1].empty());
    std::vector<uchar> bytes;
    EXPECT_THROW(iib->compute(images[0], keypoints[0], bytes), cv::Exception);
    keypoints[0].resize(1);
    iib->compute(images[0], keypoints[0], bytes);
    EXPECT_EQ(0, differingBits(codes[0].row(0), Mat(bytes).reshape(1, 1)));
    Matx<uchar, 1, 170> row;
    iib->compute(images[0], keypoints[0], row);
    EXPECT_EQ(0, differingBits(codes[0].row(0), Mat(row)));
}

// Small regions are raised to a pixel a cell.
TEST(IIB_KeyPoints, tiny_and_huge_sizes)
{
    const Ptr<IIB> iib = IIB::create(2.f, 1, 63, IIB::MAPPING_QUARTILE);
    for (int depth : {CV_8U, CV_16U})
    {
        const Mat image = texture(Size(120, 100), depth, 9);
        std::vector<KeyPoint> keypoints;
        for (float size : {FLT_MIN, 1e-3f, 1.f, 500.f, 4000.f, 1e5f, 1e7f, 3e9f, 1e20f, FLT_MAX / 2})
            for (int i = 0; i < 4; i++)
                keypoints.push_back(KeyPoint(10.f + 30 * i, 80.f - 20 * i, size, 200));
        for (int granularity = 1; granularity <= 6; granularity++)
        {
            iib->setGranularity(granularity);
            iib->setUseOrientation(false);
            expectOracle(*iib, image, keypoints);
            iib->setUseOrientation(true);
            expectOracle(*iib, image, keypoints);
        }
    }
}

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
    // intensity alone: gradients at the border differ
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

}}  // namespace opencv_test

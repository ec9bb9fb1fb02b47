// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"
#include "../../src/common/image_input.hpp"

#include <thread>

namespace opencv_test { namespace {

const Size SIZE(180, 160);

//! Parameters that use different code paths.
std::vector<Ptr<IIB>> variousExtractors()
{
    std::vector<Ptr<IIB>> v;
    v.push_back(IIB::create(1.f));
    v.push_back(IIB::create(1.f, 3, 63, IIB::MAPPING_SORT, true));
    v.push_back(IIB::create(1.f, 5, 63, IIB::MAPPING_HAAR, false, true));
    v.push_back(IIB::create(1.f, 2, 15));
    const Mat quads = Mat_<int>({2, 5}, {1, 0, 0, 0, 3, 2, 3, 1, 2, 15});
    v.back()->setSelection(quads);
    return v;
}

TEST(IIB_Input, threads_and_repetition_change_no_bit)
{
    const Mat image = texture(SIZE, CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(SIZE, 300, 8.f, 90.f, 2);
    for (const Ptr<IIB>& iib : variousExtractors())
        forEveryNumberOfThreads([&] { return describe(*iib, image, keypoints); },
                [](const Mat& expected, const Mat& actual) {
                    EXPECT_EQ(0, differingBits(expected, actual));
                });
}

TEST(IIB_Input, one_object_serves_several_threads)
{
    for (const Ptr<IIB>& iib : variousExtractors())
    {
        const int users = 4;
        Mat images[users], expected[users], results[users];
        std::vector<KeyPoint> keypoints[users];
        for (int i = 0; i < users; i++)
        {
            images[i] = texture(Size(100 + 20 * i, 120), i % 2 ? CV_16U : CV_8U, i);
            keypoints[i] = scatter(images[i].size(), 100, 8.f, 60.f, i);
            expected[i] = describe(*iib, images[i], keypoints[i]);
        }
        std::vector<std::thread> threads;
        for (int i = 0; i < users; i++)
            threads.push_back(std::thread([&, i] {
                for (int again = 0; again < 5; again++)
                    iib->compute(images[i], keypoints[i], results[i]);
            }));
        for (std::thread& t : threads)
            t.join();
        for (int i = 0; i < users; i++)
            EXPECT_EQ(0, differingBits(expected[i], results[i])) << "user " << i;
    }
}

TEST(IIB_Input, region_of_interest_as_its_copy)
{
    for (int type : {CV_8UC1, CV_16UC1, CV_8UC3, CV_16UC4, CV_32FC1, CV_32FC3})
    {
        Mat whole = texture(
                Size(SIZE.width * CV_MAT_CN(type), SIZE.height), type == CV_16UC4 ? CV_16U : CV_8U, 3);
        whole = whole.reshape(CV_MAT_CN(type));
        whole.convertTo(whole, CV_MAT_DEPTH(type));
        const Mat roi = whole(Rect(33, 21, 101, 87));
        ASSERT_FALSE(roi.isContinuous());
        const std::vector<KeyPoint> keypoints = scatter(roi.size(), 60, 8.f, 70.f, 4);
        for (const Ptr<IIB>& iib : variousExtractors())
            EXPECT_EQ(
                    0, differingBits(describe(*iib, roi.clone(), keypoints), describe(*iib, roi, keypoints)))
                    << typeToString(type);
    }
}

TEST(IIB_Input, extra_maps_may_be_regions_and_umats)
{
    const Mat image = texture(SIZE, CV_8U, 5), whole = texture(Size(250, 220), CV_16U, 6);
    const Mat map = whole(Rect(Point(31, 17), SIZE));
    const std::vector<KeyPoint> keypoints = scatter(SIZE, 40, 8.f, 70.f, 7);
    const Ptr<IIB> iib = IIB::create(1.f, 4, 15, IIB::MAPPING_MEAN, false, false, 2);
    const Mat expected = describe(*iib, image, keypoints, std::vector<Mat>{map.clone(), image});
    EXPECT_EQ(0, differingBits(expected, describe(*iib, image, keypoints, std::vector<Mat>{map, image})));
    std::vector<UMat> umats(2);
    map.copyTo(umats[0]);
    image.copyTo(umats[1]);
    EXPECT_EQ(0, differingBits(expected, describe(*iib, image, keypoints, umats)));
}

TEST(IIB_Input, umat_as_mat)
{
    const Mat image = texture(SIZE, CV_8U, 8);
    UMat uimage, udescriptors;
    image.copyTo(uimage);
    std::vector<KeyPoint> keypoints = scatter(SIZE, 60, 8.f, 70.f, 9);
    for (const Ptr<IIB>& iib : variousExtractors())
    {
        const Mat expected = describe(*iib, image, keypoints);
        EXPECT_EQ(0, differingBits(expected, describe(*iib, uimage, keypoints)));
        iib->compute(uimage, keypoints, udescriptors);
        EXPECT_EQ(0, differingBits(expected, udescriptors.getMat(ACCESS_READ)));
    }
}

TEST(IIB_Input, colour_is_described_as_grey)
{
    const std::vector<KeyPoint> keypoints = scatter(SIZE, 60, 8.f, 70.f, 10);
    const Ptr<IIB> iib = IIB::create(1.f);
    for (int depth : {CV_8U, CV_16U})
        for (int channels : {3, 4})
        {
            const Mat image = texture(Size(SIZE.width * channels, SIZE.height), depth, 11).reshape(channels);
            Mat grey;
            cvtColor(image, grey, channels == 3 ? COLOR_BGR2GRAY : COLOR_BGRA2GRAY);
            EXPECT_EQ(0, differingBits(describe(*iib, grey, keypoints), describe(*iib, image, keypoints)));
        }
}

TEST(IIB_Input, float_colour_weighs_channels_as_cvtColor)
{
    // two of the channels are constant: the order of the grey values is that of the third
    const Mat image = texture(SIZE, CV_8U, 12);
    const std::vector<KeyPoint> keypoints = scatter(SIZE, 60, 8.f, 70.f, 13);
    const Ptr<IIB> iib = IIB::create(1.f);
    const Mat expected = describe(*iib, image, keypoints);
    for (int channels : {3, 4})
        for (int c = 0; c < channels; c++)
        {
            Mat merged(SIZE, CV_32FC(channels), Scalar::all(3)), plane;
            image.convertTo(plane, CV_32F);
            cv::insertChannel(plane, merged, c);
            const Mat descriptors = describe(*iib, merged, keypoints);
            if (c < 3)
                EXPECT_LE(differingBits(expected, descriptors), 0.001 * 8 * expected.total());
            else  // alpha has no weight
                EXPECT_EQ(0, differingBits(Mat::zeros(expected.size(), CV_8U), descriptors));
        }
}

// FLT_MAX often means "no depth".
TEST(IIB_Input, the_largest_float_is_finite)
{
    const Ptr<IIB> iib = IIB::create(1.f, 4, 15, IIB::MAPPING_MEAN, false, false, 1);
    Mat image, depth;
    texture(SIZE, CV_8U, 1).convertTo(image, CV_32F);
    texture(SIZE, CV_8U, 2).convertTo(depth, CV_32F);
    image.at<float>(70, 90) = -FLT_MAX;
    depth(Rect(80, 60, 20, 20)) = FLT_MAX;
    Mat ranked = Mat::zeros(SIZE, CV_32F);  // all but the largest are the least, of 65535 steps
    ranked(Rect(80, 60, 20, 20)) = 1;
    const std::vector<KeyPoint> keypoints = {KeyPoint(90, 70, 40)};
    EXPECT_EQ(0, differingBits(describe(*iib, image, keypoints, std::vector<Mat>(1, depth)),
                         describe(*iib, image, keypoints, std::vector<Mat>(1, ranked))));
}

// The output matrix may be the input image, if size and type fit.
TEST(IIB_Input, descriptors_may_go_where_the_image_is)
{
    const Ptr<IIB> iib = IIB::create(1.f, 4, 15, IIB::MAPPING_MEAN, false, false, 1);
    const Size size(iib->descriptorSize(), 150);
    const Mat image = texture(size, CV_8U, 1), map = texture(size, CV_8U, 2);
    const std::vector<KeyPoint> keypoints = scatter(size, size.height, 16.f, 60.f, 3);
    const Mat expected = describe(*iib, image, keypoints, std::vector<Mat>(1, map));
    for (bool intoMap : {false, true})
    {
        const Mat images[] = {image.clone(), map.clone()};
        Mat descriptors = images[intoMap];
        std::vector<KeyPoint> copy = keypoints;
        iib->compute(images[0], std::vector<Mat>(1, images[1]), copy, descriptors);
        EXPECT_EQ(0, differingBits(expected, descriptors));
        EXPECT_EQ(images[intoMap].data, descriptors.data);
    }
}

//! The grey of doc/format.md.
Mat plainGrey(const Mat& image)
{
    Mat grey(image.size(), image.depth());
    for (int y = 0; y < image.rows; y++)
        for (int x = 0; x < image.cols; x++)
        {
            double sum = 0;
            const double weights[] = {3735, 19235, 9798};
            for (int c = 0; c < 3; c++)
            {
                const int i = x * image.channels() + c;
                sum += weights[c] *
                       (image.depth() == CV_8U ? image.ptr<uchar>(y)[i] : image.ptr<ushort>(y)[i]);
            }
            const int value = (int)std::floor((sum + 16384) / 32768);
            if (image.depth() == CV_8U)
                grey.at<uchar>(y, x) = (uchar)value;
            else
                grey.at<ushort>(y, x) = (ushort)value;
        }
    return grey;
}

TEST(IIB_Input, colour_becomes_grey_by_whole_numbers)
{
    for (int depth : {CV_8U, CV_16U})
        for (int channels : {3, 4})
            for (int width = 1; width <= 150; width += width < 70 ? 1 : 19)
            {
                Mat image(5, width + 3, CV_MAKETYPE(depth, channels));
                randu(image, 0, depth == CV_8U ? 256 : 65536);
                image.row(1).setTo(Scalar::all(0));
                image.row(2).setTo(Scalar::all(depth == CV_8U ? 255 : 65535));
                const Mat part = image.colRange(2, 2 + width);
                EXPECT_EQ(0, cvtest::norm(plainGrey(part), greyOf(part), NORM_INF))
                        << width << " " << part.type();
            }
}

}}  // namespace opencv_test

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "test_precomp.hpp"
#include "support/textures.hpp"

namespace opencv_test { namespace {

//! Computes descriptors and expects that the keypoints stay as they are.
Mat describe(IIB& iib, InputArray image, const std::vector<KeyPoint>& keypoints)
{
    std::vector<KeyPoint> copy = keypoints;
    Mat descriptors;
    iib.compute(image, copy, descriptors);
    expectSameKeyPoints(keypoints, copy);
    EXPECT_EQ(Size(iib.descriptorSize(), (int)keypoints.size()), descriptors.size());
    EXPECT_EQ(CV_8U, descriptors.type());
    return descriptors;
}

void expectOracle(IIB& iib, const Mat& image, const std::vector<KeyPoint>& keypoints)
{
    const Mat expected = oracle::describe(iib, image, keypoints), actual = describe(iib, image, keypoints);
    ASSERT_EQ(expected.size(), actual.size());
    for (int i = 0; i < expected.rows; i++)
        ASSERT_EQ(0, differingBits(expected.row(i), actual.row(i)))
                << "keypoint " << i << " at " << keypoints[i].pt << " size " << keypoints[i].size;
}

typedef testing::TestWithParam<int> IIB_Mapping;

TEST_P(IIB_Mapping, bits_as_the_equations)
{
    const Mat image = texture(Size(110, 91), CV_8U, 1);
    for (int granularity = 1; granularity <= 6; granularity++)
        for (int overlap = 0; overlap < 2; overlap++)
        {
            SCOPED_TRACE(cv::format("G %d overlap %d", granularity, overlap));
            const Ptr<IIB> iib =
                    IIB::create(2.f, granularity, IIB::CHANNELS_DEFAULT, GetParam(), overlap != 0);
            expectOracle(*iib, image, scatter(image.size(), 8, 1.f, 60.f, granularity));
        }
}

TEST_P(IIB_Mapping, coarser_descriptor_is_a_prefix)
{
    const Mat image = texture(Size(180, 160), CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), 30, 65.f, 120.f, 2);
    for (int overlap = 0; overlap < 2; overlap++)
    {
        const Ptr<IIB> iib = IIB::create(1.f, 6, 7, GetParam(), overlap != 0);
        const Mat fine = describe(*iib, image, keypoints);
        const std::vector<int> sizes = iib->levelSizes();
        ASSERT_EQ(6u, sizes.size());
        for (int granularity = 5; granularity >= 1; granularity--)
        {
            iib->setGranularity(granularity);
            EXPECT_EQ(std::vector<int>(sizes.begin(), sizes.begin() + granularity), iib->levelSizes());
            const Mat coarse = describe(*iib, image, keypoints);
            EXPECT_EQ(0, differingBits(coarse, fine.colRange(0, coarse.cols)));
        }
    }
}

INSTANTIATE_TEST_CASE_P(
        /**/, IIB_Mapping, testing::Range((int)IIB::MAPPING_MEAN, (int)IIB::MAPPING_SORT + 1));

TEST(IIB_Descriptor, every_set_of_channels)
{
    const Mat image = texture(Size(101, 97), CV_8U, 2);
    for (int channels = 1; channels < 16; channels++)
    {
        SCOPED_TRACE(channels);
        expectOracle(*IIB::create(1.f, 3, channels), image, scatter(image.size(), 10, 8.f, 70.f, channels));
    }
}

TEST(IIB_Descriptor, images_of_every_width)
{
    const Ptr<IIB> iib = IIB::create(1.f, 3);
    for (int width = 1; width < 100; width++)
    {
        SCOPED_TRACE(width);
        const Mat image = texture(Size(width, 1 + (width - 1) % 23), CV_8U, width);
        expectOracle(*iib, image, scatter(image.size(), 6, 4.f, 50.f, width));
    }
}

// Sums leave 32 bits of products at the coarse levels.
TEST(IIB_Descriptor, large_regions_of_support)
{
    const Mat image = texture(Size(500, 440), CV_8U, 5);
    for (int mapping = IIB::MAPPING_MEAN; mapping <= IIB::MAPPING_SORT; mapping++)
        expectOracle(
                *IIB::create(1.f, 3, 15, mapping), image, scatter(image.size(), 4, 100.f, 900.f, mapping));
}

TEST(IIB_Descriptor, parts_and_colours_of_an_image)
{
    const Mat whole = texture(Size(150, 140), CV_8U, 6), part = whole(Rect(13, 9, 101, 97));
    const std::vector<KeyPoint> keypoints = scatter(part.size(), 20, 10.f, 60.f, 7);
    const Ptr<IIB> iib = IIB::create();
    const Mat expected = describe(*iib, part.clone(), keypoints);
    EXPECT_EQ(0, differingBits(expected, describe(*iib, part, keypoints)));
    UMat device;
    part.copyTo(device);
    EXPECT_EQ(0, differingBits(expected, describe(*iib, device, keypoints)));
    for (int code : {COLOR_GRAY2BGR, COLOR_GRAY2BGRA})
    {
        Mat colour;
        cvtColor(part, colour, code);
        EXPECT_EQ(0, differingBits(expected, describe(*iib, colour, keypoints)));
    }
}

TEST(IIB_Descriptor, orientation_is_the_gradients)
{
    for (int gy = -1020; gy <= 1020; gy += 3)
        for (int gx = -1020; gx <= 1020; gx += 3)
        {
            const double exact = std::atan2(-gy, gx) * 512 / CV_PI, steps = oracle::orientation(gx, gy);
            const double error = std::abs(std::remainder(exact - steps, 1024));
            ASSERT_LE(error, 0.61) << gx << ", " << gy;  // half a step, and the polynomial's error
        }
}

TEST(IIB_Descriptor, more_light_changes_few_bits)
{
    const Mat image = texture(Size(320, 240), CV_8U, 8);
    Mat lit;
    image.convertTo(lit, CV_8U, 0.6, 40);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), 100, 20.f, 40.f, 9);
    const Ptr<IIB> iib = IIB::create();
    const Mat a = describe(*iib, image, keypoints), b = describe(*iib, lit, keypoints);
    EXPECT_LT(differingBits(a, b), 0.1 * 8 * (double)a.total());
    // no bit differs if no value saturates
    const Ptr<IIB> gradients =
            IIB::create(2.f, 4, IIB::CHANNEL_GRAD_X | IIB::CHANNEL_GRAD_Y | IIB::CHANNEL_INTENSITY);
    Mat dark = image / 4, bright = dark * 3 + Scalar(50);
    EXPECT_EQ(
            0, differingBits(describe(*gradients, dark, keypoints), describe(*gradients, bright, keypoints)));
}

/* The exact bits, which no build, machine or later version may change: descriptors in files would no longer match. The
 images and keypoints are made of integers alone. */
struct Golden
{
    uint64 hash;
    int imageChannels, granularity, channels, mapping;
    bool overlap;
};

const Golden GOLDEN[] = {{0x2e989fe2274d8bf2, 1, 4, 15, IIB::MAPPING_MEAN, false},
        {0x6f1e2f008211b314, 1, 4, 15, IIB::MAPPING_MAX, false},
        {0x1166efbb3e6630fe, 1, 4, 15, IIB::MAPPING_MIN, false},
        {0x1abdc4b0d0b8ac66, 1, 4, 15, IIB::MAPPING_QUARTILE, false},
        {0x6518c482f51ed635, 1, 4, 15, IIB::MAPPING_SORT, false},
        {0xc11d46de728f8b7c, 1, 4, IIB::CHANNEL_GRAD_X, IIB::MAPPING_MEAN, false},
        {0x2716add01922d585, 1, 4, IIB::CHANNEL_GRAD_Y, IIB::MAPPING_MEAN, false},
        {0xa490c5b82813dace, 1, 4, IIB::CHANNEL_ORIENTATION, IIB::MAPPING_MEAN, false},
        {0xcd05d999878cc505, 1, 4, IIB::CHANNEL_INTENSITY, IIB::MAPPING_MEAN, false},
        {0xb6fd87a0cae57e55, 1, 4, 15, IIB::MAPPING_MEAN, true},
        {0x4798df25809b6a14, 1, 1, 15, IIB::MAPPING_MEAN, false},
        {0x14a38de43d3cffd2, 1, 5, 15, IIB::MAPPING_MEAN, false},
        {0x469d9af574fa958b, 1, 6, 15, IIB::MAPPING_MEAN, false},
        {0xb45d221b4e67cc73, 3, 4, 15, IIB::MAPPING_MEAN, false}};

TEST(IIB_Descriptor, golden_bits)
{
    const Size size(320, 240);
    std::vector<KeyPoint> keypoints = scatter(size, 500, 3.f, 40.f, 2);
    keypoints.push_back(KeyPoint(160, 120, 300));
    for (const Golden& g : GOLDEN)
    {
        SCOPED_TRACE(cv::format("%d channels in the image, G %d, channels %d, mapping %d, overlap %d",
                g.imageChannels, g.granularity, g.channels, g.mapping, g.overlap));
        const Ptr<IIB> iib = IIB::create(2.f, g.granularity, g.channels, g.mapping, g.overlap);
        const Mat image =
                texture(Size(size.width * g.imageChannels, size.height), CV_8U, 1).reshape(g.imageChannels);
        EXPECT_EQ(g.hash, hashOf(describe(*iib, image, keypoints)));
    }
}

TEST(IIB_Descriptor, properties)
{
    const Ptr<IIB> iib = IIB::create();
    EXPECT_EQ(170, iib->descriptorSize());
    EXPECT_EQ(std::vector<int>({2, 8, 32, 128}), iib->levelSizes());
    EXPECT_EQ(CV_8U, iib->descriptorType());
    EXPECT_EQ(NORM_HAMMING, iib->defaultNorm());
    EXPECT_EQ("Feature2D.IIB", iib->getDefaultName());
    EXPECT_FALSE(iib->empty());
    iib->setOverlap(true);
    EXPECT_EQ(568, iib->descriptorSize());
    iib->setOverlap(false);
    iib->setMapping(IIB::MAPPING_SORT);
    EXPECT_EQ(340, iib->descriptorSize());
    iib->setGranularity(2);
    iib->setChannels(IIB::CHANNEL_INTENSITY | IIB::CHANNEL_GRAD_X);
    iib->setScaleFactor(3.f);
    EXPECT_EQ(10, iib->descriptorSize());
    EXPECT_EQ(2, iib->getGranularity());
    EXPECT_EQ(9, iib->getChannels());
    EXPECT_EQ(IIB::MAPPING_SORT, iib->getMapping());
    EXPECT_FALSE(iib->getOverlap());
    EXPECT_EQ(3.f, iib->getScaleFactor());
}

TEST(IIB_Descriptor, empty_input_gives_empty_output)
{
    const Ptr<IIB> iib = IIB::create();
    const Mat image = texture(Size(64, 64), CV_8U, 1);
    std::vector<KeyPoint> none, one(1, KeyPoint(30, 30, 7));
    Mat descriptors(3, 3, CV_8U);
    iib->compute(image, none, descriptors);
    EXPECT_TRUE(descriptors.empty());
    descriptors.create(3, 3, CV_8U);
    iib->compute(Mat(), one, descriptors);
    EXPECT_TRUE(descriptors.empty());
    EXPECT_EQ(1u, one.size());
}

TEST(IIB_Descriptor, wrong_input_throws)
{
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const Ptr<IIB> iib = IIB::create();
    for (float scaleFactor : {0.f, -1.f, nan, inf})
        EXPECT_THROW(IIB::create(scaleFactor), cv::Exception);
    EXPECT_THROW(IIB::create(2.f, 0), cv::Exception);
    EXPECT_THROW(IIB::create(2.f, 7), cv::Exception);
    EXPECT_THROW(IIB::create(2.f, 4, 0), cv::Exception);
    EXPECT_THROW(IIB::create(2.f, 4, 16), cv::Exception);
    EXPECT_THROW(IIB::create(2.f, 4, 15, -1), cv::Exception);
    EXPECT_THROW(iib->setMapping(IIB::MAPPING_SORT + 1), cv::Exception);
    EXPECT_EQ(IIB::MAPPING_MEAN, iib->getMapping());

    const Mat image = texture(Size(64, 64), CV_8U, 1);
    Mat descriptors;
    for (const KeyPoint& wrong :
            {KeyPoint(nan, 1, 7), KeyPoint(1, inf, 7), KeyPoint(1, 1, 0), KeyPoint(1, 1, nan)})
    {
        std::vector<KeyPoint> keypoints(1, wrong);
        EXPECT_THROW(iib->compute(image, keypoints, descriptors), cv::Exception);
    }
    std::vector<KeyPoint> keypoints(1, KeyPoint(30, 30, 7));
    for (int type : {CV_16UC1, CV_32FC1, CV_8UC2, CV_8SC1})
        EXPECT_THROW(iib->compute(Mat(64, 64, type, Scalar(1)), keypoints, descriptors), cv::Exception)
                << type;
    keypoints[0] = KeyPoint(1500, 1500, 1100);
    EXPECT_THROW(iib->compute(Mat(3000, 3000, CV_8U, Scalar(1)), keypoints, descriptors), cv::Exception);
}

TEST(IIB_Descriptor, any_number_of_threads)
{
    const Mat image = texture(Size(200, 160), CV_8U, 3);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), 200, 5.f, 40.f, 4);
    const Ptr<IIB> iib = IIB::create();
    const int threads = getNumThreads();
    setNumThreads(1);
    const Mat one = describe(*iib, image, keypoints);
    setNumThreads(4);
    const Mat four = describe(*iib, image, keypoints);
    setNumThreads(threads);
    EXPECT_EQ(0, differingBits(one, four));
}

}}  // namespace opencv_test

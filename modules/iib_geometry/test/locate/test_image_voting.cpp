// SPDX-License-Identifier: Apache-2.0

#include "locate/image_voting.hpp"
#include "opencv2/ts.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

//! The codes with each bit flipped with a probability.
cv::Mat noisy(const cv::Mat& codes, double probability, cv::RNG& random)
{
    cv::Mat result = codes.clone();
    for (int row = 0; row < codes.rows; row++)
        for (int bit = 0; bit < 8 * codes.cols; bit++)
            if (random.uniform(0., 1.) < probability)
                result.at<uchar>(row, bit / 8) ^= uchar(1 << bit % 8);
    return result;
}

TEST(ImageVoting, finds_the_image_of_noisy_codes_among_many)
{
    cv::RNG random(1);
    std::vector<cv::Mat> images(300);
    for (size_t k = 0; k < images.size(); k++)
    {
        images[k].create(k % 7 == 3 ? 0 : 100, 64, CV_8U);
        if (!images[k].empty())
            random.fill(images[k], cv::RNG::UNIFORM, 0, 256);
    }
    const ImageVoting voting(images);
    for (size_t k : {0, 151, 299})
    {
        const std::vector<float> votes = voting.vote(noisy(images[k], 0.12, random)).ofImages;
        EXPECT_EQ(std::ptrdiff_t(k), std::max_element(votes.begin(), votes.end()) - votes.begin());
        EXPECT_EQ(0, votes[3]) << "has no codes";
    }
}

TEST(ImageVoting, visits_as_few_codes_in_a_map_a_hundred_times_as_large)
{
    cv::RNG random(1);
    std::vector<cv::Mat> images(10000);
    for (cv::Mat& codes : images)
    {
        codes.create(40, 64, CV_8U);
        random.fill(codes, cv::RNG::UNIFORM, 0, 256);
    }
    const ImageVoting large(images), small(std::vector<cv::Mat>(images.begin(), images.begin() + 100));
    const cv::Mat query = noisy(images[50], 0.1, random);
    const ImageVoting::Votes few = small.vote(query), many = large.vote(query);
    EXPECT_GT(few.visited, 0u);
    EXPECT_LT(double(many.visited), 1.5 * double(few.visited));
    EXPECT_EQ(50, std::max_element(many.ofImages.begin(), many.ofImages.end()) - many.ofImages.begin());
}

TEST(ImageVoting, images_share_the_vote_of_a_key_and_frequent_keys_have_none)
{
    const int tables = 16, strongest = 400;
    const cv::Mat code(1, 64, CV_8U, cv::Scalar(7)), other(1, 64, CV_8U, cv::Scalar(255));
    const auto votesOf = [](const std::vector<cv::Mat>& images, const cv::Mat& query) {
        return ImageVoting(images).vote(query);
    };
    const ImageVoting::Votes votes = votesOf({cv::repeat(code, 9, 1), code}, code);
    EXPECT_EQ(10u * tables, votes.visited);
    EXPECT_NEAR(.9 * tables, votes.ofImages[0], 1e-4);
    EXPECT_NEAR(.1 * tables, votes.ofImages[1], 1e-4);
    EXPECT_EQ(0u, votesOf({cv::repeat(code, 100, 1)}, code).visited);
    cv::Mat many = cv::repeat(code, strongest + 10, 1), finer = code.clone();
    many.rowRange(strongest, many.rows) = cv::Scalar(255);
    EXPECT_EQ(0u, votesOf({many}, other).visited) << "the weakest take no part";
    finer.colRange(16, 64) = cv::Scalar(200);
    EXPECT_EQ(1u * tables, votesOf({code}, finer).visited) << "finer levels have no part in keys";
}

TEST(ImageVoting, without_codes_there_are_no_votes)
{
    const cv::Mat none, some(5, 64, CV_8U, cv::Scalar(1));
    EXPECT_EQ(std::vector<float>(2), ImageVoting({none, none}).vote(some).ofImages);
    EXPECT_EQ(std::vector<float>(2), ImageVoting({some, some}).vote(none).ofImages);
}

}}  // namespace opencv_test

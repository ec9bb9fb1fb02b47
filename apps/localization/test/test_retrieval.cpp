// SPDX-License-Identifier: Apache-2.0

#include "../src/retrieval.hpp"
#include "opencv2/ts.hpp"

namespace {
using namespace iib_localization;

//! The codes with each bit turned over with a probability.
cv::Mat noisy(const cv::Mat& codes, double probability, cv::RNG& random)
{
    cv::Mat result = codes.clone();
    for (int row = 0; row < codes.rows; row++)
        for (int bit = 0; bit < 8 * codes.cols; bit++)
            if (random.uniform(0., 1.) < probability)
                result.at<uchar>(row, bit / 8) ^= uchar(1 << bit % 8);
    return result;
}

TEST(Retrieval, finds_the_keyframe_of_noisy_codes_among_many)
{
    cv::RNG random(1);
    std::vector<cv::Mat> keyframes(300);
    for (size_t k = 0; k < keyframes.size(); k++)
    {
        keyframes[k].create(k % 7 == 3 ? 0 : 100, 64, CV_8U);
        if (!keyframes[k].empty())
            random.fill(keyframes[k], cv::RNG::UNIFORM, 0, 256);
    }
    const Retrieval retrieval(keyframes);
    for (size_t k : {0, 151, 299})
    {
        std::vector<float> votes(keyframes.size(), 0.f);
        retrieval.vote(noisy(keyframes[k], 0.12, random), votes);
        EXPECT_EQ(std::ptrdiff_t(k), std::max_element(votes.begin(), votes.end()) - votes.begin());
        EXPECT_EQ(0, votes[3]) << "has no codes";
    }
}

// A map a hundred times as large takes as many votes, and its memory grows with it.
TEST(Retrieval, looks_at_no_more_codes_of_ten_thousand_keyframes)
{
    cv::RNG random(1);
    std::vector<cv::Mat> keyframes(10000);
    for (cv::Mat& codes : keyframes)
    {
        codes.create(40, 64, CV_8U);
        random.fill(codes, cv::RNG::UNIFORM, 0, 256);
    }
    const Retrieval large(keyframes), small(std::vector<cv::Mat>(keyframes.begin(), keyframes.begin() + 100));
    EXPECT_LT(large.bytes(), 150 * small.bytes());
    const cv::Mat query = noisy(keyframes[50], 0.1, random);
    std::vector<float> votes(100, 0.f), manyVotes(keyframes.size(), 0.f);
    const size_t visited = small.vote(query, votes), manyVisited = large.vote(query, manyVotes);
    EXPECT_GT(visited, 0u);
    EXPECT_LT(manyVisited, 1.5 * visited);
    EXPECT_EQ(50, std::max_element(manyVotes.begin(), manyVotes.end()) - manyVotes.begin());
}

TEST(Retrieval, without_codes_there_are_no_votes)
{
    std::vector<float> votes(2, 0.f);
    Retrieval({cv::Mat(), cv::Mat()}).vote(cv::Mat(5, 64, CV_8U, cv::Scalar(1)), votes);
    EXPECT_EQ(0, votes[0]);
    const std::vector<cv::Mat> codes(2, cv::Mat(5, 64, CV_8U, cv::Scalar(1)));
    Retrieval(codes).vote(cv::Mat(), votes);
    EXPECT_EQ(0, votes[0]);
}

}  // namespace

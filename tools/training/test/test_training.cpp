// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../recipe.hpp"
#include "common/test/test_folder.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

namespace {
using namespace iib_tools;
using cv::iib::IIB;

//! Two scenes of soft random texture; every target is the reference's negative under a slanting light.
class Training : public testing::Test
{
protected:
    void SetUp() CV_OVERRIDE
    {
        cv::RNG rng(7);
        for (const char* scene : {"set/a", "set/b"})
        {
            folder.makeFolder(scene);
            cv::Mat_<float> reference(200, 260);
            rng.fill(reference, cv::RNG::UNIFORM, 0, 255);
            cv::GaussianBlur(reference, reference, cv::Size(), 1.5);
            cv::normalize(reference, reference, 0, 255, cv::NORM_MINMAX);
            cv::Mat_<float> target = 255 - reference;
            for (int y = 0; y < target.rows; y++)
                target.row(y) *= 0.5 + 0.5 * y / target.rows;
            cv::imwrite(folder.path(scene) + "/1.png", reference);
            cv::imwrite(folder.path(scene) + "/2.png", target);
        }
        pairs = findPairs({folder.path("set")});
    }

    static Recipe recipe(bool wholeQuads, bool adaBoost)
    {
        const int channels = IIB::CHANNEL_GRAD_X + IIB::CHANNEL_GRAD_Y + IIB::CHANNEL_SIGNED_GRAD_X;
        return {"test", 24, {channels, IIB::MAPPING_HAAR, 3, 1.f, {15}, wholeQuads, IIB::BORDER_REFLECT},
                warpsOfShare(0), adaBoost, 3};
    }

    static void ignore(int, int) {}

    cv::Ptr<IIB> learn(bool wholeQuads, bool adaBoost, uint64 seed = 1) const
    {
        return train(recipe(wholeQuads, adaBoost), pairs, seed, ignore);
    }

    TestFolder folder;
    std::vector<ImagePair> pairs;
};

TEST_F(Training, keeps_what_survives_the_change_of_light)
{
    for (bool adaBoost : {false, true})
        for (bool wholeQuads : {false, true})
        {
            const cv::Ptr<IIB> learned = learn(wholeQuads, adaBoost);
            const cv::Mat_<int> quads = learned->getSelection();
            ASSERT_EQ(3, learned->descriptorSize());
            for (int i = 0; i < quads.rows; i++)
            {
                // the negative reverses the order of the signed gradient
                EXPECT_NE(2, quads(i, 1)) << "AdaBoost " << adaBoost << ", whole quads " << wholeQuads;
                EXPECT_TRUE(!wholeQuads || quads(i, 4) == 7);
            }
        }
}

TEST_F(Training, fills_whole_bytes)
{
    const cv::Mat_<int> quads = learn(false, false)->getSelection();
    int bits[4] = {};
    for (int i = 0; i < quads.rows; i++)
        for (int mask = quads(i, 4); mask; mask &= mask - 1)
            bits[quads(i, 0)]++;
    EXPECT_EQ(24, bits[1] + bits[2] + bits[3]);
    for (int level = 1; level <= 3; level++)
        EXPECT_EQ(0, bits[level] % 8) << "level " << level;
}

TEST_F(Training, same_seed_same_selection)
{
    const cv::Mat first = learn(false, false)->getSelection();
    EXPECT_EQ(0, cvtest::norm(first, learn(false, false)->getSelection(), cv::NORM_L1));
    const cv::Mat other = learn(false, false, 2)->getSelection();
    EXPECT_TRUE(first.size() != other.size() || cvtest::norm(first, other, cv::NORM_L1) > 0);
}

TEST_F(Training, selection_goes_through_a_file)
{
    const cv::Ptr<IIB> learned = learn(false, false);
    learned->save(folder.path("selection.yml"));
    const cv::Ptr<IIB> loaded = IIB::create();
    const cv::FileStorage file(folder.path("selection.yml"), cv::FileStorage::READ);
    loaded->read(file.getFirstTopLevelNode());
    EXPECT_EQ(0, cvtest::norm(learned->getSelection(), loaded->getSelection(), cv::NORM_L1));
    const MeanScores scores = judge(pairs, loaded, ignore);
    EXPECT_GT(scores.mar, 0.5);
    EXPECT_EQ(scores.mar, judge(pairs, learned, ignore).mar);
}

TEST_F(Training, folds_split_scenes)
{
    ASSERT_EQ(2u, pairs.size());
    EXPECT_EQ("a", foldOf(pairs, 0, 2, true).at(0).sequence);
    EXPECT_EQ("b", foldOf(pairs, 0, 2, false).at(0).sequence);
    EXPECT_EQ("b", foldOf(pairs, 1, 2, true).at(0).sequence);
}

TEST_F(Training, pool_bits_are_those_of_its_candidates)
{
    PoolParameters boxes = recipe(false, false).pool;
    boxes.mapping = IIB::MAPPING_BOXES;
    boxes.channels = 59;
    boxes.granularity = 5;
    const cv::Mat image = cv::imread(folder.path("set/a/1.png"), cv::IMREAD_GRAYSCALE);
    std::vector<cv::KeyPoint> keypoints(1, cv::KeyPoint(100.f, 90.f, 64.f));
    for (const PoolParameters& parameters : {recipe(false, false).pool, boxes})
    {
        const CandidatePool pool = makePool(parameters);
        cv::Mat all, one;
        pool.extractor->compute(image, keypoints, all);
        ASSERT_EQ(all.cols, IIB::create(1.f, parameters.granularity, parameters.channels, parameters.mapping,
                                    parameters.mapping != IIB::MAPPING_BOXES)
                                    ->descriptorSize());
        for (size_t i = 0; i < pool.candidates.size(); i += 17)
        {
            selectedExtractor(pool, std::vector<int>(1, int(i)))->compute(image, keypoints, one);
            const int position = pool.candidates[i].positions.at(0);
            EXPECT_EQ(one.at<uchar>(0), all.at<uchar>(position / 8) >> position % 8 & 1) << "candidate " << i;
        }
    }
}

TEST_F(Training, regions_beyond_the_image_are_trained_with_the_border_asked_for)
{
    PoolParameters parameters = recipe(false, false).pool;
    const cv::Mat image = cv::imread(folder.path("set/a/1.png"), cv::IMREAD_GRAYSCALE);
    for (int border : {IIB::BORDER_CLAMP, IIB::BORDER_REFLECT})
    {
        parameters.border = border;
        const CandidatePool pool = makePool(parameters);
        const cv::Ptr<IIB> expected =
                IIB::create(1.f, parameters.granularity, parameters.channels, parameters.mapping);
        expected->setSelection(pool.quads);
        expected->setBorder(border);
        std::vector<cv::KeyPoint> keypoints(1, cv::KeyPoint(10.f, 90.f, 64.f));
        cv::Mat codes, expectedCodes;
        pool.extractor->compute(image, keypoints, codes);
        expected->compute(image, keypoints, expectedCodes);
        EXPECT_EQ(0, cv::norm(codes, expectedCodes, cv::NORM_HAMMING)) << "border " << border;
    }
}

TEST_F(Training, warped_pairs_match_less_but_match)
{
    const Warps mild = {1, 1, 2, 0.98, 1.02, 1.02, 0, 1, 0}, warps = {1, 1, 22, 0.7, 1.43, 2.5, 0.1, 1.5, 5};
    const cv::Ptr<IIB> iib = IIB::createPreset(IIB::PRESET_BALANCED, 1.f);
    const MeanScores nearlyStill = judgeWarped(pairs, iib, mild, 1, ignore),
                     warped = judgeWarped(pairs, iib, warps, 1, ignore);
    EXPECT_LT(warped.mar, nearlyStill.mar);
    EXPECT_GT(warped.mar, 0.1);
    EXPECT_EQ(warped.mar, judgeWarped(pairs, iib, warps, 1, ignore).mar);
}

TEST_F(Training, quads_begin_only_where_they_may)
{
    PoolParameters parameters = recipe(false, false).pool;
    parameters.windows = {1, 9, 4};
    const cv::Mat_<int> quads = makePool(parameters).quads;
    int count[4][4] = {};  // levels, windows
    for (int i = 0; i < quads.rows; i++)
        count[quads(i, 0)][quads(i, 2) % 2 * 2 + quads(i, 3) % 2]++;
    const int channels = 3, expected[4][4] = {{}, {1}, {4, 0, 0, 1}, {0, 0, 12, 0}};
    for (int level = 1; level <= 3; level++)
        for (int window = 0; window < 4; window++)
            EXPECT_EQ(channels * expected[level][window], count[level][window]) << level << ", " << window;
}

TEST_F(Training, impossible_wishes_are_refused)
{
    Recipe tooLong = recipe(false, false);
    tooLong.bits = 100000;
    EXPECT_THROW(train(tooLong, pairs, 1, ignore), cv::Exception);
    for (const std::vector<int>& windows : {std::vector<int>(), {0}, {1, 16}})
    {
        Recipe nowhere = recipe(false, false);
        nowhere.pool.windows = windows;
        EXPECT_THROW(train(nowhere, pairs, 1, ignore), cv::Exception);
    }
    EXPECT_THROW(train(recipe(false, false), {}, 1, ignore), cv::Exception);
    EXPECT_THROW(train(recipe(false, true), {}, 1, ignore), cv::Exception);
}

}  // namespace

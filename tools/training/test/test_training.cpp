// SPDX-License-Identifier: Apache-2.0

#include "../recipe.hpp"
#include "iib_geometry/test/test_folder.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

namespace {
using namespace iib_tools;
using cv::iib::IIB;

//! Two scenes of smooth random texture; every target is the reference's negative under uneven illumination.
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
        images.pairs = findPairs({folder.path("set")});
    }

    static Recipe recipe()
    {
        const int channels = IIB::CHANNEL_GRAD_X + IIB::CHANNEL_GRAD_Y + IIB::CHANNEL_SIGNED_GRAD_X;
        return {"test", 24, {channels, IIB::MAPPING_HAAR, 3, 1.f, {15}, IIB::BORDER_REFLECT}, Warps(), 3, 0,
                false};
    }

    static void ignore(int, int) {}

    cv::Ptr<IIB> learn(uint64 seed = 1) const { return train(recipe(), images, seed, ignore); }

    TestFolder folder;
    TrainingSet images;
};

TEST_F(Training, keeps_what_survives_the_change_of_light)
{
    const cv::Ptr<IIB> learned = learn();
    const cv::Mat_<int> quads = learned->getSelection();
    ASSERT_EQ(3, learned->descriptorSize());
    for (int i = 0; i < quads.rows; i++)
        EXPECT_NE(2, quads(i, 1)) << "the negative reverses the order of the signed gradient";
}

// The targets are negatives: signed gradients change their sign, magnitudes stay.
TEST_F(Training, adaboost_keeps_whole_quads_that_survive)
{
    Recipe paper = recipe();
    paper.adaboost = true;
    paper.bits = 32;
    paper.pool.mapping = IIB::MAPPING_MEAN;
    paper.pool.windows = {1};
    const cv::Ptr<IIB> learned = train(paper, images, 1, ignore);
    const cv::Mat_<int> quads = learned->getSelection();
    ASSERT_EQ(4, learned->descriptorSize());
    ASSERT_EQ(8, quads.rows);
    for (int i = 0; i < quads.rows; i++)
    {
        EXPECT_EQ(15, quads(i, 4)) << "a whole quad";
        EXPECT_NE(2, quads(i, 1)) << "the negative reverses the order of the signed gradient";
    }
    EXPECT_EQ(0, cvtest::norm(quads, train(paper, images, 1, ignore)->getSelection(), cv::NORM_L1));

    paper.pool.mapping = IIB::MAPPING_HAAR;
    EXPECT_NE(std::string::npos, messageOf([&] { train(paper, images, 1, ignore); }).find("quads of 4 bits"));
    paper.pool.mapping = IIB::MAPPING_MEAN;
    EXPECT_NE("", messageOf([&] { train(paper, {}, 1, ignore); }));
}

TEST_F(Training, fills_whole_bytes)
{
    const cv::Mat_<int> quads = learn()->getSelection();
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
    const cv::Mat first = learn()->getSelection();
    EXPECT_EQ(0, cvtest::norm(first, learn()->getSelection(), cv::NORM_L1));
    const cv::Mat other = learn(2)->getSelection();
    EXPECT_TRUE(first.size() != other.size() || cvtest::norm(first, other, cv::NORM_L1) > 0);
}

TEST_F(Training, pool_bits_are_those_of_its_candidates)
{
    PoolParameters boxes = recipe().pool;
    boxes.mapping = IIB::MAPPING_BOXES;
    boxes.channels = 59;
    boxes.granularity = 5;
    const cv::Mat image = cv::imread(folder.path("set/a/1.png"), cv::IMREAD_GRAYSCALE);
    std::vector<cv::KeyPoint> keypoints(1, cv::KeyPoint(100.f, 90.f, 64.f));
    for (const PoolParameters& parameters : {recipe().pool, boxes})
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
            const int position = pool.candidates[i].position;
            EXPECT_EQ(one.at<uchar>(0), all.at<uchar>(position / 8) >> position % 8 & 1) << "candidate " << i;
        }
    }
}

TEST_F(Training, regions_beyond_the_image_are_trained_with_the_border_asked_for)
{
    PoolParameters parameters = recipe().pool;
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

TEST_F(Training, detected_points_are_partners_where_place_and_size_agree)
{
    const CandidatePool pool = makePool(recipe().pool);
    const Warps warps = {1, 0.4, 20, 0.7, 1.4, 2, 0, 1, 0};
    for (const DescribedPair& pair : describeForTraining(images, pool.extractor, 4, 1, warps, 1, ignore))
    {
        EXPECT_EQ(int(pair.referencePoints.size()), pair.reference.rows);
        EXPECT_EQ(int(pair.targetPoints.size()), pair.target.rows);
        EXPECT_GE(pair.partners, 100);
        EXPECT_LT(pair.partners, pair.target.rows) << "a warped image has points of its own";
        double error = 0;
        for (int i = 0; i < pair.partners; i++)
        {
            const double distance = cv::norm(pair.referencePoints[i] - pair.targetPoints[i]);
            EXPECT_LE(distance, 2);
            error += distance / pair.partners;
        }
        EXPECT_GT(error, 0.05) << "each is detected by itself";
    }
}

TEST_F(Training, learns_from_detected_points)
{
    Recipe detected = recipe();
    detected.detected = 1;
    const cv::Mat_<int> quads = train(detected, images, 1, ignore)->getSelection();
    for (int i = 0; i < quads.rows; i++)
        EXPECT_NE(2, quads(i, 1)) << "the negative reverses the order of the signed gradient";
    const cv::Mat fixed = learn()->getSelection();
    EXPECT_TRUE(quads.size() != fixed.size() || cvtest::norm(quads, fixed, cv::NORM_L1) > 0);
}

TEST_F(Training, quads_begin_only_where_they_may)
{
    PoolParameters parameters = recipe().pool;
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
    Recipe tooLong = recipe();
    tooLong.bits = 100000;
    EXPECT_THROW(train(tooLong, images, 1, ignore), cv::Exception);
    EXPECT_THROW(train(recipe(), {}, 1, ignore), cv::Exception);
}

//! A wall 2 m in front of a camera of 100 pixels focal length, with depth in millimetres.
Relief wallSeenFrom(cv::Vec3d step)
{
    const cv::Matx33d camera(100, 0, 59.5, 0, 100, 39.5, 0, 0, 1);
    const auto wall = [](double depth) {
        return cv::Mat_<ushort>(80, 120, cv::saturate_cast<ushort>(depth));
    };
    return {wall(2000), wall(2000 + step[2]), camera, cv::Matx33d::eye(), step};
}

TEST(Training_Relief, moves_and_resizes_what_it_sees)
{
    const cv::KeyPoint point(70.f, 50.f, 8.f);
    const cv::KeyPoint aside = wallSeenFrom(cv::Vec3d(200, 0, 0)).project(point);
    EXPECT_NEAR(0, cv::norm(aside.pt - cv::Point2f(80, 50)), 1e-3);
    EXPECT_FLOAT_EQ(8.f, aside.size);
    const cv::KeyPoint nearer = wallSeenFrom(cv::Vec3d(0, 0, -1000)).project(point);
    EXPECT_NEAR(0, cv::norm(nearer.pt - cv::Point2f(80.5f, 60.5f)), 1e-3);
    EXPECT_FLOAT_EQ(16.f, nearer.size);
}

TEST(Training_Relief, what_is_hidden_or_outside_has_no_size)
{
    Relief relief = wallSeenFrom(cv::Vec3d(200, 0, 0));
    EXPECT_EQ(0, relief.project(cv::KeyPoint(115.f, 50.f, 8.f)).size);
    EXPECT_EQ(0, relief.project(cv::KeyPoint(-3.f, 50.f, 8.f)).size);
    relief.target.colRange(78, 90).setTo(1000);
    EXPECT_EQ(0, relief.project(cv::KeyPoint(70.f, 50.f, 8.f)).size);
    relief.reference.setTo(0);
    EXPECT_EQ(0, relief.project(cv::KeyPoint(30.f, 50.f, 8.f)).size);
}

TEST(Training_Relief, mirrored_pictures_show_mirrored_points)
{
    Relief relief = wallSeenFrom(cv::Vec3d(200, 50, -400));
    relief.rotation = cv::Matx33d(0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, 1);
    relief.target.setTo(1600);
    const cv::KeyPoint seen = relief.project(cv::KeyPoint(30.f, 50.f, 8.f));
    relief.mirror();
    const cv::KeyPoint mirrored = relief.project(cv::KeyPoint(119.f - 30, 50.f, 8.f));
    EXPECT_NEAR(0, cv::norm(mirrored.pt - cv::Point2f(119 - seen.pt.x, seen.pt.y)), 1e-3);
    EXPECT_EQ(mirrored.size, seen.size);
}

TEST(Training_Walks, pairs_of_places_under_all_lights)
{
    const TestFolder folder;
    for (const std::string light : {"path/hut_0/map", "path/hut_0/night"})
    {
        folder.makeFolder(light + "/images");
        folder.makeFolder(light + "/depth");
        folder.write(light + "/cameras.txt", "1 PINHOLE 120 80 100 100 60 40\n");
        std::string poses;
        for (int k = 0; k < 6; k++)
        {
            poses += cv::format("%d %g 0 0 0 0 0 1\n", k, .1 * k);
            const std::string name = "/" + std::to_string(k) + ".png";
            cv::imwrite(folder.path(light) + "/images" + name, cv::Mat(80, 120, CV_8U, cv::Scalar(99)));
            cv::imwrite(folder.path(light) + "/depth" + name, cv::Mat(80, 120, CV_16U, cv::Scalar(500)));
        }
        folder.write(light + "/poses.txt", poses);
    }
    // 0, 1, 4 and 5 without the pair 0 and 5, which is too far apart; both directions, four pairs of lights
    const std::vector<WalkPair> pairs = findWalkPairs({folder.path("")}, 4);
    ASSERT_EQ(5u * 2 * 4, pairs.size());
    for (const WalkPair& pair : pairs)
    {
        EXPECT_EQ("path/hut_0", pair.scene);
        EXPECT_GE(cv::norm(loadRelief(pair).translation), 24.9) << "steps of 4 mm";
        EXPECT_LE(cv::norm(loadRelief(pair).translation), 100.1);
    }
    EXPECT_GT(loadRelief(pairs[0]).project(cv::KeyPoint(60.f, 40.f, 8.f)).size, 0);
    for (const char* broken : {"poses.txt", "cameras.txt"})
    {
        folder.write(std::string("path/hut_0/night/") + broken, "0 0 0\n");
        EXPECT_THROW(findWalkPairs({folder.path("")}, 4), cv::Exception) << broken;
    }
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0

#include <set>

#include "../wall.hpp"

namespace opencv_test { namespace {
using namespace cv::iib;

class Update : public WallTest
{
protected:
    Update() : name(folder.path("map")) {}

    //! The wall under changed illumination: with shadows that the map does not know.
    cv::Mat relit(const cv::Affine3d& pose, int seed) const
    {
        const cv::Mat image = wall.image(pose), other = Wall(uint64(seed)).image(pose);
        cv::Mat mixed;
        cv::addWeighted(image, .48, other, .52, 0, mixed);
        return mixed;
    }

    size_t codes() const
    {
        size_t count = 0;
        for (const MapImage& image : readMap(name).images)
            count += image.sees.size();
        return count;
    }

    const std::string name;
};

TEST_F(Update, unknown_illumination_is_added)
{
    std::vector<cv::Affine3d> poses;
    for (int i = 0; i < 4; i++)
        poses.push_back(poseAt(0.45 * i - 0.6, 0.02, 0.03 * i));
    const int before = Localizer(name).localize(relit(TRUTH, 9), CAMERA).inliers;
    const std::string out = folder.path("new");
    MapUpdate update(name, out);
    EXPECT_EQ(1u, update.cameras().size());
    for (size_t i = 0; i < poses.size(); i++)
        EXPECT_TRUE(update.add("dusk/" + std::to_string(i) + ".png", relit(poses[i], 9), CAMERA).found);
    EXPECT_TRUE(update.add("dusk/0 again.png", relit(poses[0], 9), CAMERA).found);
    EXPECT_FALSE(update.add("elsewhere", Wall(5).image(TRUTH), CAMERA).found);
    EXPECT_EQ("an image named 'elsewhere' is already a part of the update",
            messageOf([&] { update.add("elsewhere", Wall(5).image(TRUTH), CAMERA); }));
    const MapUpdate::Counts counts = update.commit();
    EXPECT_EQ(5, counts.localized);
    EXPECT_EQ(4, counts.added) << "one at each place";
    EXPECT_EQ(0, counts.dropped);
    EXPECT_EQ(6u, readMap(name).images.size()) << "the old map stays";
    const Map learnt = readMap(out);
    ASSERT_EQ(10u, learnt.images.size());
    EXPECT_EQ("updates/1/dusk/0 again.png", learnt.images[6].name);
    EXPECT_EQ(1u, learnt.updates);
    const Location location = Localizer(out).localize(relit(TRUTH, 9), CAMERA);
    expectAt(TRUTH, location, .01);
    EXPECT_GT(location.inliers, before * 5 / 4);
    std::vector<double> away;  // distances of the added images' points from the wall; a pixel is 20 cm
    for (size_t i = 6; i < learnt.images.size(); i++)
        for (int number : learnt.images[i].sees)
        {
            const cv::Point3d p = learnt.points[size_t(number)];
            away.push_back(std::abs(p.z - .4 * p.x - 4));
        }
    EXPECT_GT(away.size(), 800u);
    EXPECT_LT(median(away), .06);
}

TEST_F(Update, known_illumination_adds_nothing)
{
    MapUpdate update(name);
    EXPECT_TRUE(update.add("again", wall.image(poseAt(0.1, 0.05, 0.09)), CAMERA).found);
    const MapUpdate::Counts counts = update.commit();
    EXPECT_EQ(1, counts.localized);
    EXPECT_EQ(0, counts.added);
    EXPECT_EQ(6u, readMap(name).images.size());
}

TEST_F(Update, codes_that_eight_updates_miss_are_dropped)
{
    const size_t before = codes();
    const cv::Mat half = wall.image(TRUTH);
    half.colRange(0, SIZE.width / 2).setTo(90);  // half of the scene changed
    int dropped = 0;
    for (int i = 0; i < 8; i++)
    {
        EXPECT_EQ(0, dropped) << i;
        MapUpdate update(name);
        update.add("half", half, CAMERA);
        dropped = update.commit().dropped;
    }
    EXPECT_GT(dropped, int(before / 10));
    EXPECT_LE(codes(), before - size_t(dropped) + 8 * 500) << "but for what the images of the update added";
    EXPECT_TRUE(Localizer(name).localize(half, CAMERA).found);
}

TEST_F(Update, keeps_eight_added_images_of_a_place_and_the_models_own)
{
    map.images[0].name = "updates/1/light";  // the name that the first update would use
    cv::randu(map.images[3].codes, 0, 256);  // near all images, but never matched
    MapFolder(name).write(map);
    for (int i = 0; i < 10; i++)
    {
        MapUpdate update(name);
        ASSERT_TRUE(update.add("light", relit(TRUTH, 20 + i), CAMERA).found);
        ASSERT_TRUE(update.add("the first light", relit(TRUTH, 20), CAMERA).found);
        update.commit();
    }
    const Map learnt = readMap(name);
    size_t added = 0, own = 0;
    std::set<std::string> names;
    for (const MapImage& image : learnt.images)
    {
        added += image.added;
        own += !image.added;
        names.insert(image.name);
    }
    EXPECT_EQ(1u, names.count("updates/updates/1/light")) << "helps each time";
    EXPECT_EQ(1u, names.count("updates/10/light")) << "is new";
    EXPECT_EQ(6u, own);
    EXPECT_LE(added, 8u);
    EXPECT_GE(added, 6u);
}

TEST_F(Update, failed_calls_may_be_repeated)
{
    MapUpdate update(name);
    EXPECT_EQ("the image has 64 x 48 pixels and its camera 320 x 240",
            messageOf([&] { update.add("light", cv::Mat(48, 64, CV_8U), CAMERA); }));
    EXPECT_TRUE(update.add("light", relit(TRUTH, 9), CAMERA).found) << "the name is free";
    const std::string before = textOf(name + "/map.iib");
    std::filesystem::remove(name + "/images.bin");
    folder.makeFolder("map/images.bin/in the way");
    EXPECT_NE("", messageOf([&] { update.commit(); }));
    EXPECT_EQ(before, textOf(name + "/map.iib")) << "the old one stays";
    std::filesystem::remove_all(name + "/images.bin");
    const MapUpdate::Counts counts = update.commit();
    EXPECT_EQ(1, counts.added);
    EXPECT_EQ(1u, readMap(name).updates);
}

TEST_F(Update, one_at_a_time)
{
    MapUpdate first(name);
    expectAnotherWrites(name, [&] { MapUpdate second(name); });
    EXPECT_EQ("", messageOf([&] { MapUpdate second(name, folder.path("other")); })) << "only reads it";
    first.add("light", relit(TRUTH, 9), CAMERA);
    EXPECT_EQ(
            "an image has no name: give it one", messageOf([&] { first.add("", relit(TRUTH, 9), CAMERA); }));
    EXPECT_EQ("the name of an image, 'a...', has a zero byte, which ends names in COLMAP's files",
            messageOf([&] { first.add(std::string("a\0b", 3), relit(TRUTH, 9), CAMERA); }));
    first.commit();
    const std::string over = "the update was committed already: make another MapUpdate";
    EXPECT_EQ(over, messageOf([&] { first.commit(); }));
    EXPECT_EQ(over, messageOf([&] { first.add("more", relit(TRUTH, 9), CAMERA); }));
    EXPECT_EQ(1u, readMap(name).updates);
}

}}  // namespace opencv_test

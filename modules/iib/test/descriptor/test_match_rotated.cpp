// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/matcher_oracle.hpp"
#include "../support/test_errors.hpp"
#include "../support/describe.hpp"

namespace opencv_test { namespace {

const double UNKNOWN = -1;

Ptr<IIB> rotating()
{
    const Ptr<IIB> iib = IIB::createPreset(IIB::PRESET_UNIVERSAL, 2.f);
    iib->setOrientation(IIB::ORIENTATION_KEYPOINT);
    return iib;
}

//! A pair, and matchRotated of it.
struct MatchedPair : public RotatedPair
{
    Ptr<IIB> iib;
    std::vector<DMatch> matches;

    explicit MatchedPair(double degrees, double zoom = 1) : RotatedPair(degrees, zoom), iib(rotating()) {}

    double match(double rotation = UNKNOWN,
            const Ptr<DescriptorMatcher>& matcher = HierarchicalMatcher::createRecommended())
    {
        return matchRotated(
                images[0], keypoints[0], images[1], keypoints[1], iib, matcher, matches, rotation);
    }

    //! Matches with the first image upright and one angle for all keypoints of the second.
    std::vector<DMatch> matchedWith(float angle, const DescriptorMatcher& matcher) const
    {
        std::vector<KeyPoint> angled[] = {keypoints[0], keypoints[1]};
        Mat codes[2];
        for (int i = 0; i < 2; i++)
        {
            for (KeyPoint& kp : angled[i])
                kp.angle = i ? angle : -1;
            iib->compute(images[i], angled[i], codes[i]);
        }
        std::vector<DMatch> result;
        matcher.match(codes[0], codes[1], result);
        return result;
    }
};

void expectSameMatches(const std::vector<DMatch>& expected, const std::vector<DMatch>& actual)
{
    expectEqual(Matches(1, expected), Matches(1, actual));
}

void expectAngles(float expected, const std::vector<KeyPoint>& keypoints)
{
    for (const KeyPoint& kp : keypoints)
        ASSERT_EQ(expected, kp.angle);
}

TEST(IIB_MatchRotated, finds_the_angle_and_matches_with_it)
{
    const Ptr<DescriptorMatcher> matchers[] = {
            HierarchicalMatcher::createRecommended(), cv::BFMatcher::create(NORM_HAMMING)};
    for (double degrees : {0., 30., 45., 90., 137., 180., 345.})
    {
        SCOPED_TRACE(degrees);
        MatchedPair pair(degrees);
        const std::vector<KeyPoint> before[] = {pair.keypoints[0], pair.keypoints[1]};
        for (const Ptr<DescriptorMatcher>& matcher : matchers)
        {
            const double found = pair.match(UNKNOWN, matcher);
            EXPECT_GE(found, 0);
            EXPECT_LT(found, 360);
            const double error = std::abs(found - degrees);
            EXPECT_LE(std::min(error, 360 - error), 1.5) << found;

            const float angles[] = {-1, degrees == 0 ? -1.f : (float)found};
            expectSameMatches(pair.matchedWith(angles[1], *matcher), pair.matches);
            for (int i = 0; i < 2; i++)
            {
                expectAngles(angles[i], pair.keypoints[i]);
                std::vector<KeyPoint> others = before[i];
                for (KeyPoint& kp : others)
                    kp.angle = angles[i];
                expectSameKeyPoints(others, pair.keypoints[i]);
            }
            const int ideal = pair.correct(pair.matchedWith(degrees == 0 ? -1.f : (float)degrees, *matcher));
            EXPECT_GE(ideal, 100);
            EXPECT_GE(pair.correct(pair.matches), 0.95 * ideal);
        }
    }
}

TEST(IIB_MatchRotated, with_a_known_rotation)
{
    MatchedPair pair(137);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
    for (double known : {137., 20., 2., 0., 358.})  // it is believed, right or wrong
    {
        EXPECT_EQ(known, pair.match(known, matcher));
        const bool upright = known < 10 || known > 350;
        expectAngles(-1, pair.keypoints[0]);
        expectAngles(upright ? -1.f : (float)known, pair.keypoints[1]);
        expectSameMatches(pair.matchedWith(pair.keypoints[1][0].angle, *matcher), pair.matches);
    }
}

TEST(IIB_MatchRotated, detects_keypoints_itself)
{
    MatchedPair pair(60);
    pair.iib->setDetector(ORB::create(600));
    const double rotation = pair.match();
    std::vector<KeyPoint> keypoints[2];
    std::vector<DMatch> actual;
    EXPECT_EQ(
            rotation, matchRotated(pair.images[0], pair.images[1], pair.iib,
                              HierarchicalMatcher::createRecommended(), keypoints[0], keypoints[1], actual));
    EXPECT_NEAR(60, rotation, 1.5);
    expectSameMatches(pair.matches, actual);
    for (int i = 0; i < 2; i++)
        expectSameKeyPoints(pair.keypoints[i], keypoints[i]);
}

TEST(IIB_MatchRotated, of_another_scale)
{
    for (double zoom : {0.6, 1.6})
    {
        MatchedPair pair(200, zoom);
        EXPECT_NEAR(200, pair.match(), 2) << zoom;
        EXPECT_GE(pair.correct(pair.matches), 40);
    }
}

TEST(IIB_MatchRotated, of_images_of_any_size_and_type)
{
    const MatchedPair whole(60);
    for (Size size : {Size(1, 1), Size(1, 7), Size(33, 3), Size(399, 397)})
        for (int type : {CV_8UC1, CV_8UC4, CV_16UC3, CV_32FC1})
        {
            MatchedPair part = whole;
            for (int i = 0; i < 2; i++)
            {
                Mat grey;
                whole.images[i](Rect(Point(), size)).convertTo(grey, type);
                merge(std::vector<Mat>(CV_MAT_CN(type), grey), part.images[i]);
                part.keypoints[i].clear();
                for (const KeyPoint& kp : whole.keypoints[i])
                    if (Rect2f(Point2f(), Size2f(size)).contains(kp.pt))
                        part.keypoints[i].push_back(kp);
            }
            const double rotation = part.match();
            EXPECT_TRUE(size.area() < 1000 || std::abs(rotation - 60) <= 1.5) << type << ": " << rotation;
        }
}

TEST(IIB_MatchRotated, tries_the_strongest_keypoints)
{
    MatchedPair pair(60);
    for (std::vector<KeyPoint>& keypoints : pair.keypoints)
    {
        std::reverse(keypoints.begin(), keypoints.end());
        for (KeyPoint weak : scatter(Size(400, 400), 300, 20.f, 40.f, 3))
        {
            weak.response = NOT_A_NUMBER;
            keypoints.insert(keypoints.begin(), weak);
        }
    }
    EXPECT_NEAR(60, pair.match(), 1.5);
}

TEST(IIB_MatchRotated, drops_keypoints_as_the_extractor_does)
{
    MatchedPair pair(45);
    pair.iib->setBorder(IIB::BORDER_DROP);
    for (std::vector<KeyPoint>& keypoints : pair.keypoints)
        keypoints.insert(keypoints.begin(), {KeyPoint(1, 1, 31, -1, 1e9f), KeyPoint(200, 399, 31, -1, 1e9f)});
    EXPECT_NEAR(45, pair.match(), 1.5);
    EXPECT_LT(pair.keypoints[0].size(), 602u);
    EXPECT_EQ(-1, pair.keypoints[0][0].angle);
    EXPECT_GE(pair.correct(pair.matches), 100);
}

TEST(IIB_MatchRotated, without_anything_to_match)
{
    RotatedPair pair(60);
    const Ptr<IIB> iib = rotating();
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
    std::vector<KeyPoint> none, one(1, KeyPoint(50, 50, 10));
    std::vector<DMatch> matches(3);
    EXPECT_EQ(
            0, matchRotated(pair.images[0], pair.keypoints[0], pair.images[1], none, iib, matcher, matches));
    EXPECT_TRUE(matches.empty());
    matches.resize(3);
    EXPECT_EQ(0,
            matchRotated(pair.images[0], pair.keypoints[0], Mat(), pair.keypoints[1], iib, matcher, matches));
    EXPECT_TRUE(matches.empty());
    EXPECT_EQ(0, matchRotated(pair.images[0], one, pair.images[0], one, iib, matcher, matches));
    EXPECT_EQ(1u, matches.size());
    EXPECT_EQ(0, matchRotated(Mat(), Mat(), iib, matcher, none, one, matches));
    EXPECT_TRUE(matches.empty());
}

TEST(IIB_MatchRotated, errors)
{
    RotatedPair pair(60);
    const Ptr<IIB> iib = rotating();
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
    std::vector<KeyPoint> first = pair.keypoints[0], second = pair.keypoints[1];
    std::vector<DMatch> matches;
    first[0].angle = second[0].angle = 77;
    const auto call = [&](const Ptr<IIB>& extractor, const Ptr<HierarchicalMatcher>& m, double rotation) {
        return [&, extractor, m, rotation] {
            matchRotated(pair.images[0], first, pair.images[1], second, extractor, m, matches, rotation);
        };
    };
    expectError(Error::StsNullPtr, "no extractor", call(Ptr<IIB>(), matcher, -1));
    expectError(Error::StsNullPtr, "no matcher", call(iib, Ptr<HierarchicalMatcher>(), -1));
    expectError(Error::StsNullPtr, "no extractor", [&] {
        matchRotated(pair.images[0], pair.images[1], Ptr<IIB>(), matcher, first, second, matches);
    });
    for (double rotation : {-10., 360., (double)NOT_A_NUMBER, (double)ENDLESS})
        expectError(Error::StsOutOfRange, "rotation is", call(iib, matcher, rotation));
    for (int orientation : {IIB::ORIENTATION_NONE, IIB::ORIENTATION_GRADIENT})
    {
        iib->setOrientation(orientation);
        expectError(Error::StsBadArg, "ORIENTATION_KEYPOINT", call(iib, matcher, -1));
    }
    iib->setOrientation(IIB::ORIENTATION_KEYPOINT);
    const Ptr<IIB> withMap = IIB::create(2.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, true, 1);
    expectError(Error::StsBadArg, "extra channel", call(withMap, matcher, -1));
    second[3].pt.x = NOT_A_NUMBER;
    for (double rotation : {-1., 10.})
        expectError(Error::StsBadArg, "keypoint 3", call(rotating(), matcher, rotation));
    second[3].pt.x = 0;
    pair.images[1].convertTo(pair.images[1], CV_32F);
    pair.images[1].at<float>(30, 20) = NOT_A_NUMBER;
    for (double rotation : {-1., 10.})
        expectError(Error::StsBadArg, "(20, 30)", call(rotating(), matcher, rotation));
    pair.images[1].convertTo(pair.images[1], CV_32S);
    for (double rotation : {-1., 10.})
        expectError(Error::StsUnsupportedFormat, "32S", call(rotating(), matcher, rotation));
    // arguments are unchanged
    EXPECT_EQ(77, first[0].angle);
    EXPECT_EQ(77, second[0].angle);
    const size_t count = first.size();
    const auto detecting = [&](const Ptr<IIB>& extractor, const Ptr<HierarchicalMatcher>& m,
                                   double rotation) {
        return [&, extractor, m, rotation] {
            matchRotated(pair.images[0], pair.images[0], extractor, m, first, second, matches, rotation);
        };
    };
    expectError(Error::StsNullPtr, "no matcher", detecting(rotating(), Ptr<HierarchicalMatcher>(), -1));
    expectError(Error::StsOutOfRange, "rotation is", detecting(rotating(), matcher, 400));
    expectError(Error::StsBadArg, "ORIENTATION_KEYPOINT", detecting(IIB::create(), matcher, -1));
    expectError(Error::StsBadArg, "extra channel", detecting(withMap, matcher, -1));
    EXPECT_EQ(count, first.size());
    EXPECT_EQ(77, first[0].angle);
    EXPECT_EQ(77, second[0].angle);
}

// At half the image's size it would be 0.
TEST(IIB_MatchRotated, the_least_size_is_one)
{
    RotatedPair pair(60);
    std::vector<DMatch> matches;
    pair.keypoints[0][3].size = std::numeric_limits<float>::denorm_min();
    pair.keypoints[0][3].response = FLT_MAX;  // among the strongest, which are tried
    EXPECT_NO_THROW(matchRotated(pair.images[0], pair.keypoints[0], pair.images[1], pair.keypoints[1],
            rotating(), HierarchicalMatcher::createRecommended(), matches));
}

}}  // namespace opencv_test

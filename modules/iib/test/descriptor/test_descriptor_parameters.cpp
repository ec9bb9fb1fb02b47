// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_errors.hpp"

namespace opencv_test { namespace {

TEST(IIB_Parameters, names_and_sizes)
{
    const Ptr<IIB> iib = IIB::create();
    EXPECT_EQ("Feature2D.IIB", iib->getDefaultName());
    EXPECT_FALSE(iib->empty());
    EXPECT_EQ(CV_8U, iib->descriptorType());
    EXPECT_EQ(NORM_HAMMING, iib->defaultNorm());
    EXPECT_EQ(170, iib->descriptorSize());
    EXPECT_EQ((std::vector<int>{2, 8, 32, 128}), iib->levelSizes());
    iib->setOverlap(true);
    EXPECT_EQ((std::vector<int>{2, 18, 98, 450}), iib->levelSizes());  // 4544 bits
    iib->setOverlap(false);
    iib->setChannels(IIB::CHANNEL_GRAD_X | IIB::CHANNEL_GRAD_Y);
    iib->setMapping(IIB::MAPPING_HAAR);
    EXPECT_EQ((std::vector<int>{1, 3, 12, 48}), iib->levelSizes());
    iib->setChannels(IIB::CHANNELS_DEFAULT);
    const Mat quads = Mat_<int>({2, 5}, {1, 0, 0, 0, 7, 4, 3, 14, 0, 1});
    iib->setSelection(quads);
    EXPECT_EQ((std::vector<int>{1, 1}), iib->levelSizes());  // levels without a bit are left out
    EXPECT_EQ(2, iib->descriptorSize());
}

TEST(IIB_Parameters, setters_and_what_ends_a_selection)
{
    typedef void (*Set)(IIB&, int);
    const Set keep[] = {[](IIB& i, int) { i.setScaleFactor(7.5f); },
            [](IIB& i, int) { i.setUseOrientation(true); },
            [](IIB& i, int) { i.setBorder(IIB::BORDER_DROP); },
            [](IIB& i, int) { i.setDetector(SIFT::create()); }};
    const Set end[] = {[](IIB& i, int change) { i.setGranularity(4 + change); },
            [](IIB& i, int change) { i.setChannels(15 + 16 * change); },
            [](IIB& i, int change) { i.setMapping(change); },
            [](IIB& i, int change) { i.setOverlap(change != 0); },
            [](IIB& i, int change) { i.setExtraChannels(change); }};
    const Mat quads = Mat_<int>({1, 5}, {2, 1, 0, 2, 5});
    const Ptr<IIB> iib = IIB::create();
    EXPECT_TRUE(iib->getSelection().empty());
    iib->setSelection(quads);
    for (Set set : keep)
        set(*iib, 1);
    EXPECT_EQ(0, cvtest::norm(quads, iib->getSelection(), NORM_INF));
    EXPECT_EQ(7.5f, iib->getScaleFactor());
    EXPECT_TRUE(iib->getUseOrientation());
    EXPECT_EQ(IIB::BORDER_DROP, iib->getBorder());
    EXPECT_EQ("Feature2D.SIFT", iib->getDetector()->getDefaultName());
    for (Set set : end)
    {
        set(*iib, 0);  // the value it has: no change
        EXPECT_EQ(1, iib->getSelection().rows);
        set(*iib, 1);
        EXPECT_TRUE(iib->getSelection().empty());
        set(*iib, 0);
        iib->setSelection(quads);
    }
    iib->getSelection().setTo(0);  // a copy
    EXPECT_EQ(0, cvtest::norm(quads, iib->getSelection(), NORM_INF));
    iib->setSelection(noArray());
    EXPECT_TRUE(iib->getSelection().empty());
    EXPECT_EQ(170, iib->descriptorSize());
}

//! The same for create() and for a setter, which must leave everything as it was.
template <typename Create, typename Set>
void expectParameterError(int code, const String& culprit, const Create& create, const Set& set)
{
    expectError(code, culprit, create);
    const Ptr<IIB> iib = IIB::create(3.f, 3, 5, IIB::MAPPING_HAAR, true, true, 2);
    const Mat quad = Mat_<int>({1, 5}, {3, 1, 2, 2, 7});
    iib->setSelection(quad);
    expectError(code, culprit, [&] { set(*iib); });
    EXPECT_EQ(3.f, iib->getScaleFactor());
    EXPECT_EQ(3, iib->getGranularity());
    EXPECT_EQ(5, iib->getChannels());
    EXPECT_EQ(IIB::MAPPING_HAAR, iib->getMapping());
    EXPECT_EQ(2, iib->getExtraChannels());
    EXPECT_EQ(IIB::BORDER_REFLECT, iib->getBorder());
    EXPECT_EQ(1, iib->getSelection().rows);
    EXPECT_EQ(1, iib->descriptorSize());
}

TEST(IIB_Parameters, mistakes_throw_and_change_nothing)
{
    for (float value : {0.f, -1.f, NOT_A_NUMBER, ENDLESS, -ENDLESS})
        expectParameterError(
                Error::StsOutOfRange, "scaleFactor is", [=] { IIB::create(value); },
                [=](IIB& iib) { iib.setScaleFactor(value); });
    for (int value : {0, 7, -1, INT_MAX, INT_MIN})
        expectParameterError(
                Error::StsOutOfRange, format("granularity is %d", value), [=] { IIB::create(2.f, value); },
                [=](IIB& iib) { iib.setGranularity(value); });
    for (int value : {64, 64 + 15, -1, INT_MIN})
        expectParameterError(
                Error::StsBadArg, format("channels is %d", value), [=] { IIB::create(2.f, 4, value); },
                [=](IIB& iib) { iib.setChannels(value); });
    for (int value : {-1, 8, INT_MAX})
        expectParameterError(
                Error::StsBadArg, format("mapping is %d", value), [=] { IIB::create(2.f, 4, 15, value); },
                [=](IIB& iib) { iib.setMapping(value); });
    for (int value : {-1, 17, INT_MAX})
        expectParameterError(
                Error::StsOutOfRange, format("extraChannels is %d", value),
                [=] { IIB::create(2.f, 4, 15, 0, false, false, value); },
                [=](IIB& iib) { iib.setExtraChannels(value); });
    for (int value : {-1, 3})
    {
        expectError(
                Error::StsBadArg, format("border is %d", value), [=] { IIB::create()->setBorder(value); });
        expectError(Error::StsBadArg, format("orientation is %d", value),
                [=] { IIB::create()->setOrientation(value); });
    }
    expectError(Error::StsBadArg, "neither channels nor extraChannels", [] { IIB::create(2.f, 4, 0); });
    expectError(
            Error::StsBadArg, "neither channels nor extraChannels", [] { IIB::create()->setChannels(0); });
    expectError(
            Error::StsNullPtr, "the detector is null", [] { IIB::create()->setDetector(Ptr<Feature2D>()); });
}

TEST(IIB_Parameters, mistakes_in_selections)
{
    const Ptr<IIB> iib = IIB::create(2.f, 3, 3, IIB::MAPPING_HAAR);
    const Mat kept = Mat_<int>({1, 5}, {1, 0, 0, 0, 1});
    iib->setSelection(kept);
    struct
    {
        int code;
        const char* culprit;
        Mat selection;
    } cases[] = {{Error::StsBadArg, "32FC1 with 5", Mat(1, 5, CV_32F, Scalar(1))},
            {Error::StsBadArg, "with 4", Mat(2, 4, CV_32S, Scalar(1))},
            {Error::StsBadArg, "32SC5", Mat(1, 1, CV_32SC(5))},
            {Error::StsOutOfRange, "row 0: level 0", Mat_<int>({1, 5}, {0, 0, 0, 0, 1})},
            {Error::StsOutOfRange, "row 0: level 4", Mat_<int>({1, 5}, {4, 0, 0, 0, 1})},
            {Error::StsOutOfRange, "row 1: level 2", Mat_<int>({2, 5}, {3, 0, 0, 0, 1, 2, 0, 0, 0, 1})},
            {Error::StsOutOfRange, "row 0: channel 2", Mat_<int>({1, 5}, {1, 2, 0, 0, 1})},
            {Error::StsOutOfRange, "row 0: channel -1", Mat_<int>({1, 5}, {1, -1, 0, 0, 1})},
            {Error::StsOutOfRange, "row 0: cell (3, 0)", Mat_<int>({1, 5}, {2, 0, 3, 0, 1})},
            {Error::StsOutOfRange, "row 0: cell (0, -1)", Mat_<int>({1, 5}, {2, 0, 0, -1, 1})},
            {Error::StsOutOfRange, "row 0: bit mask 8", Mat_<int>({1, 5}, {2, 0, 0, 0, 8})},
            {Error::StsOutOfRange, "row 0: bit mask 0", Mat_<int>({1, 5}, {2, 0, 0, 0, 0})},
            {Error::StsBadArg, "row 1 repeats a quad", Mat_<int>({2, 5}, {2, 0, 0, 0, 1, 2, 0, 0, 0, 2})}};
    for (const auto& c : cases)
        expectError(c.code, c.culprit, [&] { iib->setSelection(c.selection); });
    EXPECT_EQ(0, cvtest::norm(kept, iib->getSelection(), NORM_INF));
}

}}  // namespace opencv_test

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/textures.hpp"

/* The exact bits, which no build, machine or later version may change without a new major version: descriptors in
 files would no longer match. A test that fails prints its line of the table. All lines:

    opencv_test_iib --gtest_filter='IIB_Golden*' | grep '^ *{ "'

 The images and keypoints are made of integers alone (test_images.cpp). */
namespace opencv_test { namespace {

struct Golden
{
    const char* name;
    uint64 clamped, reflected;  //!< with each #Border that keeps all keypoints
    int type;
    int parameters[7];  //!< of create() after the scale factor; whether someQuads() are selected
};

const Golden GOLDEN[] = {{"default", 0x7c4943b59e478a06, 0x2e989fe2274d8bf2, CV_8UC1, {4, 15}},
        {"mapping max", 0x40d0d530ef404756, 0x6f1e2f008211b314, CV_8UC1, {4, 15, IIB::MAPPING_MAX}},
        {"mapping min", 0xcecf80374d6189d5, 0x1166efbb3e6630fe, CV_8UC1, {4, 15, IIB::MAPPING_MIN}},
        {"mapping quartile", 0x012bfe1b74cbb35c, 0x1abdc4b0d0b8ac66, CV_8UC1, {4, 15, IIB::MAPPING_QUARTILE}},
        {"mapping sort", 0x2c9dffdd4a509c8f, 0x6518c482f51ed635, CV_8UC1, {4, 15, IIB::MAPPING_SORT}},
        {"mapping haar", 0x0c7717b926942607, 0x98ff44bc0e4ebbd9, CV_8UC1, {4, 15, IIB::MAPPING_HAAR}},
        {"mapping pairwise", 0xcd3c1fb23c418b3a, 0x7eed83a5daee609b, CV_8UC1, {4, 15, IIB::MAPPING_PAIRWISE}},
        {"mapping boxes", 0xcad76b68589c37fa, 0x35fcadab22d3f94b, CV_8UC1, {5, 59, IIB::MAPPING_BOXES}},
        {"mapping boxes, orientation of keypoints", 0xa9296c8b035f5704, 0xf32b3d751c69e7bc, CV_8UC1,
                {5, 59, IIB::MAPPING_BOXES, false, true}},
        {"gradient x", 0x9bf9c215914d0cc5, 0xc11d46de728f8b7c, CV_8UC1, {4, 1}},
        {"gradient y", 0xb7821168e4920a80, 0x2716add01922d585, CV_8UC1, {4, 2}},
        {"orientation", 0x1257bf40469fba74, 0xa490c5b82813dace, CV_8UC1, {4, 4}},
        {"intensity", 0x5ccb1e57398af58b, 0xcd05d999878cc505, CV_8UC1, {4, 8}},
        {"signed gradient x", 0x515a05677ff21834, 0x921175f76b8a16aa, CV_8UC1, {4, 16}},
        {"signed gradient y", 0xb3d9120c4f31769f, 0x874380f23165ad56, CV_8UC1, {4, 32}},
        {"all channels", 0x7533fec7ca149e12, 0xba5b3811ad475236, CV_8UC1, {4, 63}},
        {"overlap", 0x00d9099cf996758a, 0xb6fd87a0cae57e55, CV_8UC1, {4, 15, 0, true}},
        {"granularity 1", 0xde85d223b5ebe44c, 0x4798df25809b6a14, CV_8UC1, {1, 15}},
        {"granularity 2", 0x2b3e3b7e2247a78b, 0xe5f6c202dde19d6f, CV_8UC1, {2, 15}},
        {"granularity 3", 0x76c690f21057f720, 0x9c9d12c8f749de7c, CV_8UC1, {3, 15}},
        {"granularity 5", 0x335d65f21031895e, 0x14a38de43d3cffd2, CV_8UC1, {5, 15}},
        {"granularity 6", 0xc8b98b604530e595, 0x469d9af574fa958b, CV_8UC1, {6, 15}},
        {"extra channels", 0x3ad673a19c71489b, 0xd050ead518708479, CV_8UC1, {4, 15, 0, false, false, 3}},
        {"extra channels alone", 0x2384ba4913fccf32, 0x46edd4bcef271ae3, CV_8UC1, {4, 0, 0, false, false, 5}},
        {"orientation of keypoints", 0xc9b6b569adef32d3, 0xcf5d28d3a6d3c3cf, CV_8UC1,
                {4, 15, 0, false, true}},
        {"16U", 0x3a73cd0cc49a4d35, 0xacd8eaffd184a7b8, CV_16UC1, {4, 15}},
        {"16U, orientation of keypoints", 0x244c6a56586d3caa, 0xed9b15a2a6529935, CV_16UC1,
                {4, 15, 0, false, true}},
        {"32F", 0xe2fae45b47d39a52, 0xf7c8c748aa6ac915, CV_32FC1, {4, 15}},
        {"8U colour", 0x5f19de037522b744, 0xb45d221b4e67cc73, CV_8UC3, {4, 15}},
        {"32F colour", 0x5dbab4a1ac078b99, 0x2f0bca6c2417e44b, CV_32FC3, {4, 15}},
        {"selection", 0x4b159b8d342f9f70, 0xf4dddd863a1c586a, CV_8UC1, {4, 15, 0, false, false, 0, true}},
        {"selection, orientation of keypoints", 0x6358ca80c16b3c4b, 0x1660dccffba8e262, CV_8UC1,
                {4, 15, 0, false, true, 0, true}}};

Mat someQuads()
{
    Mat_<int> quads;
    for (int level = 1; level <= 4; level++)
        for (int i = 0; i < 6; i++)
        {
            const int n = (1 << level) - 1;
            const Mat_<int> quad = Mat_<int>({1, 5}, {level, (i + level) % 4, i * 5 % n, i / n, 1 + i * 2});
            if (i < 1 || level > 1)
                quads.push_back(quad);
        }
    return quads;
}

Mat image(Size size, int type)
{
    const int channels = CV_MAT_CN(type), depth = CV_MAT_DEPTH(type);
    Mat m = texture(Size(size.width * channels, size.height), depth == CV_8U ? CV_8U : CV_16U, 1);
    if (depth == CV_32F)
        m.convertTo(m, CV_32F, 1. / 4096, -3);  // exact
    return m.reshape(channels);
}

class IIB_Golden : public testing::TestWithParam<Golden>
{
};

TEST_P(IIB_Golden, bits)
{
    const Golden golden = GetParam();
    const Size size(320, 240);
    const int* p = golden.parameters;
    const Ptr<IIB> iib = IIB::create(2.f, p[0], p[1], p[2], p[3] != 0, p[4] != 0, p[5]);
    if (p[6])
        iib->setSelection(someQuads());
    std::vector<Mat> extra;
    for (int i = 0; i < iib->getExtraChannels(); i++)
        extra.push_back(texture(size, i % 2 ? CV_16U : CV_8U, 100 + i));
    std::vector<KeyPoint> keypoints = scatter(size, 500, 3.f, 40.f, 2);
    keypoints.push_back(KeyPoint(160, 120, 300));
    const auto hashWith = [&](int border) {
        std::vector<KeyPoint> copy = keypoints;
        Mat descriptors;
        iib->setBorder(border);
        iib->compute(image(size, golden.type), extra, copy, descriptors);
        return hashOf(descriptors);
    };
    const uint64 clamped = hashWith(IIB::BORDER_CLAMP), reflected = hashWith(IIB::BORDER_REFLECT);
    EXPECT_EQ(golden.clamped, clamped);
    EXPECT_EQ(golden.reflected, reflected);
    if (golden.clamped != clamped || golden.reflected != reflected)
        std::cout << format("    { \"%s\", 0x%016llx, 0x%016llx,\n", golden.name, (unsigned long long)clamped,
                (unsigned long long)reflected);
}

void PrintTo(const Golden& golden, std::ostream* os) { *os << golden.name; }

String nameOf(const testing::TestParamInfo<Golden>& info)
{
    String name = info.param.name;
    for (char& c : name)
        if (!isalnum(c))
            c = '_';
    return name;
}

INSTANTIATE_TEST_CASE_P(/**/, IIB_Golden, testing::ValuesIn(GOLDEN), nameOf);

}}  // namespace opencv_test

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "perf_precomp.hpp"

namespace opencv_test {
namespace {

enum
{
    PEER_ORB = -1,
    OVERLAP = 100,
    GRANULARITY_5,
    ORIENTED,
    UNIVERSAL,
    UNIVERSAL_ORIENTED
};
CV_ENUM(Descriptor, PEER_ORB, IIB::MAPPING_MEAN, IIB::MAPPING_MAX, IIB::MAPPING_MIN, IIB::MAPPING_QUARTILE,
        IIB::MAPPING_SORT, IIB::MAPPING_HAAR, IIB::MAPPING_PAIRWISE, OVERLAP, GRANULARITY_5, ORIENTED,
        UNIVERSAL, UNIVERSAL_ORIENTED)

Ptr<Feature2D> createUniversal(bool oriented)
{
    const Ptr<IIB> iib = IIB::createPreset(IIB::PRESET_UNIVERSAL);
    iib->setUseOrientation(oriented);
    return iib;
}

Ptr<Feature2D> createDescriptor(int descriptor)
{
    switch (descriptor)
    {
    case PEER_ORB: return ORB::create();
    case OVERLAP: return IIB::create(2.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, true);
    case GRANULARITY_5: return IIB::create(2.f, 5);
    case UNIVERSAL: return createUniversal(false);
    case UNIVERSAL_ORIENTED: return createUniversal(true);
    case ORIENTED: return IIB::create(2.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, true);
    default: return IIB::create(2.f, 4, IIB::CHANNELS_DEFAULT, descriptor);
    }
}

struct Scene
{
    explicit Scene(int count) : image(720, 1280, CV_8U)
    {
        randu(image, 0, 256);
        GaussianBlur(image, image, Size(5, 5), 1.);
        RNG& rng = theRNG();
        for (int i = 0; i < count; i++)
            keypoints.push_back(KeyPoint((float)rng.uniform(32, 1248), (float)rng.uniform(32, 688), 31.f,
                    rng.uniform(0.f, 360.f)));
    }

    void describe(const Ptr<Feature2D>& descriptor) { descriptor->compute(image, keypoints, descriptors); }

    Mat image, descriptors;
    std::vector<KeyPoint> keypoints;
    const Threads one{1};
};

typedef perf::TestBaseWithParam<tuple<Descriptor, int>> IIB_Compute;  // descriptor, keypoints

PERF_TEST_P(IIB_Compute, hd, testing::Combine(Descriptor::all(), testing::Values(1000, 5000)))
{
    Scene scene(get<1>(GetParam()));
    const Ptr<Feature2D> descriptor = createDescriptor(get<0>(GetParam()));
    TEST_CYCLE() scene.describe(descriptor);
    SANITY_CHECK_NOTHING();
}

}  // namespace
}  // namespace opencv_test

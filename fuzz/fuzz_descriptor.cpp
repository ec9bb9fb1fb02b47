// SPDX-License-Identifier: Apache-2.0

// IIBDescriptorExtractor::compute with any parameters, image, keypoints and extra maps. Expects a cv::Exception, or the
// descriptors of the naive oracle, twice.

#include "images.hpp"
#include "support/descriptor_oracle.hpp"

#include <cmath>
#include <numeric>

#include "opencv2/iib.hpp"

namespace {

using namespace fuzz;
using cv::iib::IIB;

//! @param mayBeRefused receives whether a setter may refuse any of the parameters.
Ptr<IIB> drawExtractor(ByteSource& in, bool& mayBeRefused)
{
    if (in.between(0, 7) == 7)
    {
        mayBeRefused = true;
        const int preset = in.between(-1, 9);
        return IIB::createPreset(preset, in.number());
    }
    Ptr<IIB> iib = IIB::create();
    const int wild = in.between(0, 3) == 3;  // a quarter of the runs has values out of range
    mayBeRefused = wild != 0;
    iib->setScaleFactor(wild ? in.number() : 1 + in.between(0, 40) / 8.f);
    iib->setGranularity(in.between(1 - wild, (in.rarely(8) ? in.rarely(8) ? 6 : 3 : 2) + wild));
    iib->setExtraChannels(in.rarely(32) ? in.between(-wild, 16 + wild) : in.between(0, 1));
    iib->setChannels(in.between(1 - wild, 63 + wild));
    const int mapping = in.between(-wild, IIB::MAPPING_BOXES + wild);
    mayBeRefused = mayBeRefused || mapping == IIB::MAPPING_BOXES;  // refused with overlap and some channels
    iib->setMapping(mapping);
    iib->setOverlap(in.flag());
    iib->setOrientation(in.between(-wild, 2 + wild));
    iib->setBorder(in.between(-wild, 2 + wild));
    if (in.flag())
    {
        mayBeRefused = true;
        const int rows = in.between(0, in.rarely(8) ? 20 : 5);
        Mat_<int> quads(rows, 5);
        int level = 1;
        for (int i = 0; i < rows; i++)
        {
            level = std::min(level + (in.between(0, 3) == 0), iib->getGranularity());
            const bool boxes = iib->getMapping() == IIB::MAPPING_BOXES;
            const int side = boxes ? (in.rarely(4) ? 8 : 2) : (1 << level) - 2;
            const int quad[] = {level, in.between(-wild, 5), in.between(-wild, side + wild),
                    in.between(-wild, side), in.between(1 - wild, 15)};
            std::copy(std::begin(quad), std::end(quad), quads[i]);
        }
        iib->setSelection(quads);
    }
    return iib;
}

std::vector<KeyPoint> drawKeyPoints(ByteSource& in, Size size)
{
    std::vector<KeyPoint> keypoints;
    const bool wild = in.flag();
    for (int i = in.between(0, in.rarely(64) ? 30 : 2); i > 0; i--)
    {
        KeyPoint kp;
        kp.pt.x = wild ? in.number() : in.between(-20, size.width + 20) + in.between(0, 3) / 4.f;
        kp.pt.y = wild ? in.number() : in.between(-20, size.height + 20) + in.between(0, 3) / 4.f;
        kp.size = wild ? in.number() : in.between(1, in.rarely(4) ? 255 : 40) / 4.f;
        kp.angle = wild ? in.number() : (float)in.between(-1, 360);
        keypoints.push_back(kp);
    }
    return keypoints;
}

//! Whether the header allows these arguments.
bool areValid(const IIB& iib, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints)
{
    const bool readsAngles = iib.getOrientation() == IIB::ORIENTATION_KEYPOINT;
    for (const KeyPoint& kp : keypoints)
        if (!std::isfinite(kp.pt.x) || !std::isfinite(kp.pt.y) || !std::isfinite(kp.size) || kp.size <= 0 ||
                (readsAngles && !std::isfinite(kp.angle)))
            return false;
    if (image.empty())
        return true;
    if (!isImage(image) || (int)extra.size() != iib.getExtraChannels())
        return false;
    for (const Mat& m : extra)
        if (!isMap(m) || m.size() != image.size())
            return false;
    return true;
}

void checkAgainstOracle(const IIB& iib, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, const Mat& descriptors)
{
    bool cheap = image.channels() == 1 && image.depth() != CV_32F && image.total() <= 64 * 64 &&
                 keypoints.size() <= 8;
    for (const Mat& m : extra)
        cheap = cheap && m.depth() != CV_32F;
    if (!cheap)
        return;
    const Mat expected = oracle::describe(iib, image, extra, keypoints);
    FUZZ_CHECK(expected.size() == descriptors.size() && norm(expected, descriptors, NORM_INF) == 0);
}

}  // namespace

FUZZ_TARGET
{
    Ptr<IIB> iib;
    bool mayBeRefused = false;
    if (refused([&] { iib = drawExtractor(in, mayBeRefused); }))
    {
        FUZZ_CHECK(mayBeRefused);
        return;
    }
    const std::vector<int> levels = iib->levelSizes();
    FUZZ_CHECK(std::accumulate(levels.begin(), levels.end(), 0) == iib->descriptorSize());

    const Size size = drawSize(in);
    const bool odd = in.between(0, 15) == 15;  // types that may be refused
    const Mat image = drawImage(in, size, odd);
    std::vector<Mat> extra;
    for (int i = iib->getExtraChannels() + odd; i > 0; i--)
        extra.push_back(drawImage(in, odd ? drawSize(in) : size, drawDepth(in), 1));
    const std::vector<KeyPoint> given = drawKeyPoints(in, size);

    std::vector<KeyPoint> keypoints = given, again = given;
    Mat descriptors(3, 3, CV_8U), repeated;
    const bool thrown = refused([&] { iib->compute(image, extra, keypoints, descriptors); });
    FUZZ_CHECK(thrown != areValid(*iib, image, extra, given));
    if (thrown)
        return;
    FUZZ_CHECK(iib->getBorder() == IIB::BORDER_DROP || keypoints.size() == given.size());
    if (image.empty() || keypoints.empty())
    {
        FUZZ_CHECK(descriptors.empty());
        return;
    }
    FUZZ_CHECK(descriptors.type() == CV_8U &&
               descriptors.size() == Size(iib->descriptorSize(), (int)keypoints.size()));
    checkAgainstOracle(*iib, image, extra, keypoints, descriptors);

    // The bits must not depend on memory or on the split of the work.
    if (in.rarely(128))
        useThreads(3);
    for (Mat& m : extra)
        m = m.clone();
    iib->compute(image.clone(), extra, again, repeated);
    FUZZ_CHECK(again.size() == keypoints.size() && norm(descriptors, repeated, NORM_INF) == 0);
}

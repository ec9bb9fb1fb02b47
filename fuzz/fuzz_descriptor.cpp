// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// IIBDescriptorExtractor::compute with any parameters, image, keypoints and extra maps: a cv::Exception or
// descriptors that the naive oracle and a second run give as well.

#include "byte_source.hpp"
#include "support/descriptor_oracle.hpp"

#include <cmath>
#include <numeric>

#include "opencv2/iib.hpp"

namespace {

using namespace cv;
using cv::iib::IIB;

//! Pixels of any type: noise, ramps, flat places, extremes, and in floats a rare NaN or infinity.
Mat takeImage(ByteSource& in, Size size, int depth, int channels)
{
    Mat image(size, CV_MAKETYPE(depth, channels));
    const int kind = in.between(0, 7);
    RNG rng(in.take<ushort>());
    if (kind < 3)
        rng.fill(image, RNG::UNIFORM, depth == CV_8S || depth == CV_16S ? -100 : 0,
                depth % 8 < 2 ? 256 : 65536);
    else if (kind < 5)
        for (int y = 0; y < image.rows; y++)
            image.row(y).setTo(Scalar::all(kind == 3 ? y * 7 % 256 : (y & 1) * 65535));
    else
        image.setTo(Scalar::all(kind == 5 ? 0 : 65535));
    if (depth == CV_32F && in.between(0, 3) == 0)
        for (int i = in.between(0, 3); i > 0 && !image.empty(); i--)
            image.ptr<float>(in.between(0, size.height - 1))[in.between(0, size.width * channels - 1)] =
                    in.number();
    // A view into a larger matrix: rows lie apart.
    if (!in.flag() || image.empty())
        return image;
    const Rect inside(Point(in.between(0, 9), in.between(0, 9)), size);
    Mat whole(size + Size(inside.x + 3, inside.y + 3), image.type());
    std::memset(whole.data, 99, whole.total() * whole.elemSize());
    image.copyTo(whole(inside));
    return whole(inside);
}

Size takeSize(ByteSource& in)
{
    const int largest = in.rarely(64) ? 300 : 32;
    const int width = in.between(0, largest);
    return Size(width, in.between(0, largest));
}

Ptr<IIB> takeExtractor(ByteSource& in)
{
    if (in.between(0, 7) == 7)
    {
        const int preset = in.between(-1, 7);
        return IIB::createPreset(preset, in.number());
    }
    Ptr<IIB> iib = IIB::create();
    const int wild = in.between(0, 3) == 3;  // values out of range in a quarter of the runs
    iib->setScaleFactor(wild ? in.number() : 1 + in.between(0, 40) / 8.f);
    iib->setGranularity(in.between(1 - wild, (in.rarely(32) ? 6 : 3) + wild));
    iib->setExtraChannels(in.rarely(8) ? in.between(-wild, 16 + wild) : 0);
    iib->setChannels(in.between(1 - wild, 63 + wild));
    iib->setMapping(in.between(-wild, 6 + wild));
    iib->setOverlap(in.flag());
    iib->setUseOrientation(in.flag());
    iib->setBorder(in.between(-wild, 1 + wild));
    if (in.flag())
    {
        const int rows = in.between(0, 20);
        Mat_<int> quads(rows, 5);
        int level = 1;
        for (int i = 0; i < rows; i++)
        {
            level = std::min(level + (in.between(0, 3) == 0), iib->getGranularity());
            const int side = (1 << level) - 2;
            const Mat_<int> quad = (Mat_<int>(1, 5) << level, in.between(-wild, 5),
                    in.between(-wild, side + wild), in.between(-wild, side), in.between(1 - wild, 15));
            quad.copyTo(quads.row(i));
        }
        iib->setSelection(quads);
    }
    return iib;
}

std::vector<KeyPoint> takeKeyPoints(ByteSource& in, Size size)
{
    std::vector<KeyPoint> keypoints;
    const bool wild = in.flag();
    for (int i = in.between(0, in.rarely(32) ? 30 : 3); i > 0; i--)
    {
        KeyPoint kp;
        kp.pt.x = wild ? in.number() : in.between(-20, size.width + 20) + in.between(0, 3) / 4.f;
        kp.pt.y = wild ? in.number() : in.between(-20, size.height + 20) + in.between(0, 3) / 4.f;
        kp.size = wild ? in.number() : in.between(1, 255) / 4.f;
        kp.angle = wild ? in.number() : (float)in.between(-1, 360);
        keypoints.push_back(kp);
    }
    return keypoints;
}

bool isMap(const Mat& m)
{
    return (m.depth() == CV_8U || m.depth() == CV_16U || m.depth() == CV_32F) && checkRange(m);
}

//! Whether the header allows these arguments.
bool areValid(const IIB& iib, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints)
{
    for (const KeyPoint& kp : keypoints)
        if (!std::isfinite(kp.pt.x) || !std::isfinite(kp.pt.y) || !std::isfinite(kp.size) ||
                !std::isfinite(kp.angle) || kp.size <= 0)
            return false;
    if (image.empty())
        return true;
    if (!isMap(image) || image.channels() == 2 || image.channels() > 4 ||
            (int)extra.size() != iib.getExtraChannels())
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

void run(ByteSource& in)
{
    const Ptr<IIB> iib = takeExtractor(in);
    const std::vector<int> levels = iib->levelSizes();
    FUZZ_CHECK(std::accumulate(levels.begin(), levels.end(), 0) == iib->descriptorSize());

    const Size size = takeSize(in);
    const bool odd = in.between(0, 15) == 15;  // a type that is refused
    const int depths[] = {CV_8U, CV_8U, CV_16U, CV_32F}, channels[] = {1, 1, 3, 4};
    const int depth = odd ? in.between(0, 7) : depths[in.between(0, 3)];
    const Mat image = takeImage(in, size, depth, odd ? in.between(1, 4) : channels[in.between(0, 3)]);
    std::vector<Mat> extra;
    for (int i = iib->getExtraChannels() + odd; i > 0; i--)
        extra.push_back(takeImage(in, odd ? takeSize(in) : size, depths[in.between(0, 3)], 1));
    const std::vector<KeyPoint> given = takeKeyPoints(in, size);

    std::vector<KeyPoint> keypoints = given, again = given;
    Mat descriptors(3, 3, CV_8U), repeated;
    setNumThreads(1);
    bool thrown = false;
    try
    {
        iib->compute(image, extra, keypoints, descriptors);
    }
    catch (const cv::Exception&)
    {
        thrown = true;
    }
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

    // Other memory, another cut of the work, the same bits.
    if (in.rarely(32))  // new threads take as long as the rest
        setNumThreads(in.between(2, 4));
    for (Mat& m : extra)
        m = m.clone();
    iib->compute(image.clone(), extra, again, repeated);
    FUZZ_CHECK(again.size() == keypoints.size() && norm(descriptors, repeated, NORM_INF) == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uchar* data, size_t size) { return runTarget(run, data, size); }

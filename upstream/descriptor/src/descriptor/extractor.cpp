// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

/* Implementation of the article:
     Xinyu Lin, Yingjie Zhou, Xun Zhang, Yipeng Liu, Ce Zhu.
     Illumination-insensitive Binary Descriptor for Visual Measurement Based on Local Inter-patch Invariance.
     arXiv:2305.07943, 2023.

 The image becomes four channels, and these one integral image with four sums a pixel. Each keypoint's cells are
 differences of its corners, coarser cells are sums of finer ones, and quads of cells become bits. All of this is done
 on integers, so that bits do not depend on the machine. */

#include "../precomp.hpp"

#include <numeric>

#include "opencv2/core/utils/trace.hpp"
#include "integral.hpp"
#include "quad_numbers.hpp"

namespace cv { namespace iib {

namespace {

constexpr int MAX_GRANULARITY = 6;
constexpr int MAX_PIXELS = 1 << 22;  //!< of a region: their sum fits 32 bits

//! The bits of a quad: a byte for each bit of the mapping, with the bit of channel c at its place c.
typedef uchar QuadBits[8];

//! Factors that make the sums over the four cells of a quad comparable.
typedef int QuadWeights[4];

/** The bits of every other quad of a row, the first one at its left end.
 @param top, bottom the sums over the cells of the row, and of the row below. */
typedef void (*MapRow)(
        const unsigned* top, const unsigned* bottom, const QuadWeights* weights, int quads, QuadBits* bits);

template <typename Mapping>
void mapRow(
        const unsigned* top, const unsigned* bottom, const QuadWeights* weights, int quads, QuadBits* bits)
{
    for (int q = 0; q < quads; q++, top += 2 * CHANNELS, bottom += 2 * CHANNELS)
    {
        uchar* const quad = bits[q];
        const int* const w = weights[q];
        std::fill_n(quad, (int)Mapping::BITS, (uchar)0);
        for (int c = 0; c < CHANNELS; c++)
        {
            const int64 x[4] = {(int64)top[c] * w[0], (int64)top[CHANNELS + c] * w[1],
                    (int64)bottom[c] * w[2], (int64)bottom[CHANNELS + c] * w[3]};
            Mapping::map(x, [&](int bit, bool b) { quad[bit] |= (uchar)(b << c); });
        }
    }
}

//! The same where four times the largest weighted sum fits an int.
template <typename Mapping>
void mapSmallRow(
        const unsigned* top, const unsigned* bottom, const QuadWeights* weights, int quads, QuadBits* bits)
{
#if CV_SIMD128
    const auto weighted = [](const unsigned* sums, int weight) {
        return Lanes(v_mul(v_reinterpret_as_s32(v_load(sums)), v_setall_s32(weight)));
    };
    for (int q = 0; q < quads; q++, top += 2 * CHANNELS, bottom += 2 * CHANNELS)
    {
        uchar* const quad = bits[q];
        const int* const w = weights[q];
        const Lanes x[4] = {weighted(top, w[0]), weighted(top + CHANNELS, w[1]), weighted(bottom, w[2]),
                weighted(bottom + CHANNELS, w[3])};
        Mapping::map(x, [&](int bit, const Lanes& b) { quad[bit] = (uchar)v_signmask(b.v); });
    }
#else
    mapRow<Mapping>(top, bottom, weights, quads, bits);
#endif
}

struct QuadMapping
{
    int bits;
    MapRow map, mapSmall;
};

template <typename Mapping> QuadMapping quadMapping()
{
    const QuadMapping mapping = {Mapping::BITS, mapRow<Mapping>, mapSmallRow<Mapping>};
    return mapping;
}

QuadMapping quadMapping(int mapping)
{
    switch (mapping)
    {
    case IIB::MAPPING_MEAN: return quadMapping<MeanMapping>();
    case IIB::MAPPING_MAX: return quadMapping<ExtremeMapping<true>>();
    case IIB::MAPPING_MIN: return quadMapping<ExtremeMapping<false>>();
    case IIB::MAPPING_QUARTILE: return quadMapping<QuartileMapping>();
    default: return quadMapping<SortMapping>();
    }
}

//! What create() is given.
struct Parameters
{
    float scaleFactor;
    int granularity, channels, mapping;
    bool overlap;

    void check() const
    {
        // written so that NaN fails
        if (!(scaleFactor > 0 && scaleFactor <= FLT_MAX))
            CV_Error(Error::StsOutOfRange,
                    format("scaleFactor is %g; it must be positive and finite", scaleFactor));
        if (granularity < 1 || granularity > MAX_GRANULARITY)
            CV_Error(Error::StsOutOfRange, format("granularity is %d; it must be 1 to 6", granularity));
        if (channels < 1 || channels > IIB::CHANNELS_DEFAULT)
            CV_Error(Error::StsBadArg,
                    format("channels is %d; it must be a sum of CHANNEL_ values", channels));
        if (mapping < IIB::MAPPING_MEAN || mapping > IIB::MAPPING_SORT)
            CV_Error(Error::StsBadArg,
                    format("mapping is %d; it must be one of the MAPPING_ values", mapping));
    }

    std::vector<int> levelBytes() const
    {
        int channelsInUse = 0;
        for (int c = 0; c < CHANNELS; c++)
            channelsInUse += channels >> c & 1;
        std::vector<int> bytes;
        for (int level = 1; level <= granularity; level++)
        {
            const int quadsInRow = overlap ? (1 << level) - 1 : 1 << (level - 1);
            bytes.push_back((quadsInRow * quadsInRow * quadMapping(mapping).bits * channelsInUse + 7) / 8);
        }
        return bytes;
    }
};

//! The region of support of a keypoint (paper, "Local Patch Generation"), in pixels: pixel i covers [i, i + 1).
struct Region
{
    double x, y, side;
    Rect bounds;  //!< the image, reflected once at each side

    Region(const Parameters& p, const KeyPoint& keypoint, Size image)
        : side(std::max((double)p.scaleFactor * keypoint.size, (double)(1 << p.granularity))),
          bounds(1 - image.width, 1 - image.height, 3 * image.width - 2, 3 * image.height - 2)
    {
        x = keypoint.pt.x + 0.5 - side / 2;
        y = keypoint.pt.y + 0.5 - side / 2;
    }

    //! The edge of pixels nearest to a position.
    static int nearest(double position, int first, int last)
    {
        return cvFloor(std::min(std::max(position + 0.5, (double)first), (double)last));
    }
    int column(double offset) const { return nearest(x + offset, bounds.x, bounds.x + bounds.width); }
    int row(double offset) const { return nearest(y + offset, bounds.y, bounds.y + bounds.height); }

    //! Pixels that hold it, perhaps none.
    Rect pixels() const { return Rect(Point(column(0), row(0)), Point(column(side), row(side))); }
};

//! Writes bits, the lowest bit of a byte first.
class BitWriter
{
public:
    explicit BitWriter(uchar* bytes) : next(bytes), pending(0), count(0) {}
    //! The last byte is padded with zeros.
    ~BitWriter()
    {
        if (count)
            *next = (uchar)pending;
    }

    void append(unsigned bits, int n)
    {
        pending |= bits << count;
        count += n;
        if (count < 8)
            return;
        *next++ = (uchar)pending;
        pending >>= 8;
        count -= 8;
    }

private:
    uchar* next;
    unsigned pending;
    int count;
};

//! Describes keypoints, one after another, in one thread.
class Describer
{
public:
    Describer(const Parameters& p, const Mat& integral_, Point origin_)
        : parameters(p), mapping(quadMapping(p.mapping)), levelBytes(p.levelBytes()), integral(integral_),
          origin(origin_), finest(1 << p.granularity), xEdges(finest + 1), yEdges(finest + 1),
          cells((size_t)finest * finest * CHANNELS)
    {
        // of the channels in use, the bits side by side
        for (int all = 0; all < 1 << CHANNELS; all++)
        {
            channelsInUse = 0;
            compact[all] = 0;
            for (int c = 0; c < CHANNELS; c++)
                if (p.channels >> c & 1)
                    compact[all] |= (uchar)((all >> c & 1) << channelsInUse++);
        }
    }

    void describe(const Region& region, uchar* descriptor)
    {
        for (int i = 0; i <= finest; i++)
        {
            xEdges[i] = region.column(region.side / finest * i);
            yEdges[i] = region.row(region.side / finest * i);
        }
        sumCells();
        uchar* level = descriptor + std::accumulate(levelBytes.begin(), levelBytes.end(), 0);
        for (int g = parameters.granularity; g >= 1; g--)
        {
            level -= levelBytes[g - 1];
            writeLevel(1 << g, std::ceil(region.side / (1 << g)), level);
            sumParents(1 << g);
        }
    }

private:
    unsigned* cell(int n, int row, int column) { return &cells[((size_t)row * n + column) * CHANNELS]; }

    //! Of the finest cells: differences of the integral image at their corners.
    void sumCells()
    {
        for (int r = 0; r < finest; r++)
        {
            const unsigned *const top = integral.ptr<unsigned>(yEdges[r] - origin.y),
                                  *const bottom = integral.ptr<unsigned>(yEdges[r + 1] - origin.y);
            unsigned* out = cell(finest, r, 0);
            size_t at = CHANNELS * (size_t)(xEdges[0] - origin.x);
#if CV_SIMD128
            v_uint32x4 left = v_sub(v_load(bottom + at), v_load(top + at));
            for (int c = 1; c <= finest; c++, out += CHANNELS)
            {
                at = CHANNELS * (size_t)(xEdges[c] - origin.x);
                const v_uint32x4 right = v_sub(v_load(bottom + at), v_load(top + at));
                v_store(out, v_sub(right, left));
                left = right;
            }
#else
            for (int c = 1; c <= finest; c++)
            {
                const size_t left = at;
                at = CHANNELS * (size_t)(xEdges[c] - origin.x);
                for (int i = 0; i < CHANNELS; i++)
                    *out++ = bottom[at + i] - top[at + i] - (bottom[left + i] - top[left + i]);
            }
#endif
        }
    }

    //! From n x n cells to half as many in a row, in place.
    void sumParents(int n)
    {
        for (int r = 0; r < n; r += 2)
            for (int c = 0; c < n; c += 2)
                for (int i = 0; i < CHANNELS; i++)
                    cell(n / 2, r / 2, c / 2)[i] = cell(n, r, c)[i] + cell(n, r, c + 1)[i] +
                                                   cell(n, r + 1, c)[i] + cell(n, r + 1, c + 1)[i];
    }

    //! Factors that make the sums over cells i and i + 1 comparable along an axis, without a division.
    void weightsOf(const std::vector<int>& edges, int n, int i, int factors[2]) const
    {
        const int step = finest / n, begin = edges[i * step], middle = edges[(i + 1) * step],
                  end = edges[(i + 2) * step];
        factors[0] = middle - begin == end - middle ? 1 : end - middle;
        factors[1] = middle - begin == end - middle ? 1 : middle - begin;
    }

    //! @param longest bound of the sides of cells.
    void writeLevel(int n, double longest, uchar* level)
    {
        BitWriter writer(level);
        const bool small = 4. * MAX_VALUE * std::pow(longest, 4) <= INT_MAX;
        for (int dy = 0; dy <= (int)parameters.overlap; dy++)
            for (int dx = 0; dx <= (int)parameters.overlap; dx++)
                for (int r = dy; r + 1 < n; r += 2)
                {
                    int y[2], x[2], quads = 0;
                    weightsOf(yEdges, n, r, y);
                    for (int c = dx; c + 1 < n; c += 2, quads++)
                    {
                        weightsOf(xEdges, n, c, x);
                        int* const w = weights[quads];
                        w[0] = y[0] * x[0];
                        w[1] = y[0] * x[1];
                        w[2] = y[1] * x[0];
                        w[3] = y[1] * x[1];
                    }
                    (small ? mapping.mapSmall : mapping.map)(
                            cell(n, r, dx), cell(n, r + 1, dx), weights, quads, bits);
                    for (int bit = 0; bit < mapping.bits; bit++)
                        for (int q = 0; q < quads; q++)
                            writer.append(compact[bits[q][bit]], channelsInUse);
                }
    }

    const Parameters parameters;
    const QuadMapping mapping;
    const std::vector<int> levelBytes;
    const Mat integral;
    const Point origin;  //!< of the integral image, in the image
    const int finest;    //!< cells in a row
    int channelsInUse;
    uchar compact[1 << CHANNELS];
    std::vector<int> xEdges, yEdges;  //!< of the finest cells
    std::vector<unsigned> cells;
    QuadWeights weights[1 << (MAX_GRANULARITY - 1)];  //!< of the quads of a row
    QuadBits bits[1 << (MAX_GRANULARITY - 1)];
};

class IIBDescriptorExtractor_Impl CV_FINAL : public IIBDescriptorExtractor
{
public:
    explicit IIBDescriptorExtractor_Impl(const Parameters& p) : parameters(p) { p.check(); }

    void compute(InputArray image, std::vector<KeyPoint>& keypoints, OutputArray descriptors) CV_OVERRIDE;

    std::vector<int> levelSizes() const CV_OVERRIDE { return parameters.levelBytes(); }
    int descriptorSize() const CV_OVERRIDE
    {
        const std::vector<int> bytes = parameters.levelBytes();
        return std::accumulate(bytes.begin(), bytes.end(), 0);
    }
    int descriptorType() const CV_OVERRIDE { return CV_8U; }
    int defaultNorm() const CV_OVERRIDE { return NORM_HAMMING; }
    bool empty() const CV_OVERRIDE { return false; }
    String getDefaultName() const CV_OVERRIDE { return Feature2D::getDefaultName() + ".IIB"; }

    void setScaleFactor(float value) CV_OVERRIDE { set(&Parameters::scaleFactor, value); }
    float getScaleFactor() const CV_OVERRIDE { return parameters.scaleFactor; }
    void setGranularity(int value) CV_OVERRIDE { set(&Parameters::granularity, value); }
    int getGranularity() const CV_OVERRIDE { return parameters.granularity; }
    void setChannels(int value) CV_OVERRIDE { set(&Parameters::channels, value); }
    int getChannels() const CV_OVERRIDE { return parameters.channels; }
    void setMapping(int value) CV_OVERRIDE { set(&Parameters::mapping, value); }
    int getMapping() const CV_OVERRIDE { return parameters.mapping; }
    void setOverlap(bool value) CV_OVERRIDE { set(&Parameters::overlap, value); }
    bool getOverlap() const CV_OVERRIDE { return parameters.overlap; }

private:
    template <typename T> void set(T Parameters::*member, T value)
    {
        Parameters changed = parameters;
        changed.*member = value;
        changed.check();
        parameters = changed;
    }

    Parameters parameters;
};

void IIBDescriptorExtractor_Impl::compute(
        InputArray imageArray, std::vector<KeyPoint>& keypoints, OutputArray descriptorArray)
{
    CV_TRACE_FUNCTION();

    const Mat image = imageArray.getMat();
    if (image.empty() || keypoints.empty())
    {
        descriptorArray.release();
        return;
    }
    if (image.dims != 2 || (image.type() != CV_8UC1 && image.type() != CV_8UC3 && image.type() != CV_8UC4))
        CV_Error(Error::StsUnsupportedFormat, "the image must be CV_8UC1, CV_8UC3 or CV_8UC4");

    std::vector<Region> regions;
    regions.reserve(keypoints.size());
    Rect area;
    for (size_t i = 0; i < keypoints.size(); i++)
    {
        const KeyPoint& kp = keypoints[i];
        // written so that NaN fails
        if (!(std::abs(kp.pt.x) <= FLT_MAX && std::abs(kp.pt.y) <= FLT_MAX && kp.size > 0 &&
                    kp.size <= FLT_MAX))
            CV_Error(Error::StsBadArg,
                    format("keypoint %d is at (%g, %g) with size %g; these must be finite and the "
                           "size positive",
                            (int)i, kp.pt.x, kp.pt.y, kp.size));
        regions.push_back(Region(parameters, kp, image.size()));
        const Rect pixels = regions.back().pixels();
        if ((double)pixels.width * pixels.height > MAX_PIXELS)
            CV_Error(Error::StsOutOfRange,
                    format("keypoint %d has a region of %d x %d pixels; reduce the image", (int)i,
                            pixels.width, pixels.height));
        // not area | pixels, which takes a rectangle without pixels for none
        const Point first(std::min(area.x, pixels.x), std::min(area.y, pixels.y)),
                end(std::max(area.br().x, pixels.br().x), std::max(area.br().y, pixels.br().y));
        area = i ? Rect(first, end) : pixels;
    }

    const Mat integral = integralOf(image, area);
    descriptorArray.create((int)keypoints.size(), descriptorSize(), CV_8U);
    Mat descriptors = descriptorArray.getMat();
    parallel_for_(Range(0, (int)keypoints.size()), [&](const Range& range) {
        Describer describer(parameters, integral, area.tl());
        for (int i = range.start; i < range.end; i++)
            describer.describe(regions[i], descriptors.ptr(i));
    });
}

}  // namespace

Ptr<IIBDescriptorExtractor> IIBDescriptorExtractor::create(
        float scaleFactor, int granularity, int channels, int mapping, bool overlap)
{
    const Parameters parameters = {scaleFactor, granularity, channels, mapping, overlap};
    return makePtr<IIBDescriptorExtractor_Impl>(parameters);
}

}}  // namespace cv::iib

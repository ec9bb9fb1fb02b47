// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "rotated.hpp"

#include "channel_rows.hpp"
#include "bit_encoder.hpp"
#include "kernels/orientation.hpp"
#include "kernels/rotated_samples.hpp"

namespace cv {
namespace iib {

namespace {

const double LARGEST_SIDE = 16384;  // so that a point's offset fits 32 bits

//! A sine may add the two components of a gradient.
int maxTurnedGradient(int depth) { return 6 * maxPixel(depth); }

template <typename T> const RotatedSampleKernels<T>& sampleKernels();
template <> const RotatedSampleKernels<short>& sampleKernels<short>() { return shortRotatedSampleKernels(); }
template <> const RotatedSampleKernels<int>& sampleKernels<int>() { return intRotatedSampleKernels(); }

int samplesInRow(const SupportRegion& region, int granularity)
{
    return region.side <= 64 && granularity <= 5 ? 32 : 64;
}

//! The angle less its whole turns, exact: of a huge one, rounding to integers would depend on the machine.
float withinTurn(float angle) { return std::fmod(angle, 360.f); }

SampleGrid gridOf(const SupportRegion& region, const KeyPoint& kp, int granularity, Size image, Rect area)
{
    SampleGrid g;
    g.n = samplesInRow(region, granularity);
    g.image = image;
    g.area = area;
    const double radians = withinTurn(kp.angle) * CV_PI / 180,
                 spacing = std::min(region.side, LARGEST_SIDE) / g.n;
    g.stepX = cvRound(std::cos(radians) * spacing * 65536);
    g.stepY = cvRound(std::sin(radians) * spacing * 65536);
    const double far = 1 << 29;  // beyond any image
    const int64 x = (int64)std::floor(std::min(std::max((double)kp.pt.x, -far), far) * 131072 + 65536.5);
    const int64 y = (int64)std::floor(std::min(std::max((double)kp.pt.y, -far), far) * 131072 + 65536.5);
    g.x = (int)(x >> 17);
    g.y = (int)(y >> 17);
    g.fracX = (int)(x & 131071);
    g.fracY = (int)(y & 131071);
    return g;
}

//! Four channels side by side in each pixel of an area, to be sampled anywhere.
template <typename T> class PixelPack
{
public:
    PixelPack(const std::vector<Channel>& channels, Rect area) : pixels((size_t)area.area() * GROUP_CHANNELS)
    {
        ChannelRows<T> rows(channels, area, 0);
        T* out = pixels.data();
        for (int y = area.y; y < area.y + area.height; y++)
        {
            rows.compute(y);
            for (int x = 0; x < area.width; x++)
                for (int i = 0; i < GROUP_CHANNELS; i++)
                    *out++ = rows.plane(i)[x];
        }
    }

    const T* data() const { return pixels.data(); }

private:
    std::vector<T> pixels;
};

//! All that the channels of one block are made of, and the samples of one keypoint.
template <typename T> class Sampler
{
public:
    Sampler(const std::vector<Channel>& channels_, Rect area)
        : channels(channels_), kernels(sampleKernels<T>()), index(MAX_SAMPLES)
    {
        // The image's pack holds what its channels are made of; extra maps follow, four to a pack.
        std::vector<Channel> source;
        for (const Channel& c : channels)
            if (c.kind != 0 && source.empty())
            {
                const int kinds[] = {IIB::CHANNEL_SIGNED_GRAD_X, IIB::CHANNEL_SIGNED_GRAD_Y,
                        IIB::CHANNEL_ORIENTATION, IIB::CHANNEL_INTENSITY};
                for (int kind : kinds)
                    source.push_back(Channel{kind, c.map});
            }
        hasImage = !source.empty();
        for (const Channel& c : channels)
            if (c.kind == 0)
                source.push_back(c);
        for (size_t i = 0; i < source.size(); i += GROUP_CHANNELS)
            packs.push_back(
                    PixelPack<T>(std::vector<Channel>(source.begin() + i,
                                         source.begin() + std::min(i + GROUP_CHANNELS, source.size())),
                            area));
        planes.resize(packs.size() * GROUP_CHANNELS);
        for (std::vector<T>& plane : planes)
            plane.resize(MAX_SAMPLES + ROW_PADDING);
        derived.assign(GROUP_CHANNELS, std::vector<T>(MAX_SAMPLES + ROW_PADDING));
    }

    void sample(const SampleGrid& grid, int sub, float angle)
    {
        const int count = grid.n * grid.n;
        kernels.indices(grid, sub, index.data());
        for (size_t i = 0; i < packs.size(); i++)
        {
            T* out[GROUP_CHANNELS];
            for (int c = 0; c < GROUP_CHANNELS; c++)
                out[c] = planes[i * GROUP_CHANNELS + c].data();
            kernels.gather(packs[i].data(), index.data(), count, out);
        }
        if (hasImage)
        {
            angle = withinTurn(angle);
            const double radians = angle * CV_PI / 180;
            kernels.turn(planes[0].data(), planes[1].data(), planes[2].data(), count,
                    cvRound(angle * ORIENTATION_STEPS / 360));
            kernels.rotate(planes[0].data(), planes[1].data(), count, cvRound(std::cos(radians) * 4096),
                    cvRound(std::sin(radians) * 4096));
        }
    }

    //! The sums over cells of the group of channels that begins at `first`.
    void sum(const RowKernels<T>& rowKernels, const SampleGrid& grid, int sub, size_t first,
            CellGrid<unsigned>& cells)
    {
        const T* out[GROUP_CHANNELS];
        for (size_t i = 0; i < GROUP_CHANNELS; i++)
            out[i] = values(
                    rowKernels, std::min(first + i, channels.size() - 1), grid.n * grid.n, derived[i].data());
        kernels.sum(out, grid.n, sub, cells);
    }

private:
    enum
    {
        MAX_SAMPLES = 64 * 64
    };

    //! The samples of a channel; `buffer` if they are not at hand already.
    const T* values(const RowKernels<T>& rowKernels, size_t channel, int count, T* buffer) const
    {
        const Channel& c = channels[channel];
        const T *gx = planes[0].data(), *gy = planes[1].data();
        const T offset = (T)maxTurnedGradient(c.map.depth());
        switch (c.kind)
        {
        case IIB::CHANNEL_GRAD_X: rowKernels.absolute(gx, buffer, count); return buffer;
        case IIB::CHANNEL_GRAD_Y: rowKernels.absolute(gy, buffer, count); return buffer;
        case IIB::CHANNEL_ORIENTATION: return planes[2].data();
        case IIB::CHANNEL_INTENSITY: return planes[3].data();
        case IIB::CHANNEL_SIGNED_GRAD_X: rowKernels.add(gx, offset, buffer, count); return buffer;
        case IIB::CHANNEL_SIGNED_GRAD_Y: rowKernels.add(gy, offset, buffer, count); return buffer;
        default: break;
        }
        size_t extra = hasImage ? GROUP_CHANNELS : 0;
        for (size_t i = 0; i < channel; i++)
            extra += channels[i].kind == 0;
        return planes[extra].data();
    }

    const std::vector<Channel>& channels;
    const RotatedSampleKernels<T>& kernels;
    bool hasImage;
    std::vector<PixelPack<T>> packs;
    std::vector<std::vector<T>> planes, derived;
    std::vector<int> index;
};

template <typename T>
void describeBlock(const Parameters& p, const std::vector<Channel>& channels, const Block& block,
        const std::vector<SupportRegion>& region, const std::vector<KeyPoint>& keypoints,
        const RowKernels<T>& rowKernels, Mat& descriptors)
{
    Sampler<T> sampler(channels, block.area);
    const auto parentSums = getBitsKernels(p.mapping, unsigned()).parentSums;
    CellGrid<unsigned> cells[2];
    const Size image = channels[0].map.size();

    for (size_t first = 0; first < channels.size(); first += GROUP_CHANNELS)
    {
        const std::vector<Channel> group(channels.begin() + first,
                channels.begin() + std::min(first + GROUP_CHANNELS, channels.size()));
        int gradient = 0;
        for (const Channel& c : group)
            if (usesGradient(c))
                gradient = maxTurnedGradient(c.map.depth());
        BitEncoder bits(p, (int)first / GROUP_CHANNELS, (int)group.size());
        for (int k : block.keypoints)
        {
            const SampleGrid grid = gridOf(region[k], keypoints[k], p.granularity, image, block.area);
            // Two by two samples a cell, whose sum fits 16 bits, unless the cells are fewer.
            const int sub = bits.size() == grid.n ? 1 : 2;
            sampler.sample(grid, sub, keypoints[k].angle);
            CellGrid<unsigned>* finest =
                    grid.n / sub == bits.size() ? &bits.finestCells<unsigned>() : &cells[0];
            sampler.sum(rowKernels, grid, sub, first, *finest);
            while (finest->size() > bits.size())
            {
                CellGrid<unsigned>* parent = finest->size() == 2 * bits.size() ? &bits.finestCells<unsigned>()
                                                                               : &cells[finest == &cells[0]];
                parentSums(*finest, *parent);
                finest = parent;
            }
            const int cell = grid.n / bits.size();
            for (int i = 0; i < paddedEdges(bits.size()); i++)
                bits.xEdges()[i] = std::min(i, bits.size()) * cell;
            std::copy_n(bits.xEdges(), bits.size() + 1, bits.yEdges());
            bits.write<unsigned>(cell, maxValue(group, gradient), descriptors.ptr(k));
        }
    }
}

}  // namespace

Rect turnedPixels(const SupportRegion& region, const KeyPoint& kp, Size image)
{
    // Half the diagonal, and a pixel for each rounding.
    const double reach = std::min(region.side, LARGEST_SIDE) * 0.7072 + 2;
    return SupportRegion(kp.pt, 2 * reach).pixels(image);
}

void describeTurned(const Parameters& p, const std::vector<Channel>& channels, const Block& block,
        const std::vector<SupportRegion>& region, const std::vector<KeyPoint>& keypoints, Mat& descriptors)
{
    if (isDeep(channels))
        describeBlock<int>(p, channels, block, region, keypoints, intRowKernels(), descriptors);
    else
        describeBlock<short>(p, channels, block, region, keypoints, shortRowKernels(), descriptors);
}

}  // namespace iib
}  // namespace cv

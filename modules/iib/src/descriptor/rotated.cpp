// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "rotated.hpp"

#include <numeric>

#include "gradient_orientation.hpp"
#include "kernels/orientation.hpp"
#include "pixel_band.hpp"
#include "rotation.hpp"

namespace cv {
namespace iib {

namespace {

const double LARGEST_SIDE = 16384;  // so that a point's offset fits 32 bits

//! Both components of a gradient are 4 times the largest pixel at most; rotated, one is sqrt(2) times that at most.
int maxRotatedGradient(int depth) { return 6 * maxPixel(depth); }

int samplesInRow(const SupportRegion& region, int granularity)
{
    return region.side <= 64 && granularity <= 5 ? 32 : 64;
}

//! An upright square that holds the region at any angle, and two pixels for roundings.
SupportRegion circumscribed(const SupportRegion& region, Point2f centre)
{
    return SupportRegion(centre, 2 * (std::min(region.side, LARGEST_SIDE) * 0.7072 + 2));
}

SampleGrid gridOf(const SupportRegion& region, Point2f centre, const Rotation& rotation, int n, int sub,
        int border, Size image)
{
    SampleGrid g;
    g.n = n;
    g.sub = sub;
    g.image = image;
    g.reflect = circumscribed(region, centre).bounds(image, border).size() != image;
    const double spacing = std::min(region.side, LARGEST_SIDE) / g.n;
    g.stepX = cvRound(rotation.cosine * spacing * 65536);
    g.stepY = cvRound(rotation.sine * spacing * 65536);
    const double far = 1 << 29;  // beyond any image
    const int64 x = (int64)std::floor(std::min(std::max((double)centre.x, -far), far) * 131072 + 65536.5);
    const int64 y = (int64)std::floor(std::min(std::max((double)centre.y, -far), far) * 131072 + 65536.5);
    g.x = (int)(x >> 17);
    g.y = (int)(y >> 17);
    g.fracX = (int)(x & 131071);
    g.fracY = (int)(y & 131071);
    return g;
}

//! Edges of n x n cells of the same size.
CellEdges equalEdges(int n, int cell)
{
    CellEdges edges;
    for (int i = 0; i < paddedEdges(n); i++)
        edges.x[i] = std::min(i, n) * cell;
    std::copy_n(edges.x, n + 1, edges.y);
    return edges;
}

/** What the channels of a descriptor are sampled from, GROUP_CHANNELS values to a pixel: what the image's channels are
 made of comes first, extra maps follow. */
struct SampledChannels
{
    bool hasImage;
    std::vector<std::vector<Channel>> packs;
    std::vector<int> planeOf;  //!< of each channel, in the planes of sums

    explicit SampledChannels(const std::vector<Channel>& channels) : hasImage(false)
    {
        std::vector<Channel> maps;
        for (const Channel& c : channels)
        {
            int plane = 0;
            while (c.kind >> plane > 1)
                plane++;
            planeOf.push_back(c.kind == 0 ? -1 - (int)maps.size() : plane);
            if (c.kind == 0)
                maps.push_back(c);
            else if (!hasImage)
            {
                hasImage = true;
                const int kinds[] = {IIB::CHANNEL_SIGNED_GRAD_X, IIB::CHANNEL_SIGNED_GRAD_Y,
                        IIB::CHANNEL_ORIENTATION, IIB::CHANNEL_INTENSITY};
                packs.push_back(std::vector<Channel>());
                for (int kind : kinds)
                    packs[0].push_back(Channel{kind, c.map});
            }
        }
        for (int& plane : planeOf)
            if (plane < 0)
                plane = imagePlanes() - 1 - plane;
        for (size_t i = 0; i < maps.size(); i += GROUP_CHANNELS)
            packs.push_back(std::vector<Channel>(
                    maps.begin() + i, maps.begin() + std::min(i + GROUP_CHANNELS, maps.size())));
    }

    int imagePlanes() const { return hasImage ? (int)IMAGE_PLANES : 0; }
    int planes() const { return imagePlanes() + GROUP_CHANNELS * ((int)packs.size() - hasImage); }
};

//! One channel's values at a sample: pixels beyond the image repeat its border.
template <typename Pixel> struct Neighbourhood
{
    const Mat& map;
    int x0, x1, x2, y;

    Neighbourhood(const Mat& map_, int x, int y_)
        : map(map_), x0(std::max(x - 1, 0)), x1(x), x2(std::min(x + 1, map_.cols - 1)), y(y_)
    {
    }

    int centre() const { return map.ptr<Pixel>(y)[x1]; }

    //! Sobel 3x3.
    void gradient(int& gx, int& gy) const
    {
        const Pixel *a = map.ptr<Pixel>(std::max(y - 1, 0)), *m = map.ptr<Pixel>(y),
                    *b = map.ptr<Pixel>(std::min(y + 1, map.rows - 1));
        gx = (a[x2] - a[x0]) + 2 * (m[x2] - m[x0]) + (b[x2] - b[x0]);
        gy = (b[x0] - a[x0]) + 2 * (b[x1] - a[x1]) + (b[x2] - a[x2]);
    }
};

/** The samples of one keypoint read from the maps themselves, as pixels in the order of the places. For grids that touch
 few pixels of the area that they span. */
template <typename T> class SparsePixels
{
public:
    SparsePixels(const RowKernels<T>& kernels_, ScratchMemory& memory)
        : kernels(kernels_), values(memory.get<T>((size_t)(MAX_SAMPLES + ROW_PADDING) * 2 * GROUP_CHANNELS))
    {
    }

    //! @param x, y places in the maps, `count` of them. @return as many pixels of GROUP_CHANNELS values.
    const T* read(const std::vector<Channel>& pack, const int* x, const int* y, int count)
    {
        for (int i = 0; i < (int)pack.size(); i++)
            if (pack[i].kind != IIB::CHANNEL_SIGNED_GRAD_Y && pack[i].kind != IIB::CHANNEL_ORIENTATION)
            {
                if (pack[i].map.depth() == CV_8U)
                    readPlane<uchar>(pack[i], x, y, count, i);
                else
                    readPlane<ushort>(pack[i], x, y, count, i);
            }
        if (pack[0].kind != 0)
            kernels.orientation(plane(0), plane(1), plane(2), count);
        const T* planes[GROUP_CHANNELS];
        for (int i = 0; i < GROUP_CHANNELS; i++)
            planes[i] = plane(std::min(i, (int)pack.size() - 1));
        kernels.interleave(planes, plane(GROUP_CHANNELS), count);
        return plane(GROUP_CHANNELS);
    }

private:
    T* plane(int i) { return values + (size_t)i * (MAX_SAMPLES + ROW_PADDING); }

    //! A channel; with the horizontal gradient comes the vertical one, as the next plane.
    template <typename Pixel>
    void readPlane(const Channel& c, const int* x, const int* y, int count, int index)
    {
        for (int s = 0; s < count; s++)
        {
            const Neighbourhood<Pixel> around(c.map, x[s], y[s]);
            if (usesGradient(c))
            {
                int gx, gy;
                around.gradient(gx, gy);
                plane(index)[s] = (T)gx;
                plane(index + 1)[s] = (T)gy;
            }
            else
                plane(index)[s] = (T)around.centre();
        }
    }

    const RowKernels<T>& kernels;
    T* const values;
};

//! The sums over cells of one keypoint after another.
template <typename T> class Sampler
{
public:
    Sampler(const DescriptorPlan& plan_, const std::vector<Channel>& channels_, Workspace& workspace_)
        : plan(plan_), channels(channels_), sampled(channels_), workspace(workspace_),
          kernels(plan_.kernels.pixels<T>().rotated),
          sums(workspace_.planes.get<int>((size_t)sampled.planes() * MAX_SAMPLES))
    {
    }

    const std::vector<std::vector<Channel>>& packs() const { return sampled.packs; }

    //! All planes of sums. @param pixelsOf a function from the number of a pack to its pixels.
    template <typename Pixels>
    void sum(const SampleGrid& grid, const int* index, const Rotation& rotation, const Pixels& pixelsOf)
    {
        const GradientRotation gradients = {
                cvRound(rotation.cosine * 4096), cvRound(rotation.sine * 4096), rotation.steps};
        int* planes[IMAGE_PLANES];
        int next = 0;
        for (size_t i = 0; i < packs().size(); i++)
        {
            const bool image = sampled.hasImage && i == 0;
            const int count = image ? (int)IMAGE_PLANES : (int)GROUP_CHANNELS;
            for (int p = 0; p < count; p++)
                planes[p] = plane(next++);
            if (image)
                kernels.imageSums(pixelsOf(i), index, grid.cells(), grid.sub * grid.sub, gradients, planes);
            else
                kernels.mapSums(pixelsOf(i), index, grid.cells(), grid.sub * grid.sub, planes);
        }
    }

    //! The bits of all groups of channels.
    void write(const SampleGrid& grid, uchar* descriptor)
    {
        const int n = plan.cellsInRow(), cell = grid.n / n;
        const CellEdges edges = equalEdges(n, cell);
        const auto parentSums = plan.kernels.sums<unsigned>().bits[plan.parameters.mapping].parentSums;
        for (const ChannelGroup& group : plan.groups)
        {
            CellGrid<unsigned>* cells[2] = {&workspace.cells, &workspace.parentCells};
            const int largest = interleave(group, grid, *cells[0]);
            for (; cells[0]->size() > n; std::swap(cells[0], cells[1]))
                parentSums(*cells[0], *cells[1]);
            BitEncoder(plan, group, largest, workspace.encoder).write(*cells[0], edges, cell, descriptor);
        }
    }

private:
    int* plane(int i) { return sums + (size_t)i * MAX_SAMPLES; }

    //! @return the largest value of the group's channels.
    int interleave(const ChannelGroup& group, const SampleGrid& grid, CellGrid<unsigned>& cells)
    {
        const int* planes[GROUP_CHANNELS];
        int addends[GROUP_CHANNELS], gradient = 0;
        for (int i = 0; i < GROUP_CHANNELS; i++)
        {
            const int c = group.first + std::min(i, group.count - 1);
            planes[i] = plane(sampled.planeOf[c]);
            const int kind = channels[c].kind;
            const bool isSigned = kind == IIB::CHANNEL_SIGNED_GRAD_X || kind == IIB::CHANNEL_SIGNED_GRAD_Y;
            const int largest = maxRotatedGradient(channels[c].map.depth());
            addends[i] = isSigned ? largest * grid.sub * grid.sub : 0;
            if (usesGradient(channels[c]))
                gradient = largest;
        }
        kernels.interleave(planes, addends, grid.cells(), cells);
        return maxValue(&channels[group.first], group.count, gradient);
    }

    const DescriptorPlan& plan;
    const std::vector<Channel>& channels;
    const SampledChannels sampled;
    Workspace& workspace;
    const RotatedSampleKernels<T>& kernels;
    int* const sums;
};

/* A row of pixels costs about a sixteenth of what as many samples cost that are read one by one. The limit keeps memory
 and indices small: a few large regions may span billions of pixels. */
bool isSparse(const KeyPointBatch& batch, double pixelsKept)
{
    const double samples = (double)batch.keypoints.size() * MAX_SAMPLES;
    return (double)batch.area.width * batch.area.height > 16 * samples || pixelsKept > 1 << 24;
}

//! The pixels of a batch at the points of one grid after another.
template <typename T> class GridPixels
{
public:
    GridPixels(const DescriptorKernels& all, const std::vector<std::vector<Channel>>& packs_,
            const KeyPointBatch& batch_, int border_, Workspace& workspace)
        : kernels(all.pixels<T>()), packs(packs_), batch(batch_), border(border_),
          image(packs_[0][0].map.size()), sparsePixels(kernels.rows, workspace.sparsePixels)
    {
        const int rows = batch.rows + KeyPointBatch::BAND_ROWS;
        sparse = isSparse(batch, PixelBand<T>::pixelsKept(batch.area, rows));
        if (sparse)
            std::iota(index, index + MAX_SAMPLES, 0);
        for (size_t i = 0; !sparse && i < packs.size(); i++)
            bands.push_back(PixelBand<T>(packs[i], batch.area, rows, kernels.rows, workspace.sourceRows[i],
                    workspace.sourcePixels[i]));
    }

    //! Has the pixels of a region at hand; regions come in the order of the batch.
    void moveTo(const SupportRegion& region, Point2f centre)
    {
        const int end = batch.bandEnd(rotatedPixels(region, centre, border, image).br().y);
        for (PixelBand<T>& band : bands)
            band.advance(end);
    }

    //! @return where the points are in the arrays of pixels().
    const int* locate(const SampleGrid& grid)
    {
        if (sparse)
            kernels.rotated.places(grid, x, y);
        else
            kernels.rotated.indices(grid, bands[0].origin(), bands[0].step(), index);
        return index;
    }

    const T* pixels(size_t pack, const SampleGrid& grid)
    {
        return sparse ? sparsePixels.read(packs[pack], x, y, grid.n * grid.n) : bands[pack].data();
    }

    //! By the gradients around a keypoint that moveTo() was given.
    float angleOf(const SupportRegion& region, Point2f centre, int rank)
    {
        const SampleGrid grid = gridOf(region, centre, Rotation(0), ORIENTATION_SAMPLES, 1, border, image);
        locate(grid);
        return prevailingAngle(kernels.rotated, pixels(0, grid), index, rank);
    }

private:
    const PixelKernels<T>& kernels;
    const std::vector<std::vector<Channel>>& packs;
    const KeyPointBatch& batch;
    const int border;
    const Size image;
    bool sparse;
    SparsePixels<T> sparsePixels;
    std::vector<PixelBand<T>> bands;
    int index[MAX_SAMPLES], x[MAX_SAMPLES], y[MAX_SAMPLES];
};

template <typename T>
void describeBatch(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions,
        const std::vector<KeyPoint>& keypoints, const std::vector<int>& ranks, Workspace& workspace,
        Mat& descriptors)
{
    const Parameters& p = plan.parameters;
    Sampler<T> sampler(plan, channels, workspace);
    GridPixels<T> pixels(plan.kernels, sampler.packs(), batch, p.border, workspace);
    for (int k : batch.keypoints)
    {
        const Point2f centre = keypoints[k].pt;
        pixels.moveTo(regions[k], centre);
        const bool own = p.orientation == IIB::ORIENTATION_GRADIENT;
        const Rotation rotation(own ? pixels.angleOf(regions[k], centre, ranks[k]) : keypoints[k].angle);
        const int n = samplesInRow(regions[k], p.granularity);
        // Two by two samples a cell, unless the cells are fewer.
        const int sub = plan.cellsInRow() == n ? 1 : 2;
        const SampleGrid grid =
                gridOf(regions[k], centre, rotation, n, sub, p.border, channels[0].map.size());
        const int* const index = pixels.locate(grid);
        sampler.sum(grid, index, rotation, [&](size_t pack) { return pixels.pixels(pack, grid); });
        sampler.write(grid, descriptors.ptr(k));
    }
}

template <typename T>
void findAngles(const DescriptorPlan& plan, const Mat& image, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints,
        const std::vector<int>& ranks, Workspace& workspace, std::vector<float>& angles)
{
    const SampledChannels sampled({Channel{IIB::CHANNEL_INTENSITY, image}});
    GridPixels<T> pixels(plan.kernels, sampled.packs, batch, plan.parameters.border, workspace);
    for (int k : batch.keypoints)
    {
        pixels.moveTo(regions[k], keypoints[k].pt);
        angles[k] = pixels.angleOf(regions[k], keypoints[k].pt, ranks[k]);
    }
}

}  // namespace

Rect rotatedPixels(const SupportRegion& region, Point2f centre, int border, Size image)
{
    const SupportRegion square = circumscribed(region, centre);
    const Rect r = square.pixels(square.bounds(image, border));
    const Range x = reflectedRange(r.x, r.x + r.width, image.width),
                y = reflectedRange(r.y, r.y + r.height, image.height);
    return Rect(x.start, y.start, x.size(), y.size());
}

bool rotatedIsInside(const SupportRegion& region, Point2f centre, float angle, Size image)
{
    const Rotation rotation(angle);
    const double half = std::min(region.side, LARGEST_SIDE) / 2;
    const double reach = half * (std::abs(rotation.cosine) + std::abs(rotation.sine));
    const double x = centre.x + 0.5, y = centre.y + 0.5;
    return x - reach >= 0 && x + reach <= image.width && y - reach >= 0 && y + reach <= image.height;
}

void describeRotated(const DescriptorPlan& plan, const std::vector<Channel>& channels,
        const KeyPointBatch& batch, const std::vector<SupportRegion>& regions,
        const std::vector<KeyPoint>& keypoints, const std::vector<int>& ranks, Workspace& workspace,
        Mat& descriptors)
{
    if (is16Bit(channels))
        describeBatch<int>(plan, channels, batch, regions, keypoints, ranks, workspace, descriptors);
    else
        describeBatch<short>(plan, channels, batch, regions, keypoints, ranks, workspace, descriptors);
}

void prevailingAngles(const DescriptorPlan& plan, const Mat& image, const KeyPointBatch& batch,
        const std::vector<SupportRegion>& regions, const std::vector<KeyPoint>& keypoints,
        const std::vector<int>& ranks, Workspace& workspace, std::vector<float>& angles)
{
    if (image.depth() == CV_16U)
        findAngles<int>(plan, image, batch, regions, keypoints, ranks, workspace, angles);
    else
        findAngles<short>(plan, image, batch, regions, keypoints, ranks, workspace, angles);
}

}  // namespace iib
}  // namespace cv

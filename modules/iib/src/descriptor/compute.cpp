// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/image_input.hpp"
#include "batch_job.hpp"

namespace cv { namespace iib {

namespace {

typedef std::vector<int> Indices;

int floorHalf(int v) { return v >= 0 ? v / 2 : -((1 - v) / 2); }

//! The whole squares that hold some pixels.
Rect squaresOf(Rect pixels)
{
    const Point first(floorHalf(pixels.x), floorHalf(pixels.y));
    return Rect(
            first, Point(floorHalf(pixels.x + pixels.width + 1), floorHalf(pixels.y + pixels.height + 1)));
}

}  // namespace

Rect boxBounds(int border, Size image)
{
    // BORDER_CLAMP ignores the squares that the edge of an image of odd size cuts, unless there are no others
    if (border == IIB::BORDER_CLAMP)
        return Rect(0, 0, std::max(image.width / BOX_SQUARE, 1), std::max(image.height / BOX_SQUARE, 1));
    return squaresOf(border == IIB::BORDER_REFLECT ? reflectedImage(image) : Rect(Point(), image));
}

namespace {

//! Whether angles come from the image. With extra channels alone, regions stay upright.
bool findsAngles(const Parameters& p)
{
    return p.orientation == IIB::ORIENTATION_GRADIENT && p.channels != 0;
}

//! The pixels of a region's boxes, upright or rotated by any angle, in whole squares; some may be reflected.
Rect boxPixels(const SupportRegion& region, int border, Size image)
{
    const auto inPixels = [](Rect r) { return Rect(r.tl() * (int)BOX_SQUARE, r.size() * (int)BOX_SQUARE); };
    // corners of rotated boxes are at most (28 sqrt(2) + 12) / 40 from the centre; 4 pixels on either side for roundings
    const SupportRegion extent(region.centre, region.side * (region.isRotated() ? 1.3 : 1) + 8);
    return inPixels(squaresOf(extent.pixels(inPixels(boxBounds(border, image)))));
}

//! The pixels that a region's descriptor reads.
Rect pixelsOf(const DescriptorPlan& plan, const SupportRegion& region, Size image)
{
    const int border = plan.parameters.border;
    if (plan.isOfBoxes())
        return boxPixels(region, border, image);
    return region.isRotated() ? rotatedPixels(region, border, image)
                              : region.pixels(region.bounds(image, border));
}

//! Cuts keypoints into jobs: near each other, and all upright or all rotated. @param pixels that each keypoint reads.
std::vector<Indices> cutJobs(const std::vector<SupportRegion>& regions, const std::vector<Rect>& pixels)
{
    Indices members[2];  // upright, rotated
    for (int k = 0; k < (int)regions.size(); k++)
        members[regions[k].isRotated()].push_back(k);
    std::vector<Indices> jobs = cutBatches(pixels, members[0], getNumThreads());
    const std::vector<Indices> rotated = cutBatches(pixels, members[1], getNumThreads());
    jobs.insert(jobs.end(), rotated.begin(), rotated.end());
    return jobs;
}

}  // namespace

bool isInside(const DescriptorPlan& plan, const KeyPoint& keypoint, Size image)
{
    const SupportRegion region = regionOf(keypoint, plan.parameters);
    const bool unknown = findsAngles(plan.parameters);
    if (!unknown && !region.isRotated())
        return region.isInside(image);
    // an unknown angle counts as 45 degrees, where the square reaches farthest
    const Rotation rotation(unknown ? 45 : region.angle);
    const double half = std::min(region.side, LARGEST_ROTATED_SIDE) / 2;
    const double reach = half * (std::abs(rotation.cosine) + std::abs(rotation.sine));
    const double x = region.centre.x + 0.5, y = region.centre.y + 0.5;
    return x - reach >= 0 && x + reach <= image.width && y - reach >= 0 && y + reach <= image.height;
}

void describe(const DescriptorPlan& plan, const Mat& image, const std::vector<Mat>& extra,
        const std::vector<KeyPoint>& keypoints, Mat& descriptors)
{
    const Parameters& p = plan.parameters;
    const Mat grey = integerMap(image);
    std::vector<SupportRegion> regions;
    regions.reserve(keypoints.size());
    for (const KeyPoint& kp : keypoints)
        regions.push_back(regionOf(kp, p));
    if (findsAngles(p))
        findAngles(plan, grey, keypoints, regions);
    std::vector<Rect> pixels;
    pixels.reserve(keypoints.size());
    for (const SupportRegion& region : regions)
        pixels.push_back(pixelsOf(plan, region, image.size()));

    const std::vector<Channel> channels = channelsInUse(p, grey, extra);
    const std::vector<Indices> jobs = cutJobs(regions, pixels);
    parallelJobs((int)jobs.size(), [&](int i, Workspace& workspace) {
        const KeyPointBatch batch = makeBatch(pixels, jobs[i]);
        const BatchJob job = {plan, grey, channels, regions, pixels, batch, workspace, descriptors};
        if (plan.isOfBoxes())
            describeBoxes(job);
        else if (regions[jobs[i][0]].isRotated())
            describeRotated(job);
        else
            describeUpright(job);
    });
}

}}  // namespace cv::iib

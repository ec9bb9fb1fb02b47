// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "matcher_impl.hpp"
#include "input.hpp"
#include "pruning.hpp"
#include "results.hpp"

namespace cv {
namespace iib {

static void checkK(int k)
{
    if (k <= 0)
        CV_Error_(Error::StsOutOfRange, ("k is %d: it has to be > 0", k));
}

static void checkRadius(float maxDistance)
{
    if (!(maxDistance > std::numeric_limits<float>::epsilon()))
        CV_Error_(Error::StsOutOfRange, ("maxDistance is %g: it has to be > 0", maxDistance));
}

// The masks of a call with two sets: one or none.
static std::vector<Mat> singleMask(InputArray mask)
{
    return std::vector<Mat>(mask.empty() ? 0 : 1, mask.getMat());
}

Ptr<const PackedCodes> HierarchicalMatcherImpl::trainCodes(const Mat& queries) const
{
    if (index)
        return index;
    Ptr<PackedCodes> none = makePtr<PackedCodes>(levelSizesFor(parameters, std::max(queries.cols, 1)));
    for (size_t i = 0; i < trainDescCollection.size(); i++)
        none->add(Mat());
    return none;
}

Ptr<const PackedCodes> HierarchicalMatcherImpl::packed(InputArray trains, const Mat& queries) const
{
    std::vector<Mat> images = imagesOf(trains);
    const int width = widthOf(images);
    const Ptr<PackedCodes> codes =
            makePtr<PackedCodes>(levelSizesFor(parameters, width > 0 ? width : std::max(queries.cols, 1)));
    for (size_t i = 0; i < images.size(); i++)
        codes->add(checkedDescriptors(images[i], codes->layout().bytes(), parameters.levelSizes.empty()));
    return codes;
}

PruningPolicy HierarchicalMatcherImpl::policy(const CodeLayout& layout) const
{
    switch (parameters.mode)
    {
    case THRESHOLD: return thresholdPolicy(layout, parameters.thresholds);
    case ADAPTIVE: return adaptivePolicy(layout);
    default: return PruningPolicy();
    }
}

void HierarchicalMatcherImpl::count(const SearchCost& cost) const
{
    counters->compared += cost.compared;
    counters->all += cost.all;
}

KnnTable HierarchicalMatcherImpl::nearest(
        const PackedCodes& trains, const Mat& queries_, int k, InputArrayOfArrays masks_) const
{
    checkK(k);
    const Mat queries = checkedDescriptors(queries_, trains.layout().bytes(), parameters.levelSizes.empty());
    const PruningPolicy pruning = policy(trains.layout());
    const std::vector<Mat> masks = checkedMasks(masks_, queries.rows, trains);
    const SearchInput input(trains, queries, pruning, masks, *this);
    SearchCost cost;
    KnnTable found = findNearest(input, k, parameters.crossCheck, parameters.maxRatio, cost);
    count(cost);
    return found;
}

void HierarchicalMatcherImpl::withinRadius(const PackedCodes& trains, const Mat& queries_, float maxDistance,
        InputArrayOfArrays masks_, bool compactResult, std::vector<std::vector<DMatch>>& matches) const
{
    checkRadius(maxDistance);
    const CodeLayout& layout = trains.layout();
    const Mat queries = checkedDescriptors(queries_, layout.bytes(), parameters.levelSizes.empty());
    const int radius = cvFloor(std::min((double)maxDistance, 8. * layout.bytes()));
    const PruningPolicy pruning =
            parameters.mode == THRESHOLD ? policy(layout) : radiusPolicy(layout, radius);
    const std::vector<Mat> masks = checkedMasks(masks_, queries.rows, trains);
    const SearchInput input(trains, queries, pruning, masks, *this);
    SearchCost cost;
    toMatches(trains, findWithin(input, radius, cost), compactResult, matches);
    count(cost);
}

void HierarchicalMatcherImpl::match(
        InputArray queries_, InputArray trains_, std::vector<DMatch>& matches, InputArray mask) const
{
    const Mat queries = queries_.getMat();
    const Ptr<const PackedCodes> trains = packed(trains_, queries);
    toBestMatches(*trains, nearest(*trains, queries, 1, singleMask(mask)), matches);
}

void HierarchicalMatcherImpl::match(
        InputArray queries_, std::vector<DMatch>& matches, InputArrayOfArrays masks)
{
    const Mat queries = queries_.getMat();
    const Ptr<const PackedCodes> trains = trainCodes(queries);
    toBestMatches(*trains, nearest(*trains, queries, 1, masks), matches);
}

void HierarchicalMatcherImpl::knnMatch(InputArray queries_, InputArray trains_,
        std::vector<std::vector<DMatch>>& matches, int k, InputArray mask, bool compactResult) const
{
    const Mat queries = queries_.getMat();
    const Ptr<const PackedCodes> trains = packed(trains_, queries);
    toMatches(*trains, nearest(*trains, queries, k, singleMask(mask)), compactResult, matches);
}

void HierarchicalMatcherImpl::knnMatch(InputArray queries_, std::vector<std::vector<DMatch>>& matches, int k,
        InputArrayOfArrays masks, bool compactResult)
{
    const Mat queries = queries_.getMat();
    const Ptr<const PackedCodes> trains = trainCodes(queries);
    toMatches(*trains, nearest(*trains, queries, k, masks), compactResult, matches);
}

void HierarchicalMatcherImpl::radiusMatch(InputArray queries_, InputArray trains_,
        std::vector<std::vector<DMatch>>& matches, float maxDistance, InputArray mask,
        bool compactResult) const
{
    const Mat queries = queries_.getMat();
    withinRadius(*packed(trains_, queries), queries, maxDistance, singleMask(mask), compactResult, matches);
}

void HierarchicalMatcherImpl::radiusMatch(InputArray queries_, std::vector<std::vector<DMatch>>& matches,
        float maxDistance, InputArrayOfArrays masks, bool compactResult)
{
    const Mat queries = queries_.getMat();
    withinRadius(*trainCodes(queries), queries, maxDistance, masks, compactResult, matches);
}

void HierarchicalMatcherImpl::knnMatchArrays(InputArray queries_, OutputArray indices, OutputArray distances,
        int k, InputArrayOfArrays masks, OutputArray imageIndices) const
{
    const Mat queries = queries_.getMat();
    const Ptr<const PackedCodes> trains = trainCodes(queries);
    toArrays(*trains, nearest(*trains, queries, k, masks), k, indices, distances, imageIndices);
}

void HierarchicalMatcherImpl::knnMatchArrays(InputArray queries_, InputArray trains_, OutputArray indices,
        OutputArray distances, int k, InputArray mask) const
{
    const Mat queries = queries_.getMat();
    const Ptr<const PackedCodes> trains = packed(trains_, queries);
    toArrays(*trains, nearest(*trains, queries, k, singleMask(mask)), k, indices, distances, noArray());
}

void HierarchicalMatcherImpl::knnMatchImpl(InputArray queries, std::vector<std::vector<DMatch>>& matches,
        int k, InputArrayOfArrays masks, bool compactResult)
{
    knnMatch(queries, matches, k, masks, compactResult);
}

void HierarchicalMatcherImpl::radiusMatchImpl(InputArray queries, std::vector<std::vector<DMatch>>& matches,
        float maxDistance, InputArrayOfArrays masks, bool compactResult)
{
    radiusMatch(queries, matches, maxDistance, masks, compactResult);
}

}  // namespace iib
}  // namespace cv

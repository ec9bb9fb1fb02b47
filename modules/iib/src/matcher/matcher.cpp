// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "matcher_impl.hpp"
#include "input.hpp"

namespace cv {
namespace iib {

HierarchicalMatcherImpl::HierarchicalMatcherImpl(const MatcherParameters& p)
    : parameters(p), counters(makePtr<CostCounters>())
{
    if (!p.levelSizes.empty())
        index = makePtr<PackedCodes>(p.levelSizes);
}

std::vector<int> HierarchicalMatcherImpl::levelSizes() const
{
    return index ? index->layout().levelSizes() : parameters.levelSizes;
}

void HierarchicalMatcherImpl::set(const MatcherParameters& changed)
{
    check(changed);
    MatcherParameters copy = changed;
    std::swap(parameters, copy);  // which cannot fail half-way
}

void HierarchicalMatcherImpl::setMode(int mode)
{
    MatcherParameters changed = parameters;
    changed.mode = mode;
    set(changed);
}

void HierarchicalMatcherImpl::setThresholds(const std::vector<float>& thresholds)
{
    for (size_t i = 0; i < thresholds.size(); i++)
        checkThreshold(thresholds[i]);  // also where no level needs one
    MatcherParameters changed = parameters;
    changed.thresholds =
            thresholds.size() == 1 ? std::vector<float>(parameters.stages(), thresholds[0]) : thresholds;
    set(changed);
}

void HierarchicalMatcherImpl::setMaxRatio(float maxRatio)
{
    MatcherParameters changed = parameters;
    changed.maxRatio = maxRatio;
    set(changed);
}

double HierarchicalMatcherImpl::matchCost() const
{
    const uint64 all = counters->all;
    return all ? (double)counters->compared / (double)all : 0;
}

void HierarchicalMatcherImpl::resetCost()
{
    counters->compared = 0;
    counters->all = 0;
}

void HierarchicalMatcherImpl::makeIndex(int width)
{
    if (index)
        return;
    Ptr<PackedCodes> made = makePtr<PackedCodes>(levelSizesFor(parameters, width));
    for (size_t i = 0; i < trainDescCollection.size(); i++)  // images without rows came before
        made->add(Mat());
    index = made;
}

void HierarchicalMatcherImpl::add(InputArrayOfArrays descriptors)
{
    std::vector<Mat> images = imagesOf(descriptors);
    const int width = index ? index->layout().bytes() : widthOf(images);
    for (size_t i = 0; i < images.size(); i++)
        images[i] = checkedDescriptors(images[i], width, parameters.levelSizes.empty());
    if (width > 0)
        makeIndex(width);
    for (size_t i = 0; i < images.size(); i++)
    {
        trainDescCollection.push_back(Mat());  // DescriptorMatcher counts its entries
        try
        {
            if (index)
                index->add(images[i]);
        }
        catch (...)  // out of memory: list and index stay of one length
        {
            trainDescCollection.pop_back();
            throw;
        }
    }
}

void HierarchicalMatcherImpl::clear()
{
    HierarchicalMatcher::clear();
    index = parameters.levelSizes.empty() ? Ptr<PackedCodes>() : makePtr<PackedCodes>(parameters.levelSizes);
}

std::vector<Mat> HierarchicalMatcherImpl::getTrainDescriptors() const
{
    std::vector<Mat> images(trainDescCollection.size());
    for (size_t i = 0; index && i < images.size(); i++)
        images[i] = index->descriptors(i, 0, index->rows(i));
    return images;
}

Ptr<DescriptorMatcher> HierarchicalMatcherImpl::clone(bool emptyTrainData) const
{
    Ptr<HierarchicalMatcherImpl> result = makePtr<HierarchicalMatcherImpl>(parameters);
    static_cast<ScanBlocks&>(*result) = *this;
    if (emptyTrainData)
        result->counters = counters;
    else
    {
        if (index)
            result->index = makePtr<PackedCodes>(*index);
        result->trainDescCollection = trainDescCollection;
    }
    return result;
}

Ptr<HierarchicalMatcher> HierarchicalMatcher::copy(bool emptyTrainData) const
{
    return clone(emptyTrainData).dynamicCast<HierarchicalMatcher>();
}

Ptr<HierarchicalMatcher> HierarchicalMatcher::create(
        const std::vector<int>& levelSizes, int mode, float threshold, bool crossCheck)
{
    checkLevelSizesGiven(levelSizes);
    checkThreshold(threshold);
    MatcherParameters p;
    p.levelSizes = levelSizes;
    p.mode = mode;
    p.thresholds.assign(p.stages(), threshold);
    p.crossCheck = crossCheck;
    check(p);
    return makePtr<HierarchicalMatcherImpl>(p);
}

Ptr<HierarchicalMatcher> HierarchicalMatcher::create()
{
    return makePtr<HierarchicalMatcherImpl>(MatcherParameters());
}

Ptr<HierarchicalMatcher> HierarchicalMatcher::createRecommended()
{
    MatcherParameters p;
    p.crossCheck = true;
    p.maxRatio = 0.9f;
    return makePtr<HierarchicalMatcherImpl>(p);
}

}  // namespace iib
}  // namespace cv

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "packed_codes.hpp"
#include "index_file.hpp"
#include "input.hpp"
#include "parameters.hpp"

#include <atomic>

namespace cv {
namespace iib {

namespace {

// Shared by an object and its clones without train data, which the calls with two sets make.
struct Counters
{
    Counters() : compared(0), all(0) {}
    std::atomic<uint64> compared, all;
};

class HierarchicalMatcherImpl CV_FINAL : public HierarchicalMatcher
{
public:
    explicit HierarchicalMatcherImpl(const MatcherParameters& p)
        : parameters(p), index(makePtr<PackedCodes>(p.levelSizes)), counters(makePtr<Counters>())
    {
    }

    std::vector<int> levelSizes() const CV_OVERRIDE { return parameters.levelSizes; }

    void setMode(int mode) CV_OVERRIDE
    {
        MatcherParameters changed = parameters;
        changed.mode = mode;
        set(changed);
    }
    int getMode() const CV_OVERRIDE { return parameters.mode; }

    void setThresholds(const std::vector<float>& thresholds) CV_OVERRIDE
    {
        MatcherParameters changed = parameters;
        changed.thresholds = thresholds.size() == 1
                                     ? std::vector<float>(parameters.levelSizes.size() - 1, thresholds[0])
                                     : thresholds;
        set(changed);
    }
    std::vector<float> getThresholds() const CV_OVERRIDE { return parameters.thresholds; }

    void setCrossCheck(bool crossCheck) CV_OVERRIDE { parameters.crossCheck = crossCheck; }
    bool getCrossCheck() const CV_OVERRIDE { return parameters.crossCheck; }

    void setMaxRatio(float maxRatio) CV_OVERRIDE
    {
        MatcherParameters changed = parameters;
        changed.maxRatio = maxRatio;
        set(changed);
    }
    float getMaxRatio() const CV_OVERRIDE { return parameters.maxRatio; }

    double matchCost() const CV_OVERRIDE
    {
        const uint64 all = counters->all;
        return all ? (double)counters->compared / (double)all : 0;
    }
    void resetCost() CV_OVERRIDE
    {
        counters->compared = 0;
        counters->all = 0;
    }

    bool isMaskSupported() const CV_OVERRIDE { return true; }
    void add(InputArrayOfArrays descriptors) CV_OVERRIDE;
    void clear() CV_OVERRIDE
    {
        HierarchicalMatcher::clear();
        index = makePtr<PackedCodes>(parameters.levelSizes);
    }
    Ptr<DescriptorMatcher> clone(bool emptyTrainData) const CV_OVERRIDE;

    using DescriptorMatcher::read;
    using DescriptorMatcher::write;
    void read(const FileNode& node) CV_OVERRIDE;
    void write(FileStorage& fs) const CV_OVERRIDE;
    String getDefaultName() const CV_OVERRIDE { return "HierarchicalMatcher"; }

    void knnMatchArrays(InputArray queries, OutputArray indices, OutputArray distances, int k,
            InputArrayOfArrays masks, OutputArray imageIndices) const CV_OVERRIDE;
    void knnMatchArrays(InputArray queries, InputArray trains, OutputArray indices, OutputArray distances,
            int k, InputArray mask) const CV_OVERRIDE;
    void saveIndex(const String& filename) const CV_OVERRIDE;

    static Ptr<HierarchicalMatcher> load(const String& filename);

protected:
    void knnMatchImpl(InputArray queries, std::vector<std::vector<DMatch>>& matches, int k,
            InputArrayOfArrays masks, bool compactResult) CV_OVERRIDE;
    void radiusMatchImpl(InputArray queries, std::vector<std::vector<DMatch>>& matches, float maxDistance,
            InputArrayOfArrays masks, bool compactResult) CV_OVERRIDE;

private:
    void set(MatcherParameters changed)
    {
        check(changed);
        std::swap(parameters, changed);  // which cannot fail half-way
    }

    Mat checked(const Mat& descriptors) const
    {
        return checkedDescriptors(descriptors, index->layout().bytes());
    }
    PruningPolicy plan() const;
    KnnTable nearest(InputArray queries, int k, InputArrayOfArrays masks) const;
    void count(const SearchCost& cost) const
    {
        counters->compared += cost.compared;
        counters->all += cost.all;
    }
    DMatch match(int query, MatchKey n) const
    {
        const size_t image = index->imageOf(indexOf(n));
        return DMatch(query, (int)(indexOf(n) - index->start(image)), (int)image, (float)distanceOf(n));
    }

    MatcherParameters parameters;
    Ptr<PackedCodes> index;
    Ptr<Counters> counters;
};

PruningPolicy HierarchicalMatcherImpl::plan() const
{
    switch (parameters.mode)
    {
    case THRESHOLD: return thresholdPlan(index->layout(), parameters.thresholds);
    case ADAPTIVE: return adaptivePlan(index->layout());
    default: return exactPlan();
    }
}

KnnTable HierarchicalMatcherImpl::nearest(InputArray queries_, int k, InputArrayOfArrays masks) const
{
    const Mat queries = checked(queries_.getMat());
    SearchCost cost;
    KnnTable found = index->nearest(queries, plan(), k, parameters.crossCheck, parameters.maxRatio,
            checkedMasks(masks, queries.rows, *index), cost);
    count(cost);
    return found;
}

void HierarchicalMatcherImpl::add(InputArrayOfArrays descriptors)
{
    std::vector<Mat> images;
    if (descriptors.isMatVector() || descriptors.isUMatVector())
        descriptors.getMatVector(images);
    else
        images.push_back(descriptors.getMat());
    const bool mapped =
            descriptors.isUMat() || descriptors.isUMatVector();  // such views must not outlive the call
    for (size_t i = 0; i < images.size(); i++)
        images[i] = mapped ? checked(images[i]).clone() : checked(images[i]);
    for (size_t i = 0; i < images.size(); i++)
    {
        const size_t before = trainDescCollection.size();
        try
        {
            trainDescCollection.push_back(images[i]);
            utrainDescCollection.push_back(UMat());  // checkMasks reads both at the same place
            index->add(images[i]);
        }
        catch (...)  // out of memory: lists and index stay of one length
        {
            trainDescCollection.resize(before);
            utrainDescCollection.resize(before);
            throw;
        }
    }
}

Ptr<DescriptorMatcher> HierarchicalMatcherImpl::clone(bool emptyTrainData) const
{
    Ptr<HierarchicalMatcherImpl> copy = makePtr<HierarchicalMatcherImpl>(parameters);
    if (emptyTrainData)
        copy->counters = counters;
    else
    {
        copy->index = makePtr<PackedCodes>(*index);
        for (size_t i = 0; i < trainDescCollection.size(); i++)
            copy->trainDescCollection.push_back(trainDescCollection[i].clone());
        copy->utrainDescCollection.resize(utrainDescCollection.size());
    }
    return copy;
}

// Drops the empty rows that compactResult asks to drop.
void compact(std::vector<std::vector<DMatch>>& matches)
{
    matches.erase(std::remove_if(matches.begin(), matches.end(),
                          [](const std::vector<DMatch>& row) { return row.empty(); }),
            matches.end());
}

void HierarchicalMatcherImpl::knnMatchImpl(InputArray queries, std::vector<std::vector<DMatch>>& matches,
        int k, InputArrayOfArrays masks, bool compactResult)
{
    const KnnTable found = nearest(queries, k, masks);
    matches.assign(found.rows(), std::vector<DMatch>());
    for (int query = 0; query < (int)matches.size(); query++)
        for (int i = 0; i < found.size() && found[query][i] != NO_MATCH; i++)
            matches[query].push_back(match(query, found[query][i]));
    if (compactResult)
        compact(matches);
}

void HierarchicalMatcherImpl::radiusMatchImpl(InputArray queries_, std::vector<std::vector<DMatch>>& matches,
        float maxDistance, InputArrayOfArrays masks, bool compactResult)
{
    const Mat queries = checked(queries_.getMat());
    const CodeLayout& layout = index->layout();
    const int radius = cvFloor(std::min((double)maxDistance, 8. * layout.bytes()));
    SearchCost cost;
    const std::vector<std::vector<MatchKey>> found =
            index->within(queries, parameters.mode == THRESHOLD ? plan() : radiusPlan(layout, radius), radius,
                    checkedMasks(masks, queries.rows, *index), cost);
    count(cost);
    matches.assign(found.size(), std::vector<DMatch>());
    for (int query = 0; query < (int)found.size(); query++)
        for (size_t i = 0; i < found[query].size(); i++)
            matches[query].push_back(match(query, found[query][i]));
    if (compactResult)
        compact(matches);
}

void HierarchicalMatcherImpl::knnMatchArrays(InputArray queries, OutputArray indices_, OutputArray distances_,
        int k, InputArrayOfArrays masks, OutputArray imageIndices_) const
{
    if (k <= 0)
        CV_Error_(Error::StsOutOfRange, ("k is %d: it has to be > 0", k));
    const KnnTable found = nearest(queries, k, masks);
    Mat indices((int)found.rows(), k, CV_32S, Scalar(-1)), distances = indices.clone(),
                                                           images = indices.clone();
    for (int query = 0; query < indices.rows; query++)
        for (int i = 0; i < found.size() && found[query][i] != NO_MATCH; i++)
        {
            const DMatch m = match(query, found[query][i]);
            indices.at<int>(query, i) = m.trainIdx;
            distances.at<int>(query, i) = distanceOf(found[query][i]);
            images.at<int>(query, i) = m.imgIdx;
        }
    indices.copyTo(indices_);
    distances.copyTo(distances_);
    if (imageIndices_.needed())
        images.copyTo(imageIndices_);
}

void HierarchicalMatcherImpl::knnMatchArrays(InputArray queries, InputArray trains, OutputArray indices,
        OutputArray distances, int k, InputArray mask) const
{
    Ptr<DescriptorMatcher> other = clone(true);
    other->add(trains);
    other.staticCast<HierarchicalMatcherImpl>()->knnMatchArrays(
            queries, indices, distances, k, std::vector<Mat>(1, mask.getMat()), noArray());
}

void HierarchicalMatcherImpl::write(FileStorage& fs) const { writeParameters(fs, parameters); }

void HierarchicalMatcherImpl::read(const FileNode& node)
{
    MatcherParameters p = readParameters(node, parameters);
    if (p.levelSizes != parameters.levelSizes)
    {
        if (index->rows() > 0)
            CV_Error(Error::StsBadArg,
                    "Other level sizes cannot be read while there are train descriptors: clear() first");
        index = makePtr<PackedCodes>(p.levelSizes);
        HierarchicalMatcher::clear();
    }
    std::swap(parameters, p);
}

void HierarchicalMatcherImpl::saveIndex(const String& filename) const
{
    IndexFile file;
    file.levelSizes = parameters.levelSizes;
    file.mode = parameters.mode;
    file.crossCheck = parameters.crossCheck;
    file.maxRatio = parameters.maxRatio;
    file.thresholds = parameters.thresholds;
    for (size_t i = 0; i < index->images(); i++)
        file.images.push_back(index->descriptors(i));
    writeIndexFile(filename, file);
}

Ptr<HierarchicalMatcher> HierarchicalMatcherImpl::load(const String& filename)
{
    const IndexFile file = readIndexFile(filename);
    const MatcherParameters p = {file.levelSizes, file.mode, file.thresholds, file.crossCheck, file.maxRatio};
    check(p);
    Ptr<HierarchicalMatcherImpl> matcher = makePtr<HierarchicalMatcherImpl>(p);
    matcher->add(file.images);
    return matcher;
}

}  // namespace

Ptr<HierarchicalMatcher> HierarchicalMatcher::create(
        const std::vector<int>& levelSizes, int mode, float threshold, bool crossCheck)
{
    checkThreshold(threshold);
    const size_t thresholds = std::max(levelSizes.size(), (size_t)1) - 1;
    const MatcherParameters p = {
            levelSizes, mode, std::vector<float>(thresholds, threshold), crossCheck, 1.f};
    check(p);
    return makePtr<HierarchicalMatcherImpl>(p);
}

Ptr<HierarchicalMatcher> HierarchicalMatcher::loadIndex(const String& filename)
{
    return HierarchicalMatcherImpl::load(filename);
}

}  // namespace iib
}  // namespace cv

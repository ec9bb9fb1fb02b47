// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/file_numbers.hpp"
#include "index_file.hpp"
#include "parameters.hpp"
#include "search.hpp"

#include "opencv2/iib/detail/outputs.hpp"

namespace cv { namespace iib {

namespace {

DMatch toMatch(const PackedCodes& trains, int query, MatchKey n)
{
    const size_t image = trains.imageOf(indexOf(n));
    return DMatch(query, (int)(indexOf(n) - trains.start(image)), (int)image, (float)distanceOf(n));
}

//! Adds a query's row of matches; with `compact`, only if it has any.
void addMatches(const PackedCodes& trains, int query, const MatchKey* begin, const MatchKey* end,
        bool compact, std::vector<std::vector<DMatch>>& matches)
{
    if (compact && begin == end)
        return;
    matches.push_back(std::vector<DMatch>());
    matches.back().reserve(end - begin);
    for (; begin != end; ++begin)
        matches.back().push_back(toMatch(trains, query, *begin));
}

//! CV_32S matrices of k columns, -1 where there is no neighbour.
void toArrays(const PackedCodes& trains, const KnnTable& found, int k, OutputArray indices_,
        OutputArray distances_, OutputArray imageIndices_)
{
    checkPadding(k, found.rows(), trains.rows());
    Mat indices((int)found.rows(), k, CV_32S, Scalar(-1)), distances = indices.clone(),
                                                           images = indices.clone();
    for (int query = 0; query < indices.rows; query++)
        for (int i = 0; i < found.size() && found[query][i] != NO_MATCH; i++)
        {
            const DMatch m = toMatch(trains, query, found[query][i]);
            indices.at<int>(query, i) = m.trainIdx;
            distances.at<int>(query, i) = distanceOf(found[query][i]);
            images.at<int>(query, i) = m.imgIdx;
        }
    writeRows(indices, indices_);
    writeRows(distances, distances_);
    writeRows(images, imageIndices_);
}

//! Glue between DescriptorMatcher's interface and the search.
class HierarchicalMatcherImpl CV_FINAL : public HierarchicalMatcher
{
public:
    //! @param codes null: there are none yet.
    explicit HierarchicalMatcherImpl(
            const MatcherParameters& p, const Ptr<PackedCodes>& codes = Ptr<PackedCodes>())
        : parameters(p), cost(makePtr<SearchCost>())
    {
        clear();
        if (!codes)
            return;
        index = codes;
        trainDescCollection.resize(codes->images());
    }

    std::vector<int> levelSizes() const CV_OVERRIDE
    {
        return index ? index->layout().levelSizes() : parameters.levelSizes;
    }
    void setMode(int mode) CV_OVERRIDE { set(&MatcherParameters::mode, mode); }
    int getMode() const CV_OVERRIDE { return parameters.mode; }
    void setThresholds(const std::vector<float>& thresholds) CV_OVERRIDE
    {
        for (float threshold : thresholds)
            checkThreshold(threshold);  // also for a single level, which uses none
        const bool one = thresholds.size() == 1;
        set(&MatcherParameters::thresholds,
                one ? std::vector<float>(parameters.stages(), thresholds[0]) : thresholds);
    }
    std::vector<float> getThresholds() const CV_OVERRIDE { return parameters.thresholds; }
    void setCrossCheck(bool crossCheck) CV_OVERRIDE { parameters.crossCheck = crossCheck; }
    bool getCrossCheck() const CV_OVERRIDE { return parameters.crossCheck; }
    void setMaxRatio(float maxRatio) CV_OVERRIDE { set(&MatcherParameters::maxRatio, maxRatio); }
    float getMaxRatio() const CV_OVERRIDE { return parameters.maxRatio; }
    double matchCost() const CV_OVERRIDE
    {
        const uint64 all = cost->all;
        return all ? (double)cost->compared / (double)all : 0;
    }
    void resetCost() CV_OVERRIDE { cost->compared = cost->all = 0; }

    bool isMaskSupported() const CV_OVERRIDE { return true; }
    void add(InputArrayOfArrays descriptors) CV_OVERRIDE
    {
        std::vector<Mat> added = imagesOf(descriptors);
        int width = index ? index->layout().bytes() : 0;
        for (Mat& image : added)
        {
            width = width == 0 && !image.empty() ? image.cols : width;
            image = checkedDescriptors(image, width, parameters.levelSizes.empty());
        }
        if (!index && width > 0)
            index = indexFor(width);
        trainDescCollection.reserve(trainDescCollection.size() + added.size());
        for (const Mat& image : added)
        {
            if (index)
                index->add(image);
            trainDescCollection.push_back(Mat());  // DescriptorMatcher counts its entries
        }
    }
    void clear() CV_OVERRIDE
    {
        index = parameters.levelSizes.empty() ? Ptr<PackedCodes>()
                                              : makePtr<PackedCodes>(parameters.levelSizes);
        trainDescCollection.clear();
    }
    std::vector<Mat> getTrainDescriptors() const CV_OVERRIDE
    {
        std::vector<Mat> all(trainDescCollection.size());
        for (size_t i = 0; index && i < all.size(); i++)
            all[i] = index->descriptors(i, 0, index->rows(i));
        return all;
    }
    Ptr<DescriptorMatcher> clone(bool emptyTrainData) const CV_OVERRIDE
    {
        Ptr<HierarchicalMatcherImpl> result = makePtr<HierarchicalMatcherImpl>(parameters);
        if (emptyTrainData)
            result->cost = cost;
        else
        {
            if (index)
                result->index = makePtr<PackedCodes>(*index);
            result->trainDescCollection = trainDescCollection;
        }
        return result;
    }

    using HierarchicalMatcher::read;
    using HierarchicalMatcher::write;
    void read(const FileNode& node) CV_OVERRIDE
    {
        MatcherParameters p = readParameters(node, "HierarchicalMatcher", parameters);
        const bool others = p.levelSizes != parameters.levelSizes;
        if (others && index && index->rows() > 0)
            CV_Error(Error::StsBadArg,
                    "Other level sizes cannot be read while there are train descriptors: clear() first");
        std::swap(parameters, p);
        if (others)
            clear();
    }
    void write(FileStorage& fs) const CV_OVERRIDE { writeParameters(fs, parameters); }
    String getDefaultName() const CV_OVERRIDE { return "HierarchicalMatcher"; }
    void save(const String& filename) const CV_OVERRIDE { saveWhole(*this, filename, getDefaultName()); }
    void saveIndex(const String& filename) const CV_OVERRIDE
    {
        if (!index)
            CV_Error(Error::StsBadArg,
                    "There is nothing to save: add descriptors, or create the matcher with level sizes");
        saveCodes(filename, parameters, *index);
    }

    void knnMatchArrays(InputArray queries_, OutputArray indices, OutputArray distances, int k,
            InputArrayOfArrays masks, OutputArray imageIndices) const CV_OVERRIDE
    {
        const Mat queries = queries_.getMat();
        const Ptr<const PackedCodes> trains = trainCodes(queries);
        toArrays(*trains, nearest(*trains, queries, k, masks), k, indices, distances, imageIndices);
    }
    void knnMatchArrays(InputArray queries, InputArray trains, OutputArray indices, OutputArray distances,
            int k, InputArray mask) const CV_OVERRIDE
    {
        const Ptr<HierarchicalMatcher> other = copy(true);
        other->add(trains);
        other->knnMatchArrays(
                queries, indices, distances, k, std::vector<Mat>(mask.empty() ? 0 : 1, mask.getMat()));
    }

protected:
    void knnMatchImpl(InputArray queries_, std::vector<std::vector<DMatch>>& matches, int k,
            InputArrayOfArrays masks, bool compactResult) CV_OVERRIDE
    {
        const Mat queries = queries_.getMat();
        const Ptr<const PackedCodes> trains = trainCodes(queries);
        const KnnTable found = nearest(*trains, queries, k, masks);
        matches.clear();
        matches.reserve(found.rows());
        for (int query = 0; query < (int)found.rows(); query++)
            addMatches(*trains, query, found[query],
                    std::find(found[query], found[query] + found.size(), NO_MATCH), compactResult, matches);
    }
    void radiusMatchImpl(InputArray queries_, std::vector<std::vector<DMatch>>& matches, float maxDistance,
            InputArrayOfArrays masks, bool compactResult) CV_OVERRIDE
    {
        const Mat queries = queries_.getMat();
        const Ptr<const PackedCodes> trains = trainCodes(queries);
        const CodeLayout& layout = trains->layout();
        const int radius = cvFloor(std::min((double)maxDistance, 8. * layout.bytes()));
        const SearchInput input = inputFor(*trains, queries, masks, radiusPolicy(layout, radius));
        const std::vector<std::vector<MatchKey>> found = findWithin(input, radius);
        matches.clear();
        for (int query = 0; query < (int)found.size(); query++)
            addMatches(*trains, query, found[query].data(), found[query].data() + found[query].size(),
                    compactResult, matches);
    }

private:
    template <typename T> void set(T MatcherParameters::*member, const T& value)
    {
        MatcherParameters changed = parameters;
        changed.*member = value;
        check(changed);
        std::swap(parameters, changed);
    }

    //! For a matcher without level sizes: an index for codes of this width, with the images without rows so far.
    Ptr<PackedCodes> indexFor(int width) const
    {
        MatcherParameters complete = parameters;
        complete.levelSizes.assign(1, width);
        check(complete);
        const Ptr<PackedCodes> codes = makePtr<PackedCodes>(complete.levelSizes);
        for (size_t i = 0; i < trainDescCollection.size(); i++)
            codes->add(Mat());
        return codes;
    }

    Ptr<const PackedCodes> trainCodes(const Mat& queries) const
    {
        return index ? index : indexFor(std::max(queries.cols, 1));
    }

    //! Checks the arguments. The policy is that of THRESHOLD in this mode, else the given one.
    SearchInput inputFor(const PackedCodes& trains, const Mat& queries, InputArrayOfArrays masks,
            const PruningPolicy& policy) const
    {
        const CodeLayout& layout = trains.layout();
        const Mat checked = checkedDescriptors(queries, layout.bytes(), parameters.levelSizes.empty());
        const bool byLevels = parameters.mode == THRESHOLD;
        return {trains, checked, byLevels ? thresholdPolicy(layout, parameters.thresholds) : policy,
                checkedMasks(masks, checked.rows, trains), {}, 0, ScanChunk(), *cost};
    }

    KnnTable nearest(const PackedCodes& trains, const Mat& queries, int k, InputArrayOfArrays masks) const
    {
        require(k > 0, "k", k, "above 0");
        const PruningPolicy policy =
                parameters.mode == ADAPTIVE ? adaptivePolicy(trains.layout()) : PruningPolicy();
        return findNearest(
                inputFor(trains, queries, masks, policy), k, parameters.crossCheck, parameters.maxRatio);
    }

    MatcherParameters parameters;
    Ptr<PackedCodes> index;  //!< null while the width of codes is unknown
    Ptr<SearchCost> cost;    //!< shared with clones without train data
};

}  // namespace

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
    p.maxRatio = 0.92f;
    return makePtr<HierarchicalMatcherImpl>(p);
}

Ptr<HierarchicalMatcher> HierarchicalMatcher::loadIndex(const String& filename)
{
    MatcherParameters parameters;
    const Ptr<PackedCodes> codes = loadCodes(filename, parameters);
    return makePtr<HierarchicalMatcherImpl>(parameters, codes);
}

}}  // namespace cv::iib

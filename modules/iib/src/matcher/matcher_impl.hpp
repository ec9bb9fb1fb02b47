// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_MATCHER_IMPL_HPP
#define OPENCV_IIB_MATCHER_MATCHER_IMPL_HPP

#include "packed_codes.hpp"
#include "parameters.hpp"
#include "search.hpp"

#include <atomic>

namespace cv {
namespace iib {

//! Shared by an object and its clones without train data, which DescriptorMatcher's calls with two sets make.
struct CostCounters
{
    CostCounters() : compared(0), all(0) {}
    std::atomic<uint64> compared, all;
};

//! Glue between DescriptorMatcher's interface and the search: parameters and files in matcher.cpp and matcher_files.cpp,
//! calls that match in matcher_search.cpp. Tests reach its
//! ScanBlocks by dynamic_cast.
class HierarchicalMatcherImpl CV_FINAL : public HierarchicalMatcher, public ScanBlocks
{
public:
    explicit HierarchicalMatcherImpl(const MatcherParameters& p);

    std::vector<int> levelSizes() const CV_OVERRIDE;
    void setMode(int mode) CV_OVERRIDE;
    int getMode() const CV_OVERRIDE { return parameters.mode; }
    void setThresholds(const std::vector<float>& thresholds) CV_OVERRIDE;
    std::vector<float> getThresholds() const CV_OVERRIDE { return parameters.thresholds; }
    void setCrossCheck(bool crossCheck) CV_OVERRIDE { parameters.crossCheck = crossCheck; }
    bool getCrossCheck() const CV_OVERRIDE { return parameters.crossCheck; }
    void setMaxRatio(float maxRatio) CV_OVERRIDE;
    float getMaxRatio() const CV_OVERRIDE { return parameters.maxRatio; }
    double matchCost() const CV_OVERRIDE;
    void resetCost() CV_OVERRIDE;

    bool isMaskSupported() const CV_OVERRIDE { return true; }
    void add(InputArrayOfArrays descriptors) CV_OVERRIDE;
    void clear() CV_OVERRIDE;
    std::vector<Mat> getTrainDescriptors() const CV_OVERRIDE;
    Ptr<DescriptorMatcher> clone(bool emptyTrainData) const CV_OVERRIDE;

    using HierarchicalMatcher::read;
    using HierarchicalMatcher::write;
    void read(const FileNode& node) CV_OVERRIDE;
    void write(FileStorage& fs) const CV_OVERRIDE;
    String getDefaultName() const CV_OVERRIDE { return "HierarchicalMatcher"; }
    void saveIndex(const String& filename) const CV_OVERRIDE;
    //! Fills an object without train data.
    void load(class IndexReader& file);

    void match(InputArray queries, InputArray trains, std::vector<DMatch>& matches,
            InputArray mask) const CV_OVERRIDE;
    void match(InputArray queries, std::vector<DMatch>& matches, InputArrayOfArrays masks) CV_OVERRIDE;
    void knnMatch(InputArray queries, InputArray trains, std::vector<std::vector<DMatch>>& matches, int k,
            InputArray mask, bool compactResult) const CV_OVERRIDE;
    void knnMatch(InputArray queries, std::vector<std::vector<DMatch>>& matches, int k,
            InputArrayOfArrays masks, bool compactResult) CV_OVERRIDE;
    void radiusMatch(InputArray queries, InputArray trains, std::vector<std::vector<DMatch>>& matches,
            float maxDistance, InputArray mask, bool compactResult) const CV_OVERRIDE;
    void radiusMatch(InputArray queries, std::vector<std::vector<DMatch>>& matches, float maxDistance,
            InputArrayOfArrays masks, bool compactResult) CV_OVERRIDE;
    void knnMatchArrays(InputArray queries, InputArray trains, OutputArray indices, OutputArray distances,
            int k, InputArray mask) const CV_OVERRIDE;
    void knnMatchArrays(InputArray queries, OutputArray indices, OutputArray distances, int k,
            InputArrayOfArrays masks, OutputArray imageIndices) const CV_OVERRIDE;

protected:
    void knnMatchImpl(InputArray queries, std::vector<std::vector<DMatch>>& matches, int k,
            InputArrayOfArrays masks, bool compactResult) CV_OVERRIDE;
    void radiusMatchImpl(InputArray queries, std::vector<std::vector<DMatch>>& matches, float maxDistance,
            InputArrayOfArrays masks, bool compactResult) CV_OVERRIDE;

private:
    //! Takes changed parameters if they are valid.
    void set(const MatcherParameters& changed);
    //! Makes the index for codes of that width, unless it is there.
    void makeIndex(int width);
    //! The train codes, an index without rows if their width is not known yet.
    Ptr<const PackedCodes> trainCodes(const Mat& queries) const;
    //! Those of a call with two sets.
    Ptr<const PackedCodes> packed(InputArray trains, const Mat& queries) const;
    KnnTable nearest(const PackedCodes& trains, const Mat& queries, int k, InputArrayOfArrays masks) const;
    void withinRadius(const PackedCodes& trains, const Mat& queries, float maxDistance,
            InputArrayOfArrays masks, bool compactResult, std::vector<std::vector<DMatch>>& matches) const;
    PruningPolicy policy(const CodeLayout& layout) const;
    void count(const SearchCost& cost) const;

    MatcherParameters parameters;
    Ptr<PackedCodes> index;  //!< null while the width of codes is not known
    Ptr<CostCounters> counters;
};

}  // namespace iib
}  // namespace cv

#endif

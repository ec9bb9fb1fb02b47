// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_HPP
#define OPENCV_IIB_MATCHER_HPP

#include "opencv2/iib/features.hpp"

namespace cv {
namespace iib {

//! @addtogroup iib
//! @{

/** @brief Matcher of binary descriptors by Hamming distance, from coarse to fine (paper, section "Fast
Hierarchical Matching") @cite Lin2023IIB.

It replaces `cv::BFMatcher(cv::NORM_HAMMING, crossCheck)` for binary descriptors whose bytes are ordered in levels, coarse ones
first: IIB (IIBDescriptorExtractor::levelSizes), others with chosen levels (ORB: {8, 24}), or any with a single level.

All calls of cv::DescriptorMatcher but its getTrainDescriptors work in any combination: several train images, masks
(CV_8UC1, queries x train rows, one for each image; empty: all pairs allowed), `k`, radius, `crossCheck`,
`compactResult`. Differences from BFMatcher:
 - results are sorted by distance, then image, then train index, which also decides ties;
 - train images without rows are skipped; without any train rows the rows of the result are empty;
 - `k` counts over all images together;
 - `compactResult` drops every query without a match;
 - the number of rows and images is limited only by memory;
 - descriptors are copied when they are added.

As with every DescriptorMatcher, knnMatch without queries, or before an image was added, returns at once, with its vector
unchanged and its arguments unchecked; match and radiusMatch empty the vector. Rows of knnMatch have 0 to k matches.

**Cross-check.** With `crossCheck`, a pair is reported only if each is among the `k` nearest of the other, among the pairs
that masks and mode allow, over all images. For k = 1 that is the mutual nearest neighbour. Ties of a train descriptor
go to the lowest query index. It does not change radiusMatch.

**Modes.**
 - #EXACT: the result of brute force.
 - #THRESHOLD: the paper's rule. A pair goes on to the next level if its distance in the current level is at most
   threshold * bits of that level. Pairs that reach the last level are ranked by the distance over all levels. It is fast,
   but loses whole keypoints in hard scenes. The comparison is distance <= threshold * (1 + 2^-23) * bits in double, so
   that ties at a decimal threshold pass: at 0.35, 56 of 160 bits do.
 - #ADAPTIVE: approximate. Stops at 25 % of the last level if the partial distance exceeds the query's best by more than
   1.75 sigma (sigma = sqrt(n) / 2 for n bits so far). Train descriptors are compared in groups of 2048, in the order in
   which they were added; the best is that of the groups so far. Distances are exact, but neighbours may be missed.
   Descriptors of up to 4 bytes are compared as in #EXACT, and so is radiusMatch.

**Threads.** Calls run on cv::parallel_for_; results are the same for every number of threads and every
instruction set. One object may serve several threads as long as none adds descriptors, changes parameters or calls
cv::setNumThreads.

**Files.** Algorithm::save and DescriptorMatcher::write store the parameters; Algorithm::load and
DescriptorMatcher::read take either kind of file. saveIndex also stores the train descriptors. FileStorage of OpenCV 4.6
silently cuts numbers to 32 bits.

@throws cv::Exception from every call for descriptors that are not CV_8U or whose columns are not the sum
of the level sizes, and for masks of a wrong type, size or number.
 */
class CV_EXPORTS_W HierarchicalMatcher : public DescriptorMatcher
{
public:
    //! When the comparison of a pair ends early; see Modes above.
    enum Mode
    {
        EXACT,      //!< when it can no longer be a match
        THRESHOLD,  //!< when a level before the last exceeds its threshold
        ADAPTIVE    //!< at 25 % of the last level, if it is unlikely to beat the query's best so far
    };

    /** @brief Creates a matcher.

    @param levelSizes bytes of each level, coarse first, each > 0; their sum is the descriptors' width.
    @param mode one of #Mode.
    @param threshold of #THRESHOLD, for every level, 0 to 1.
    @param crossCheck report only pairs that are among each other's nearest.
    @throws cv::Exception (StsBadArg or StsOutOfRange) for a value outside these ranges.
     */
    CV_WRAP static Ptr<HierarchicalMatcher> create(const std::vector<int>& levelSizes,
            int mode = HierarchicalMatcher::EXACT, float threshold = 0.35f, bool crossCheck = false);

    /** @overload
    #EXACT, for descriptors of any width, with a single level as wide as the first descriptors that are added. The width
    may change after clear(), and in every call with a train set of its own. #ADAPTIVE is faster with the real levels.
     */
    CV_WRAP static Ptr<HierarchicalMatcher> create();

    //! @brief The best settings for IIB under changed illumination and view: those of create() without level sizes, with
    //! cross-check and a maximal ratio of 0.92.
    CV_WRAP static Ptr<HierarchicalMatcher> createRecommended();

    //! Bytes of each level, coarse first; empty if they are not known yet.
    CV_WRAP virtual std::vector<int> levelSizes() const = 0;

    /** @brief The train descriptors of each image, unpacked from the codes: CV_8U, rows x descriptor size.

    It hides DescriptorMatcher::getTrainDescriptors, which gives empty matrices, since only packed codes are kept.
     */
    CV_WRAP virtual std::vector<Mat> getTrainDescriptors() const = 0;

    //! Setters have the ranges of create(). If they throw, the old value stays.
    CV_WRAP virtual void setMode(int mode) = 0;
    CV_WRAP virtual int getMode() const = 0;

    /** @brief Sets the thresholds of #THRESHOLD: shares of the level's bits, 0 to 1.

    @param thresholds one for every level but the last, or a single one for all of them.
     */
    CV_WRAP virtual void setThresholds(const std::vector<float>& thresholds) = 0;
    //! One for every level but the last.
    CV_WRAP virtual std::vector<float> getThresholds() const = 0;

    CV_WRAP virtual void setCrossCheck(bool crossCheck) = 0;
    CV_WRAP virtual bool getCrossCheck() const = 0;

    /** @brief Ratio test inside match, knnMatch and knnMatchArrays, over the same pairs as the search.

    @param maxRatio in (0, 1]; 1, the default, turns the test off. A query keeps its matches only if its least distance is
    less than maxRatio times its second least: least < maxRatio * (1 - 2^-23) * second in double. So ties at a decimal
    ratio fail, such as 6 and 10 bits at 0.6. A query with a single candidate keeps it. The 0.75 to 0.8 that suit SIFT
    discard most correct matches of long binary codes when the view changes: use 0.9 to 0.95, or setCrossCheck.
     */
    CV_WRAP virtual void setMaxRatio(float maxRatio) = 0;
    CV_WRAP virtual float getMaxRatio() const = 0;

    /** @brief knnMatch with matrices for results: much faster in Python, and fastest for small sets in C++. Arguments are
    always checked, and outputs always written.

    This overload comes first: Python takes the first overload that fits, and train descriptors fit an output as well.

    @param queryDescriptors queries x descriptor size, CV_8U.
    @param trainDescriptors train rows x descriptor size, CV_8U, used instead of those added.
    @param indices queries x k, CV_32S: row of the train descriptor in its image, nearest first; -1 where
    there is none.
    @param distances queries x k, CV_32S: Hamming distance in bits; -1 where there is none.
    @param k number of neighbours, > 0.
    @param mask queries x train rows, CV_8UC1, or empty.
     */
    CV_WRAP virtual void knnMatchArrays(InputArray queryDescriptors, InputArray trainDescriptors,
            OutputArray indices, OutputArray distances, int k = 1, InputArray mask = noArray()) const = 0;

    /** @overload
    @param queryDescriptors queries x descriptor size, CV_8U.
    @param indices queries x k, CV_32S.
    @param distances queries x k, CV_32S.
    @param k number of neighbours, > 0.
    @param masks as in knnMatch.
    @param imageIndices queries x k, CV_32S: the train image; -1 where there is none.
     */
    CV_WRAP virtual void knnMatchArrays(InputArray queryDescriptors, OutputArray indices,
            OutputArray distances, int k = 1, InputArrayOfArrays masks = noArray(),
            OutputArray imageIndices = noArray()) const = 0;

    /** @brief The paper's match cost MC: bits compared / bits that brute force would compare, since resetCost; 0 before
    any call.

    Pairs count as if each were compared alone; masked pairs do not count. In #EXACT mode, only radiusMatch compares less
    than all bits. Clones without train data share the counters, and so do calls with a train set of their own. Safe to
    call from any thread.
     */
    CV_WRAP virtual double matchCost() const = 0;
    CV_WRAP virtual void resetCost() = 0;

    /** @brief Writes level sizes, parameters and all train descriptors to a binary file.

    The file is portable, with a version and a checksum. It replaces an old file at once: readers get the old one or the
    new one, and if anything fails, the old one stays.
    @throws cv::Exception if it cannot be written, or if neither level sizes nor descriptors were given.
     */
    CV_WRAP virtual void saveIndex(const String& filename) const = 0;

    /** @brief Reads a file of saveIndex, of this version or an older one. The result takes only codes of the width in the
    file, even if the saved matcher was created without level sizes.

    @throws cv::Exception for a file that is missing, truncated, altered, of another kind or of a newer
    version.
     */
    CV_WRAP static Ptr<HierarchicalMatcher> loadIndex(const String& filename);

    //! @brief DescriptorMatcher::clone with this class as its type. @param emptyTrainData true: copies only the parameters.
    CV_WRAP_AS(clone) Ptr<HierarchicalMatcher> copy(bool emptyTrainData = false) const;
};

//! @}

}  // namespace iib

//! @cond IGNORED
// The general form returns null for a matcher without train descriptors, and does not find the parameters that
// DescriptorMatcher::write stores at the top level.
template <>
inline Ptr<iib::HierarchicalMatcher> Algorithm::load<iib::HierarchicalMatcher>(
        const String& filename, const String& objname)
{
    const FileStorage file(filename, FileStorage::READ);
    const Ptr<iib::HierarchicalMatcher> matcher = iib::HierarchicalMatcher::create();
    matcher->read(objname.empty() ? file.root() : file[objname]);
    return matcher;
}

template <>
inline Ptr<iib::HierarchicalMatcher> Algorithm::loadFromString<iib::HierarchicalMatcher>(
        const String& text, const String& objname)
{
    const FileStorage file(text, FileStorage::READ + FileStorage::MEMORY);
    const Ptr<iib::HierarchicalMatcher> matcher = iib::HierarchicalMatcher::create();
    matcher->read(objname.empty() ? file.root() : file[objname]);
    return matcher;
}
//! @endcond

}  // namespace cv

#endif

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

It stands in for `cv::BFMatcher(cv::NORM_HAMMING, crossCheck)` with any binary descriptor whose bytes are
ordered in levels, the coarse ones first: IIB (IIBDescriptorExtractor::levelSizes), or others when told
where to look first (ORB: {8, 24}; any descriptor at all: its size as the only level).

All that cv::DescriptorMatcher offers but its getTrainDescriptors works here, in any combination: several train images,
masks (CV_8UC1, queries x train rows, one for each image, or an empty one for "all allowed"), `k`, radius, `crossCheck`,
`compactResult`. Where BFMatcher does otherwise:
 - results are in the order of distance, then image, then train index; that order decides ties;
 - train images without rows are skipped; without any train rows the rows of the result are empty;
 - `k` is met over all the images together, not up to the smallest image's rows;
 - `compactResult` drops every query without a match, whatever the reason;
 - rows and images are limited by memory alone, which holds the packed codes (levels padded to 4 or 8 bytes)
   and the results. The matrices added are copied and not referred to: later changes to them have no effect, and
   they may be released.

As with every DescriptorMatcher, knnMatch without queries, or before an image was added, returns at once: its arguments
are not looked at, and what the vector held stays; match and radiusMatch empty it. Rows of knnMatch have 0 to k matches:
masks, cross-check, maximal ratio or few train descriptors leave fewer. Code that takes two of each row needs a matcher of
create(); match() of one of createRecommended() gives what passes its ratio test.

**Cross-check.** With `crossCheck`, a pair is reported only if each is among the `k` nearest of the other,
among the pairs that masks and mode allow, over all images; for k = 1 that is the mutual nearest neighbour.
The ties of a train descriptor go to the lowest query index. In radiusMatch it changes nothing: what is
within a radius of the query has the query within that radius.

**Modes.**
 - #EXACT: what brute force finds, bit for bit.
 - #THRESHOLD: the paper's rule. A pair goes on to the next level only while its distance in the current
   one is at most threshold * bits of that level; pairs that reach the last level are ranked by the
   distance over all levels. Fast, and it loses whole keypoints in hard scenes. The comparison is distance <=
   threshold * (1 + 2^-23) * bits in double, so that a decimal number keeps its ties: at 0.35, 56 of 160 bits go on.
 - #ADAPTIVE: approximate. Stops at 25 % of the last level if the partial distance exceeds the query's best by more than
   1.75 sigma (sigma = sqrt(n) / 2 for n bits so far). Train descriptors are compared in groups of 2048, in the order in
   which they were added; the best is that of the group and of those before. Distances are exact; neighbours may be
   missed, and nothing is promised for a single query.
   Descriptors of up to 4 bytes are compared as in #EXACT, and so is radiusMatch.

**Threads.** Calls run on cv::parallel_for_; results are the same for every number of threads and every
instruction set. One object may serve several threads as long as none adds descriptors or changes
parameters. As everywhere in OpenCV, cv::setNumThreads is not to be called meanwhile.

**Files.** Algorithm::save and DescriptorMatcher::write store the parameters; Algorithm::load and
DescriptorMatcher::read take either kind of file. saveIndex stores the train descriptors as well. Where OpenCV's
FileStorage has no 64-bit numbers, as in 4.6, it cuts larger ones in a file before anyone can tell: 4294967304 is read
as 8.

@throws cv::Exception from every call for descriptors that are not CV_8U or whose columns are not the sum
of the level sizes, and for masks of a wrong type, size or number.
 */
class CV_EXPORTS_W HierarchicalMatcher : public DescriptorMatcher
{
public:
    //! When the comparison of a pair ends early; see Modes above.
    enum Mode
    {
        EXACT,      //!< when it can no longer be a match: the result is that of brute force
        THRESHOLD,  //!< when a level before the last is beyond its threshold
        ADAPTIVE  //!< at 25 % of the last level, if it is unlikely to be closer than the query's best so far
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
    #EXACT, for descriptors of any width: they are one level, as wide as the first that are added. After clear(), and in
    every call with a train set of its own, they may have another width. Enough for #EXACT, where levels matter to
    matchCost alone; #ADAPTIVE is faster with the real levels.
     */
    CV_WRAP static Ptr<HierarchicalMatcher> create();

    /** @brief What suits IIB best where light and view change: #EXACT, with cross-check and a maximal ratio of 0.92.

    Otherwise as create() without level sizes: for descriptors of any width.
     */
    CV_WRAP static Ptr<HierarchicalMatcher> createRecommended();

    //! Bytes of each level, coarse first; empty while create() without level sizes has seen no descriptors.
    CV_WRAP virtual std::vector<int> levelSizes() const = 0;

    /** @brief The train descriptors of each image, unpacked from the codes: CV_8U, rows x descriptor size.

    Call it on HierarchicalMatcher: DescriptorMatcher::getTrainDescriptors, which it hides, gives empty matrices, since
    codes are held in memory only once.
     */
    CV_WRAP virtual std::vector<Mat> getTrainDescriptors() const = 0;

    //! Setters take what create() takes, and throw a cv::Exception where it does; the old value then stays.
    CV_WRAP virtual void setMode(int mode) = 0;
    CV_WRAP virtual int getMode() const = 0;

    /** @brief Sets the thresholds of #THRESHOLD, each 0 to 1, in parts of the level's bits.

    @param thresholds one for every level but the last, which has no level after it; or a single one for
    all of them.
     */
    CV_WRAP virtual void setThresholds(const std::vector<float>& thresholds) = 0;
    //! One for every level but the last.
    CV_WRAP virtual std::vector<float> getThresholds() const = 0;

    CV_WRAP virtual void setCrossCheck(bool crossCheck) = 0;
    CV_WRAP virtual bool getCrossCheck() const = 0;

    /** @brief Ratio test inside match, knnMatch and knnMatchArrays, over the same pairs as the search.

    @param maxRatio in (0, 1]. A query keeps its matches only if its least distance is less than maxRatio times its
    second least: least < maxRatio * (1 - 2^-23) * second in double, with maxRatio as a float. So exact ties of a
    decimal number do not pass, such as 6 and 10 bits at 0.6 or 9 and 10 at 0.9, in C++ and Python alike. A query with a
    single candidate keeps it. 1, the default, turns the test off. The 0.75 to 0.8 that suit SIFT throw most right
    matches of long binary codes away where the view moves: take 0.9 to 0.95, or setCrossCheck instead.
     */
    CV_WRAP virtual void setMaxRatio(float maxRatio) = 0;
    CV_WRAP virtual float getMaxRatio() const = 0;

    /** @brief knnMatch with matrices for results: in Python many times faster than lists of DMatch, and what is quickest for
small sets in C++. Arguments are checked also where there is nothing to match, and old results never survive.

    This overload is declared before the one for the train set that was added: Python takes the first overload that
    fits, and train descriptors fit an output as well.

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

    /** @brief The paper's match cost MC: bits compared / bits that brute force would compare, since
    resetCost; 0 before any call.

    A pair counts with the bits of the levels it was taken to, as if it had been alone, not with those
    that a vector of pairs reads together; masked pairs count nowhere. So in EXACT mode all bits count, but for
    radiusMatch, which leaves pairs that are too far apart before their end. Calls with a train set of their own
    count as well, since clones with empty train data share the counters. Safe to call from any thread.
     */
    CV_WRAP virtual double matchCost() const = 0;
    CV_WRAP virtual void resetCost() = 0;

    /** @brief Writes level sizes, parameters and all train descriptors to a binary file.

    The file does not depend on the machine: little-endian, with a version and a checksum. It is written beside the
    old one, flushed to the disk and renamed: whatever fails, the old file stays whole, and whoever loads it meanwhile
    gets the old one or the new one.
    @throws cv::Exception if it cannot be written, or if neither level sizes nor descriptors were given.
     */
    CV_WRAP virtual void saveIndex(const String& filename) const = 0;

    /** @brief Reads what saveIndex wrote, by this version of the module or an older one.

    A file has level sizes: a matcher that was made without them (createRecommended) takes codes of any width, but what
    is loaded of it only those of the width that was saved.

    @throws cv::Exception for a file that is missing, truncated, altered, of another kind or of a newer
    version.
     */
    CV_WRAP static Ptr<HierarchicalMatcher> loadIndex(const String& filename);

    /** @brief DescriptorMatcher::clone with this class as its type, which it is in Python too.

    @param emptyTrainData copy the parameters alone, without the train descriptors.
     */
    CV_WRAP_AS(clone) Ptr<HierarchicalMatcher> copy(bool emptyTrainData = false) const;
};

//! @}

}  // namespace iib

//! @cond IGNORED
// The general form returns null for an empty object, as a matcher without train descriptors is, and looks for the
// parameters one level down alone, where DescriptorMatcher::write does not put them.
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

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_KERNELS_HAMMING_HPP
#define OPENCV_IIB_MATCHER_KERNELS_HAMMING_HPP

#include "code_layout.hpp"

namespace cv {
namespace iib {

//! Where a scan may give a pair up: after a part, not the last one, and later than that of the stop before.
struct PruneStage
{
    enum
    {
        NO_MAX = 1 << 28
    };
    int part;
    int most;  //!< bits that may differ since the stop before
};

//! Receives the pairs that a scan found to be near enough.
class HammingSink
{
public:
    virtual ~HammingSink() {}
    //! The train index counts from the scan's first group. May lower the thresholds of the scan.
    virtual void found(int query, int train, int distance) = 0;
};

//! All pairs of some queries with some groups of train codes.
struct HammingScan
{
    const CodeLayout* layout;
    const unsigned* queries;  //!< plain words, one code after the other
    int queryCount;
    const unsigned* trains;  //!< packed in groups
    int groups;
    const uchar*
            allowed;  //!< queryCount x groups * CODES_PER_BLOCK, 0 for pairs that do not exist; null: all do

    const PruneStage* stops;
    int stopCount;
    int64* passed;  //!< stopCount: adds up the pairs that went on at the stop
    int* limits;    //!< null, or with a single stop: for each query the most bits that may differ there
    int margin;     //!< if >= 0, limits come down to the query's least difference so far plus this

    const int* queryBelow;  //!< a pair is found if its distance is below this of its query
    const int* trainBelow;  //!< or below this of its train code; may be null
    HammingSink* sink;
};

//! Scans with the widest instruction set at hand. Train codes come in ascending order for each query, and
//! queries for each train code. What is found does not depend on the instruction set.
CV_EXPORTS void hammingScan(const HammingScan& scan);

//! What the scan wants its train codes packed as.
CV_EXPORTS CodePacking hammingPacking();

//! Name of the instruction set that hammingScan uses.
CV_EXPORTS const char* hammingInstructionSet();

}  // namespace iib
}  // namespace cv

#endif

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_HAMMING_HPP
#define OPENCV_IIB_HAMMING_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace iib {

/** How a code lies in memory, so that one vector compares many codes and few instructions count the bits.

A code is 1 + 2 * steps() words of 32 bits, each level padded with zeros so that it ends at a step. With c
the plain words, step k holds c[0] ^ ... ^ c[2k] ^ c[2k + 1] and c[2k + 1] ^ c[2k + 2]. The differences of
two packed codes are then just what a chain of full adders needs for parity and carry, and

    Hamming distance up to a step = popcount(parity) + 2 * sum of popcount(carry),

half as many population counts as words. Train codes lie in groups of LANES, word by word side by side.
 */
class CV_EXPORTS HammingLayout
{
public:
    enum { LANES = 16 };

    explicit HammingLayout(const std::vector<int>& levelSizes);

    const std::vector<int>& levelSizes() const { return sizes; }
    int levels() const { return (int)sizes.size(); }
    //! Bytes of a descriptor.
    int bytes() const { return width; }
    //! Steps up to the end of a level; the last is steps().
    int end(int level) const { return ends[level]; }
    int steps() const { return ends.back(); }
    int words() const { return 1 + 2 * steps(); }

    //! Bits that are compared up to a step.
    int bits(int steps) const;

    //! Packs a descriptor into words() words.
    void pack(const uchar* descriptor, unsigned* code) const;
    //! The inverse of pack.
    void unpack(const unsigned* code, uchar* descriptor) const;

private:
    std::vector<int> sizes, ends;
    int width;
};

//! Where a scan may give a pair up.
struct HammingStop
{
    enum { NO_MAX = 1 << 28 };
    int steps;    //!< after so many steps, more than at the stop before
    int levelMax; //!< the most bits that may differ since the stop before
    int margin;   //!< if >= 0, the most that may differ in all is the query's least so far plus this
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
    int steps;
    const unsigned* queries; //!< packed, one after the other
    int queryCount;
    const unsigned* trains; //!< packed in groups
    int groups;
    const uchar* allowed; //!< queryCount x groups * LANES, 0 for pairs that do not exist; null: all do

    const HammingStop* stops;
    int stopCount;
    int* limits;   //!< queryCount x stopCount: the most that may differ up to the stop; lowered by margins
    int64* passed; //!< stopCount: adds up the pairs that went on at the stop

    const int* queryBelow; //!< a pair is found if its distance is below this of its query
    const int* trainBelow; //!< or below this of its train code
    HammingSink* sink;
};

//! Scans with the widest instruction set at hand. Train codes come in ascending order for each query, and
//! queries for each train code. Results do not depend on the instruction set.
CV_EXPORTS void hammingScan(const HammingScan& scan);

//! Name of the instruction set that hammingScan uses.
CV_EXPORTS const char* hammingInstructionSet();

}  // namespace iib
}  // namespace cv

#endif

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_MATCHER_INDEX_FILE_HPP
#define OPENCV_IIB_MATCHER_INDEX_FILE_HPP

#include "opencv2/core.hpp"

namespace cv {
namespace iib {

//! What a file of an index holds.
struct IndexFile
{
    std::vector<int> levelSizes;
    int mode;
    bool crossCheck;
    float maxRatio;
    std::vector<float> thresholds;  //!< one for each level but the last
    std::vector<Mat> images;        //!< CV_8U descriptors, as many columns as the sum of levelSizes
};

/** Format 1, all numbers little-endian: "IIBINDEX"; u32: version, number of levels, each level's bytes, mode,
cross-check; f32: maximal ratio, each threshold; u64: number of images, each image's rows; the descriptors;
u64: FNV-1a hash of all before. */
void writeIndexFile(const String& filename, const IndexFile& file);

//! Checks that the file is whole and its numbers make sense together; whether they are valid parameters is
//! for the matcher to say.
IndexFile readIndexFile(const String& filename);

}  // namespace iib
}  // namespace cv

#endif

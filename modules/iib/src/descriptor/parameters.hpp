// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels/boxes.hpp"

namespace cv {
namespace iib {

static constexpr int MAX_EXTRA_CHANNELS = 16, ALL_CHANNELS = 63;

//! What create() is given; setters go through check() before anything changes.
struct Parameters
{
    float scaleFactor;
    int granularity;
    int channels;
    int mapping;
    bool overlap;
    int orientation;
    int extraChannels;
    int border;
    Mat_<int> selection;  //!< as IIBDescriptorExtractor::setSelection takes it; empty: all quads

    //! Throws a cv::Exception that names the parameter and its range.
    void check() const;

    //! Image channels in use and extra channels.
    int channelCount() const { return (int)channelKinds().size(); }

    //! Those channels: an IIB::Channel each, or 0 for an extra one.
    std::vector<int> channelKinds() const;
};

//! Bits that a mapping makes of one quad.
inline int bitsPerQuad(int mapping)
{
    static const int bits[] = {4, 4, 4, 8, 8, 3, 4};  // in the order of IIB::Mapping
    return bits[mapping];
}

//! Rows, and columns, of the places that a selection names at a level: quads, also between siblings, or boxes.
inline int placesInRow(int mapping, int level)
{
    return mapping == IIB::MAPPING_BOXES ? BOX_GRIDS[level - 1].n : (1 << level) - 1;
}

//! Bytes of each level that has any, coarse first; the order of the bits is in descriptor.hpp.
std::vector<int> levelBytes(const Parameters& parameters);

//! The place in the descriptor of the first bit of a group of GROUP_CHANNELS channels at a level.
int bitOffset(const Parameters& parameters, int level, int group);

//! As keys of the map that is open in `fs`.
void writeParameters(FileStorage& fs, const Parameters& parameters);

/** What writeParameters wrote; `present` is kept where a number is missing.
 @throws cv::Exception for another format and for what is no parameter or out of its range. */
Parameters readParameters(const FileNode& node, const Parameters& present);

}  // namespace iib
}  // namespace cv

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "kernels/boxes.hpp"

namespace cv { namespace iib {

static constexpr int MAX_EXTRA_CHANNELS = 16, ALL_CHANNELS = 63;

//! The arguments of create().
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
    Mat_<int> selection;  //!< see IIBDescriptorExtractor::setSelection; empty: all quads

    //! Throws a cv::Exception that names the parameter and its range.
    void check() const;

    int channelCount() const { return (int)channelKinds().size(); }

    //! The channels in use: an IIB::Channel each, or 0 for an extra one.
    std::vector<int> channelKinds() const
    {
        std::vector<int> kinds;
        for (int kind = 1; kind <= ALL_CHANNELS; kind <<= 1)
            if (channels & kind)
                kinds.push_back(kind);
        kinds.resize(kinds.size() + extraChannels, 0);
        return kinds;
    }
};

//! All bits of a place, as a mask of a selection. @param kind of the channel.
inline int bitsOfPlace(int mapping, int kind, int level, int row, int col)
{
    return mapping == IIB::MAPPING_BOXES ? boxMask(kind, level, row, col) : (1 << bitsPerQuad(mapping)) - 1;
}

//! Calls visit(channel, row, column, bits) for each place of a level: those of the selection, or all, row by row.
template <typename Visit> void forEachPlace(const Parameters& p, int level, const Visit& visit)
{
    for (int i = 0; i < p.selection.rows; i++)
        if (p.selection(i, 0) == level)
            visit(p.selection(i, 1), p.selection(i, 2), p.selection(i, 3), p.selection(i, 4));
    if (!p.selection.empty())
        return;
    const std::vector<int> kinds = p.channelKinds();
    const int n = placesInRow(p.mapping, level), step = p.overlap || p.mapping == IIB::MAPPING_BOXES ? 1 : 2;
    for (int row = 0; row < n; row += step)
        for (int col = 0; col < n; col += step)
            for (int channel = 0; channel < (int)kinds.size(); channel++)
                visit(channel, row, col, bitsOfPlace(p.mapping, kinds[channel], level, row, col));
}

//! As keys of the map that is open in `fs`.
void writeParameters(FileStorage& fs, const Parameters& parameters);

/** Reads the node of writeParameters. Missing numbers keep the values of `present`.
 @throws cv::Exception for another format and for values out of range. */
Parameters readParameters(const FileNode& node, const Parameters& present);

}}  // namespace cv::iib

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_PARAMETERS_HPP
#define OPENCV_IIB_DESCRIPTOR_PARAMETERS_HPP

#include "../precomp.hpp"
#include "kernels/cell_grid.hpp"

namespace cv {
namespace iib {

enum
{
    MAX_EXTRA_CHANNELS = 16,
    ALL_CHANNELS = 63
};

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
    int channelCount() const;
};

//! Bits that a mapping makes of one quad.
int bitsPerQuad(int mapping);

}  // namespace iib
}  // namespace cv

#endif

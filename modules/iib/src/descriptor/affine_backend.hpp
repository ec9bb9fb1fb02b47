// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_AFFINE_BACKEND_HPP
#define OPENCV_IIB_DESCRIPTOR_AFFINE_BACKEND_HPP

#include "../precomp.hpp"

namespace cv {
namespace iib {

/** A detector of the kind that an AffineFeature wraps, with default parameters. AffineFeature does not tell which it is, and
 its descriptors do not tell it either: several have 32 or 64 bytes. But the first of its views is the image itself, where
 it finds what that detector finds. @throws cv::Exception (StsBadArg) if that is none that is known. */
Ptr<Feature2D> affineBackend(Feature2D& affine);

}  // namespace iib
}  // namespace cv

#endif

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace iib_python {

// The classes and functions of opencv_iib._core. Methods that users call have OpenCV's names, keywords and a docstring here, which the
// stub takes from here, too; opencv_iib/_methods.py makes functions of Python of them. Classes of opencv_iib extend these by what
// takes arrays, files and objects of any cv2, through methods whose names begin with an underscore.
void bindDetectors(nanobind::module_& m);  // first: it has the base class of IIBDescriptorExtractor
void bindExtractor(nanobind::module_& m);
void bindMatcher(nanobind::module_& m);
void bindMappedIndex(nanobind::module_& m);
void bindFunctions(nanobind::module_& m);
void bindLocalization(nanobind::module_& m);
void bindFiles(nanobind::module_& m);

}  // namespace iib_python

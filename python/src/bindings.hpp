// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace iib_python {

// The classes and functions of opencv_iib._core. Methods with a docstring are public: they have OpenCV's names and keywords, also in the stub,
// and opencv_iib/_methods.py makes functions of Python of them. All others are internal; opencv_iib wraps them for arrays, files and objects
// of any cv2. Their names begin with an underscore in classes that have methods of both kinds.
void bindDetectors(nanobind::module_& m);  // first: it binds the base class of IIBDescriptorExtractor
void bindExtractor(nanobind::module_& m);
void bindMatcher(nanobind::module_& m);
void bindMappedIndex(nanobind::module_& m);
void bindFunctions(nanobind::module_& m);
void bindLocalization(nanobind::module_& m);
void bindFiles(nanobind::module_& m);

}  // namespace iib_python

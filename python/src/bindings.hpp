// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace iib_python {

// The classes and functions of opencv_iib._core. A method with a docstring is one that users call: it has OpenCV's name and keywords,
// which the stub takes from here, too, and opencv_iib/_methods.py makes a function of Python of it. All else is for opencv_iib alone,
// whose classes and functions take arrays, files and objects of any cv2 and give these what they need; where a class has methods
// of both kinds, such names begin with an underscore.
void bindDetectors(nanobind::module_& m);  // first: it has the base class of IIBDescriptorExtractor
void bindExtractor(nanobind::module_& m);
void bindMatcher(nanobind::module_& m);
void bindMappedIndex(nanobind::module_& m);
void bindFunctions(nanobind::module_& m);
void bindLocalization(nanobind::module_& m);
void bindFiles(nanobind::module_& m);

}  // namespace iib_python

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace iib_python {

// The classes and functions of opencv_iib._core: the C++ objects with arrays and plain values for arguments and results. What
// users see, with names, keywords and documentation, is opencv_iib/descriptor.py, detectors.py, geometry.py, mapped_index.py,
// matcher.py, refinement.py and rotation.py, which also check what they are given: methods of nanobind's (3.1) have no
// inspect.signature, show 2.2f as 2.200000047683716 and tell mistakes by C++ types.
void bindDetectors(nanobind::module_& m);  // first: it has the base class of Extractor
void bindExtractor(nanobind::module_& m);
void bindMatcher(nanobind::module_& m);
void bindMappedIndex(nanobind::module_& m);
void bindFunctions(nanobind::module_& m);
void bindLocalization(nanobind::module_& m);
void bindFiles(nanobind::module_& m);

}  // namespace iib_python

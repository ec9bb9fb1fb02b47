// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace iib_python {

// The classes of opencv_iib._core: the C++ objects with arrays and plain values for arguments and results. What users
// see, with names, keywords and documentation, is opencv_iib/descriptor.py, detectors.py, geometry.py, mapped_index.py,
// matcher.py, refinement.py and rotation.py.
void bindDetectors(nanobind::module_& m);  // first: it has the base class of Extractor
void bindExtractor(nanobind::module_& m);
void bindMatcher(nanobind::module_& m);
void bindMappedIndex(nanobind::module_& m);
void bindRefinement(nanobind::module_& m);
void bindRotation(nanobind::module_& m);
void bindLocalization(nanobind::module_& m);
void bindGeometry(nanobind::module_& m);

}  // namespace iib_python

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv { namespace iib {

/* The files of an index: manifest.iib, segment-NNNNNN.iib, lock, and unfinished files, not yet renamed. */

String manifestOf(const String& folder);
String segmentOf(const String& folder, uint64 number);
String lockOf(const String& folder);

//! Makes the folder if it is missing.
void makeFolder(const String& folder);
//! Throws if the folder holds anything but a lock and unfinished files, which a killed create() leaves.
void checkEmpty(const String& folder);
//! Removes the unfinished files of an index and nothing else. Requires the lock.
void removeUnfinished(const String& folder);

}}  // namespace cv::iib

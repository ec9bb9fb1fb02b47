// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "opencv2/core.hpp"

namespace cv {
namespace iib {

/* The files of an index: manifest.iib, segment-NNNNNN.iib, lock, and unfinished ones, which a writer has begun and not yet
renamed. */

String manifestOf(const String& folder);
String segmentOf(const String& folder, uint64 number);
String lockOf(const String& folder);

//! Makes the folder unless it is there.
void makeFolder(const String& folder);
//! Throws if there is anything but the lock and unfinished files, which a killed create() leaves.
void checkEmpty(const String& folder);
//! Removes the unfinished files of an index and nothing else. Only under the lock.
void removeUnfinished(const String& folder);

}  // namespace iib
}  // namespace cv

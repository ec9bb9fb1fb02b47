// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_TEST_SUPPORT_DISK_HPP
#define OPENCV_IIB_TEST_SUPPORT_DISK_HPP

#include "test_precomp.hpp"

#ifdef __linux__
#include <csignal>
#include <sys/resource.h>
#endif

namespace opencv_test {

#ifdef __linux__
//! No file grows beyond this many bytes, as on a full disk.
struct FullDisk
{
    rlimit before;
    explicit FullDisk(rlim_t bytes)
    {
        getrlimit(RLIMIT_FSIZE, &before);
        rlimit limit = before;
        limit.rlim_cur = bytes;
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before); }
};
#endif

}  // namespace opencv_test

#endif

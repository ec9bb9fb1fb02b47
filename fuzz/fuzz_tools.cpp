// SPDX-License-Identifier: Apache-2.0

// The readers of the evaluation: homographies, keypoint lists. Any text gives a cv::Exception or
// what the headers promise.

#include "byte_source.hpp"
#include "common/dataset.hpp"
#include "file.hpp"
#include "common/keypoints.hpp"

#include <cmath>

namespace {

using namespace iib_tools;

void readAs(int kind, const std::string& file)
{
    if (kind == 0)
    {
        const cv::Matx33d H = readHomography(file);
        for (const double value : H.val)
            FUZZ_CHECK(std::isfinite(value));
        FUZZ_CHECK(cv::determinant(H) != 0);
    }
    else
        for (const cv::KeyPoint& kp : readKeypoints(file))
            FUZZ_CHECK(std::isfinite(kp.pt.x) && std::isfinite(kp.pt.y) && std::isfinite(kp.size) &&
                       kp.size >= 0 && std::isfinite(kp.angle) && std::isfinite(kp.response));
}

}  // namespace

//! The first byte chooses the reader, '0' or '1'.
extern "C" int LLVMFuzzerTestOneInput(const uchar* data, size_t size)
{
    static const ScratchFile file(".csv");
    file.write(size > 0 ? std::string((const char*)data + 1, size - 1) : std::string());
    refused([&] { readAs(size > 0 ? data[0] % 2 : 0, file.name); });
    return 0;
}

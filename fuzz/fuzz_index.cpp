// SPDX-License-Identifier: Apache-2.0

// HierarchicalMatcher::loadIndex on any bytes, with a right checksum in half of the runs. Expects a cv::Exception, or
// an index that works and stays the same when saved and loaded again.

#include "byte_source.hpp"
#include "support/temporary_file.hpp"

#include "opencv2/iib/detail/checked_file.hpp"
#include "opencv2/iib.hpp"

namespace {

using namespace cv;
using cv::iib::HierarchicalMatcher;

//! Appends the checksum of saveIndex: FNV-1a of all bytes before, little-endian.
std::string withChecksum(std::string bytes)
{
    cv::iib::Fnv1a hash;
    hash.add(bytes.data(), bytes.size());
    for (int i = 0; i < 8; i++)
        bytes += (char)(hash.value() >> 8 * i);
    return bytes;
}

void checkIndex(const Ptr<HierarchicalMatcher>& matcher)
{
    static const opencv_test::TemporaryFile copy;
    matcher->saveIndex(copy.name);
    const Ptr<HierarchicalMatcher> again = HierarchicalMatcher::loadIndex(copy.name);
    FUZZ_CHECK(matcher->levelSizes() == again->levelSizes() &&
               matcher->getThresholds() == again->getThresholds());
    FUZZ_CHECK(matcher->getMode() == again->getMode() && matcher->getMaxRatio() == again->getMaxRatio());
    const std::vector<Mat> images = matcher->getTrainDescriptors(), copies = again->getTrainDescriptors();
    FUZZ_CHECK(images.size() == copies.size());
    for (size_t i = 0; i < images.size(); i++)
        FUZZ_CHECK(images[i].size() == copies[i].size() &&
                   (images[i].empty() || norm(images[i], copies[i], NORM_INF) == 0));
    std::vector<std::vector<DMatch>> matches;
    for (const Mat& image : images)
        if (image.total() < 4096)
            matcher->knnMatch(image, matches, 2);
}

}  // namespace

FUZZ_TARGET
{
    const bool valid = in.flag();
    const std::string bytes = in.bytes(in.left());
    static const opencv_test::TemporaryFile file;
    file.write(valid ? withChecksum(bytes) : bytes);
    Ptr<HierarchicalMatcher> matcher;
    if (!refused([&] { matcher = HierarchicalMatcher::loadIndex(file.name); }))
        checkIndex(matcher);
}

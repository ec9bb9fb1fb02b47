// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef IIB_TOOLS_STRESS_HPP
#define IIB_TOOLS_STRESS_HPP

#include "opencv2/iib.hpp"

#include <string>

namespace iib_stress {

//! @throws std::logic_error
void require(bool condition, const char* what);

//! Of this process, in MB: "VmRSS" now, "VmHWM" at its highest.
double memory(const std::string& name);

//! Prints the time and memory that what was done since it was made has taken.
class Report
{
public:
    explicit Report(const std::string& what_) : what(what_), start(cv::getTickCount()) {}
    ~Report();

private:
    const std::string what;
    const int64 start;
};

cv::Mat noise(cv::Size size, int type, int seed);
//! Rotated keypoints of sizes 8 to 64.
std::vector<cv::KeyPoint> scatter(cv::Size size, int count);
//! Descriptors of all the keypoints.
cv::Mat describe(cv::iib::IIB& iib, const cv::Mat& image, std::vector<cv::KeyPoint> keypoints);
bool equal(const cv::Mat& a, const cv::Mat& b);

void manyKeypoints(int count);
void largeImages(int megapixels);
void manyCodes(int count);
void manyThreads(int seconds);

}  // namespace iib_stress

#endif

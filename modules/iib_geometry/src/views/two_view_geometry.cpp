// SPDX-License-Identifier: Apache-2.0
#include "two_view_geometry.hpp"

#include <limits>

#include "../precomp.hpp"
#include "opencv2/iib/verdict.hpp"

namespace cv::iib {
namespace {

const double THRESHOLD = 1.5;  // pixels from the epipolar line, or from the point mapped by the homography
const double CONFIDENCE = .9999;
const int MOST_TRIALS = 10000;

}  // namespace

TwoViewGeometry::TwoViewGeometry(const Mat& points1, const Mat& points2)
    : logFalseAlarms(std::numeric_limits<double>::infinity())
{
    for (bool epipolar : {true, false})
    {
        if (points1.rows < (epipolar ? 8 : 5))
            continue;
        std::vector<uchar> marks;
        try
        {
            if (epipolar)
                findFundamentalMat(points1, points2, USAC_MAGSAC, THRESHOLD, CONFIDENCE, MOST_TRIALS, marks);
            else
                findHomography(points1, points2, USAC_MAGSAC, THRESHOLD, marks, MOST_TRIALS, CONFIDENCE);
        }
        catch (const cv::Exception&)  // some versions of OpenCV throw for degenerate points
        {
            continue;
        }
        if ((int)marks.size() != points1.rows)
            continue;
        const double alarms = iib::logFalseAlarms(points1, points2, marks, epipolar, THRESHOLD);
        if (alarms < logFalseAlarms)
        {
            logFalseAlarms = alarms;
            inliers = marks;
        }
    }
}

}  // namespace cv::iib

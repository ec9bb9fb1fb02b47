// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/views.hpp"
#include "opencv2/iib/detail/outputs.hpp"

#include "../common/points.hpp"
#include "../verdict/verdict.hpp"
#include "view_matches.hpp"

namespace cv::iib {
namespace {

class ViewMatcherImpl : public ViewMatcher
{
public:
    ViewMatcherImpl(const Mat& image, const Mat& mask, int maxFeatures, double maxTilt)
        : first_(image, mask, maxFeatures), maxFeatures_(maxFeatures), maxTilt_(maxTilt)
    {
    }

    bool match(InputArray image, OutputArray points1, OutputArray points2, OutputArray covariances,
            OutputArray similarities, OutputArray view, InputArray mask, String* reason) const override
    {
        const ImageViews second(image.getMat(), mask.getMat(), maxFeatures_);
        const ViewMatches best = matchInSomeViews(first_, second, maxTilt_);
        writeRows(best.points1, points1);
        writeRows(best.points2, points2);
        writeRows(best.covariances, covariances);
        writeRows(best.similarities, similarities);
        const bool found = best.logFalseAlarms < Verdict::CERTAIN;
        if (reason)
            *reason = found ? ""
                            : format("at most %.0f of %d matches agree, which could be random: the images "
                                     "may not show the same scene, or their views differ too much",
                                      best.inliers, best.points1.rows);
        if (found)
            writeRows(Mat(best.map), view);
        else
            clear(view);
        return found;
    }

private:
    ImageViews first_;
    int maxFeatures_;
    double maxTilt_;
};

}  // namespace

Ptr<ViewMatcher> ViewMatcher::create(InputArray image, int maxFeatures, double maxTilt, InputArray mask)
{
    const double mostTilt = 8;
    if (!(maxTilt >= 1 && maxTilt <= mostTilt))
        CV_Error(Error::StsOutOfRange,
                format("matchViews: maxTilt is %g; it must be 1 (no tilted views) to %g", maxTilt, mostTilt));
    if (maxFeatures < 0)
        CV_Error(Error::StsOutOfRange,
                format("matchViews: maxFeatures is %d; it must be a number of keypoints, or 0 for all",
                        maxFeatures));
    return makePtr<ViewMatcherImpl>(image.getMat(), mask.getMat(), maxFeatures, maxTilt);
}

bool matchViews(InputArray image1, InputArray image2, OutputArray points1, OutputArray points2,
        OutputArray covariances, OutputArray similarities, OutputArray view, int maxFeatures, double maxTilt,
        InputArray mask1, InputArray mask2, String* reason)
{
    return ViewMatcher::create(image1, maxFeatures, maxTilt, mask1)
            ->match(image2, points1, points2, covariances, similarities, view, mask2, reason);
}

}  // namespace cv::iib

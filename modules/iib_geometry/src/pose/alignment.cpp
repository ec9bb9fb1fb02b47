// SPDX-License-Identifier: Apache-2.0
#include "opencv2/iib/alignment.hpp"

#include "opencv2/iib.hpp"
#include "planar_problem.hpp"
#include "uncertainty.hpp"
#include "verdict.hpp"

namespace cv::iib {
namespace {

const int FEATURES = 2000;
const double SCALE = .5;  // Cauchy's, pixels
//! Matches that agree. Images of other scenes have 5 at most (iib_evaluation --only alignment).
const int FEWEST = 16;
//! Of a corner, pixels: above it what agrees is a part, such as a logo that both images hold.
const double MOST_DEVIATION = 2;
const double ANY = 1e3;          // deviation of a number of a transform that nothing tells
const double LEAST_SHARE = .05;  // of all matches

//! Refined matches, N x 2 each, CV_64F.
struct Matches
{
    Mat reference, image;
};

Matches match(const Mat& reference, const Mat& image, bool rotated)
{
    const Ptr<IIBDescriptorExtractor> extractor = IIBDescriptorExtractor::createRecommended(FEATURES);
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::createRecommended();
    std::vector<KeyPoint> keypoints1, keypoints2;
    std::vector<DMatch> matches;
    if (rotated)
    {
        extractor->setOrientation(IIBDescriptorExtractor::ORIENTATION_KEYPOINT);
        matchRotated(reference, image, extractor, matcher, keypoints1, keypoints2, matches);
    }
    else
    {
        Mat codes1, codes2;
        extractor->detectAndCompute(reference, noArray(), keypoints1, codes1);
        extractor->detectAndCompute(image, noArray(), keypoints2, codes2);
        matcher->match(codes1, codes2, matches);
    }
    Mat points1, points2;
    Matches result = {Mat(0, 2, CV_64F), Mat(0, 2, CV_64F)};
    if (matches.empty())
        return result;
    refineMatches(reference, keypoints1, image, keypoints2, matches, points1, points2);
    points1.convertTo(result.reference, CV_64F);
    points2.convertTo(result.image, CV_64F);
    return result;
}

//! N x 4, CV_32F, of those that are marked.
Mat rowsOf(const Matches& matches, const Verdict::Marks& marked)
{
    Mat both, result(0, 4, CV_32F);
    hconcat(matches.reference, matches.image, both);
    both.convertTo(both, CV_32F);
    for (size_t i = 0; i < marked.size(); i++)
        if (marked[i])
            result.push_back(both.row((int)i));
    return result;
}

}  // namespace

bool alignImages(InputArray reference, InputArray image, OutputArray transform, int model, OutputArray error,
        OutputArray matches)
{
    if (model < ALIGN_TRANSLATION || model > ALIGN_HOMOGRAPHY)
        CV_Error(Error::StsBadArg,
                format("alignImages: model is %d; it must be ALIGN_TRANSLATION, ALIGN_SIMILARITY, "
                       "ALIGN_AFFINE or ALIGN_HOMOGRAPHY",
                        model));
    const Mat first = reference.getMat(), second = image.getMat();
    Mat agreed(0, 4, CV_32F);
    for (bool rotated : {false, true})
    {
        if (rotated && model == ALIGN_TRANSLATION)
            break;
        const Matches all = match(first, second, rotated);
        const PlanarProblem problem(all.reference, all.image, model);
        const Fit<PlanarProblem> fit = robustFit(problem, SCALE);
        const Mat agree = rowsOf(all, within(3 * SCALE, fit.squared));
        if (agree.rows > agreed.rows)
            agreed = agree;
        if (agree.rows < FEWEST || agree.rows < LEAST_SHARE * all.image.rows)
            continue;
        const Square<PlanarProblem::Step> covariance =
                covarianceOf(problem, fit, partsOf(all.reference), ANY);
        const double right = second.cols - 1, bottom = second.rows - 1;
        const Point2d corners[] = {{0, 0}, {right, 0}, {right, bottom}, {0, bottom}};
        Mat deviations(4, 1, CV_64F);
        for (int k = 0; k < 4; k++)
            deviations.at<double>(k) = problem.deviation(fit.model, covariance, corners[k]);
        if (!checkRange(deviations, true, nullptr, 0, MOST_DEVIATION))
            continue;
        Mat(problem.inPixels(fit.model)).copyTo(transform);
        if (error.needed())
            deviations.copyTo(error);
        if (matches.needed())
            agreed.copyTo(matches);
        return true;
    }
    transform.release();
    error.release();
    if (matches.needed())
        agreed.copyTo(matches);
    return false;
}

}  // namespace cv::iib

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/image_input.hpp"
#include "../normalization/local_normalization.hpp"
#include "match_refiner.hpp"

#include "opencv2/iib/detail/outputs.hpp"
#include "opencv2/iib/refinement.hpp"

#include <array>

namespace cv { namespace iib {

namespace {

const double NORMALIZATION_SIGMA = 8;

Mat checked(InputArray image, const char* name)
{
    const Mat pixels = image.getMat();
    if (pixels.empty())
        CV_Error(Error::StsBadArg,
                format("%s is empty, but there are matches: did imread find the file?", name));
    checkImage(pixels);
    return pixels;
}

//! The images of a pair, checked and prepared; empty without matches.
std::array<PreparedImage, 2> prepared(
        InputArray image1, InputArray image2, const std::vector<DMatch>& matches)
{
    std::array<PreparedImage, 2> images;
    if (matches.empty())
        return images;
    const Mat pixels[] = {checked(image1, "image 1"), checked(image2, "image 2")};
    const auto prepare = [&](const Range& range) {
        for (int i = range.start; i < range.end; i++)
            images[i] = PreparedImage(pixels[i]);
    };
    if (getNumThreads() > 2)
        prepare(Range(0, 2));  // one image after the other, on all threads
    else
        parallel_for_(Range(0, 2), prepare);
    return images;
}

void write(const std::vector<Refinement>& matches, const std::vector<KeyPoint>& keypoints1,
        OutputArray points1, OutputArray points2, OutputArray covariances, OutputArray similarities)
{
    const int n = (int)matches.size();
    Mat first(n, 2, CV_32F), second(n, 2, CV_32F), covariance(n, 3, CV_32F), similarity(n, 1, CV_32F);
    for (int i = 0; i < n; i++)
    {
        const PatchAlignment& found = matches[i].found;
        first.at<Point2f>(i) = keypoints1[matches[i].match.queryIdx].pt;
        second.at<Vec2f>(i) = found.point;
        similarity.at<float>(i) = (float)found.similarity;
        const Matx22d& c = found.covariance;
        covariance.at<Vec3f>(i) = Vec3d(c(0, 0), c(0, 1), c(1, 1));
    }
    writeRows(first, points1);
    writeRows(second, points2);
    writeRows(covariance, covariances);
    writeRows(similarity, similarities);
}

std::vector<Refinement> refined(const MatchRefiner& refiner, const std::vector<DMatch>& matches)
{
    std::vector<Refinement> all(matches.begin(), matches.end());
    refiner.refine(all);
    return all;
}

}  // namespace

PreparedImage::PreparedImage(InputArray image)
    : pixels(preparedForAlignment(
              normalizeLocally(integerMap(checked(image, "the image")), NORMALIZATION_SIGMA)))
{
}

void refineMatches(InputArray image1, const std::vector<KeyPoint>& keypoints1, InputArray image2,
        const std::vector<KeyPoint>& keypoints2, const std::vector<DMatch>& matches1to2, OutputArray points1,
        OutputArray points2, OutputArray covariances, OutputArray similarities)
{
    const std::array<PreparedImage, 2> pair = prepared(image1, image2, matches1to2);
    refineMatches(pair[0], keypoints1, pair[1], keypoints2, matches1to2, points1, points2, covariances,
            similarities);
}

void refineMatches(const PreparedImage& image1, const std::vector<KeyPoint>& keypoints1,
        const PreparedImage& image2, const std::vector<KeyPoint>& keypoints2,
        const std::vector<DMatch>& matches1to2, OutputArray points1, OutputArray points2,
        OutputArray covariances, OutputArray similarities)
{
    std::vector<Refinement> all;
    if (!matches1to2.empty())
        all = refined(MatchRefiner(image1, image2, keypoints1, keypoints2, matches1to2), matches1to2);
    write(all, keypoints1, points1, points2, covariances, similarities);
}

void propagateMatches(InputArray image1, const std::vector<KeyPoint>& keypoints1, InputArray image2,
        const std::vector<KeyPoint>& keypoints2, std::vector<DMatch>& matches1to2, OutputArray points1,
        OutputArray points2, OutputArray covariances, OutputArray similarities)
{
    const std::array<PreparedImage, 2> pair = prepared(image1, image2, matches1to2);
    propagateMatches(pair[0], keypoints1, pair[1], keypoints2, matches1to2, points1, points2, covariances,
            similarities);
}

void propagateMatches(const PreparedImage& image1, const std::vector<KeyPoint>& keypoints1,
        const PreparedImage& image2, const std::vector<KeyPoint>& keypoints2,
        std::vector<DMatch>& matches1to2, OutputArray points1, OutputArray points2, OutputArray covariances,
        OutputArray similarities)
{
    std::vector<Refinement> all;
    if (!matches1to2.empty())
    {
        const MatchRefiner refiner(image1, image2, keypoints1, keypoints2, matches1to2);
        all = refined(refiner, matches1to2);
        propagate(refiner, keypoints1, keypoints2, all);
        for (size_t i = matches1to2.size(); i < all.size(); i++)
            matches1to2.push_back(all[i].match);
    }
    write(all, keypoints1, points1, points2, covariances, similarities);
}

}}  // namespace cv::iib

// SPDX-License-Identifier: Apache-2.0
#include "view_search.hpp"

#include "../verdict/support.hpp"

namespace cv::iib {
namespace {

// The differences of these angles include every multiple of 30 degrees; descriptors tolerate 15 degrees.
const std::vector<float> FIRST_ANGLES{-1, 30, 60}, SECOND_ANGLES{-1, 90, 180, 270};
const int LEVELS = 5;          // of scale, in steps of the square root of 2
const double TOLERATED = 2;    // tilt that descriptors tolerate
const double LONGITUDES = 72;  // degrees times tilt between tilted views (Morel and Yu 2009, section 3.2)
const double FARTHER = .6;     // scale of the other image, against a tilted view
const double TOLERANCE = .4;   // relative error of displacements, since views are sampled coarsely
const int IMMEDIATE = 30;      // matches: support with which a candidate is tried at once
const int ROTATED = 15;        // the same for images that are only rotated, where chance seldom gives as many
const int LEAST = 4;           // matches: support with which a candidate may be tried after the search
const int MOST_TRIED = 6;      // of candidates after the search
const int LARGEST = 4096;      // pixels: longer side of an image, during the search
const double MUCH_LARGER = 1.5;

//! Pairs of views to compare, in this order.
std::vector<std::pair<View, View>> pairsOf(double maxTilt)
{
    std::vector<std::pair<View, View>> pairs = {{View(), View()}};
    const auto add = [&](const View& one, const View& other) {
        pairs.push_back({one, other});
        pairs.push_back({other, one});
    };
    for (int level = 1; level < LEVELS; level++)
        add(View::reduced(std::pow(.5, .5 * level)), View());
    for (double tilt = TOLERATED; tilt < maxTilt; tilt *= TOLERATED)
        for (double other : {1., FARTHER})
            for (double degrees = 0; degrees < 180; degrees += LONGITUDES / tilt)
                add(View::tilted(tilt, degrees * CV_PI / 180), View::reduced(other));
    return pairs;
}

Matx33d rotation(double degrees)
{
    const double c = std::cos(degrees * CV_PI / 180), s = std::sin(degrees * CV_PI / 180);
    return {c, -s, 0, s, c, 0, 0, 0, 1};
}

Points placesOf(const std::vector<KeyPoint>& keypoints, const std::vector<DMatch>& matches,
        int DMatch::*index, const Matx33d& by)
{
    Points places;
    for (const DMatch& match : matches)
        places.push_back(moved(by, keypoints[match.*index].pt));
    return places;
}

int longerOf(const ImageViews& image) { return std::max(image.size().width, image.size().height); }

//! An image whose longer side is reduced to some pixels.
struct SearchedImage
{
    const ImageViews& image;
    int side;

    const std::vector<Described>& coarse(const View& view, const std::vector<float>& angles) const
    {
        return image.coarse(view, angles, side);
    }
    Matx33d toCoarse(const View& view) const { return image.toCoarse(view, side); }
};

//! Pixels of the longer side of an image whose pixels are as large as those of the other one in an ordinary search, if that is smaller.
double sideAtPixelsOf(const ImageViews& other, const ImageViews& image)
{
    return longerOf(image) *
           std::min(ImageViews::COARSE_SIDE / (double)std::min(longerOf(other), longerOf(image)), 1.);
}

//! An image at about the pixels of the other one: of few sizes, since ImageViews keeps each.
SearchedImage atPixelsOf(const ImageViews& other, const ImageViews& image)
{
    int side = ImageViews::COARSE_SIDE;
    while (side < sideAtPixelsOf(other, image) && side < LARGEST)
        side = std::min(cvRound(side * std::sqrt(2.)), LARGEST);
    return {image, side};
}

//! The map with the most support over all rotations of two views.
ViewCandidate compare(const SearchedImage& first, const View& view1, const SearchedImage& second,
        const View& view2, const HierarchicalMatcher& matcher)
{
    const std::vector<Described>&features1 = first.coarse(view1, FIRST_ANGLES),
          &features2 = second.coarse(view2, SECOND_ANGLES);
    const Matx33d to1 = first.toCoarse(view1).inv(), to2 = second.toCoarse(view2).inv();
    ViewCandidate best{Matx33d::eye(), 0};
    for (size_t i = 0; i < features1.size(); i++)
        for (size_t j = 0; j < features2.size(); j++)
        {
            if (features1[i].codes.empty() || features2[j].codes.empty())
                continue;
            const double angle = std::max(SECOND_ANGLES[j], 0.f) - std::max(FIRST_ANGLES[i], 0.f);
            std::vector<DMatch> matches;
            matcher.match(features1[i].codes, features2[j].codes, matches);
            const Matx33d map = to2 * rotation(angle) * to1.inv();
            const Points places1 = placesOf(features1[i].keypoints, matches, &DMatch::queryIdx, to1),
                         places2 = placesOf(features2[j].keypoints, matches, &DMatch::trainIdx, to2);
            const Support support = Support::around(places1, places2, map, TOLERANCE);
            if (support.count > best.support)
                best = {support.map, support.count};
        }
    return best;
}

//! Tries candidates until one ends the search.
bool search(const SearchedImage& first, const SearchedImage& second, double maxTilt,
        const std::function<bool(const ViewCandidate&, int)>& tryCandidate, int& tried)
{
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create();
    matcher->setCrossCheck(true);
    // A larger image has more places.
    const int rotations = int(FIRST_ANGLES.size() * SECOND_ANGLES.size()) *
                          cvRound(square(std::max({first.side, second.side, ImageViews::COARSE_SIDE}) /
                                         (double)ImageViews::COARSE_SIDE));
    const bool areWhole = std::max(longerOf(first.image), longerOf(second.image)) <= WORKING_SIZE &&
                          !isMuchLarger(first.image, second.image);
    const auto wasTried = [&](const ViewCandidate& candidate) {  // before the search
        return areWhole && haveSimilarViews(candidate.map, Matx33d::eye());
    };
    std::vector<ViewCandidate> others;
    for (const auto& pair : pairsOf(maxTilt))
    {
        const ViewCandidate candidate = compare(first, pair.first, second, pair.second, *matcher);
        tried += rotations;
        if (wasTried(candidate))
            continue;
        const bool isRotated = pair.first.isImage() && pair.second.isImage();
        const bool isClear = candidate.support >= (isRotated ? ROTATED : IMMEDIATE);
        if (isClear && tryCandidate(candidate, tried))
            return true;
        if (candidate.support >= LEAST && !isClear)
            others.push_back(candidate);
    }
    std::stable_sort(others.begin(), others.end());
    for (int k = 0; k < std::min((int)others.size(), MOST_TRIED); k++)
        if (tryCandidate(others[k], tried))
            return true;
    return false;
}

}  // namespace

bool isMuchLarger(const ImageViews& first, const ImageViews& second)
{
    return std::max(sideAtPixelsOf(second, first), sideAtPixelsOf(first, second)) >
           MUCH_LARGER * ImageViews::COARSE_SIDE;
}

int searchViews(const ImageViews& first, const ImageViews& second, double maxTilt,
        const std::function<bool(const ViewCandidate&, int)>& tryCandidate)
{
    int tried = 0;
    if (first.size().empty() || second.size().empty())
        return tried;
    if (isMuchLarger(first, second) &&
            search(atPixelsOf(second, first), atPixelsOf(first, second), maxTilt, tryCandidate, tried))
        return tried;
    search({first, ImageViews::COARSE_SIDE}, {second, ImageViews::COARSE_SIDE}, maxTilt, tryCandidate, tried);
    return tried;
}

}  // namespace cv::iib

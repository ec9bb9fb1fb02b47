// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "results.hpp"

namespace cv {
namespace iib {

static DMatch toMatch(const PackedCodes& trains, int query, MatchKey n)
{
    const size_t image = trains.imageOf(indexOf(n));
    return DMatch(query, (int)(indexOf(n) - trains.start(image)), (int)image, (float)distanceOf(n));
}

void toBestMatches(const PackedCodes& trains, const KnnTable& found, std::vector<DMatch>& matches)
{
    matches.clear();
    matches.reserve(found.rows());
    for (int query = 0; query < (int)found.rows(); query++)
        if (found[query][0] != NO_MATCH)
            matches.push_back(toMatch(trains, query, found[query][0]));
}

void addMatches(const PackedCodes& trains, int query, const MatchKey* begin, const MatchKey* end,
        bool compact, std::vector<std::vector<DMatch>>& matches)
{
    if (compact && begin == end)
        return;
    matches.push_back(std::vector<DMatch>());
    matches.back().reserve(end - begin);
    for (; begin != end; ++begin)
        matches.back().push_back(toMatch(trains, query, *begin));
}

void toArrays(const PackedCodes& trains, const KnnTable& found, int k, OutputArray indices_,
        OutputArray distances_, OutputArray imageIndices_)
{
    Mat indices((int)found.rows(), k, CV_32S, Scalar(-1)), distances = indices.clone(),
                                                           images = indices.clone();
    for (int query = 0; query < indices.rows; query++)
        for (int i = 0; i < found.size() && found[query][i] != NO_MATCH; i++)
        {
            const DMatch m = toMatch(trains, query, found[query][i]);
            indices.at<int>(query, i) = m.trainIdx;
            distances.at<int>(query, i) = distanceOf(found[query][i]);
            images.at<int>(query, i) = m.imgIdx;
        }
    indices.copyTo(indices_);
    distances.copyTo(distances_);
    if (imageIndices_.needed())
        images.copyTo(imageIndices_);
}

}  // namespace iib
}  // namespace cv

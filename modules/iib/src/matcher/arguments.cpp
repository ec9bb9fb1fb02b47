// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "arguments.hpp"

namespace cv {
namespace iib {

std::vector<Mat> imagesOf(InputArrayOfArrays descriptors)
{
    std::vector<Mat> images;
    if (descriptors.isMatVector() || descriptors.isUMatVector())
        descriptors.getMatVector(images);
    else
        images.push_back(descriptors.getMat());
    return images;
}

Mat checkedDescriptors(const Mat& descriptors, int width, bool byFirstCodes)
{
    if (descriptors.empty())
        return Mat(0, width, CV_8U);
    if (descriptors.dims != 2 || descriptors.type() != CV_8U)
        CV_Error(Error::StsUnsupportedFormat,
                "Descriptors have to be a matrix of type CV_8U, a row a descriptor");
    if (descriptors.cols != width)
        CV_Error_(Error::StsUnmatchedSizes,
                ("Descriptors have %d columns, but %s %d: %s", descriptors.cols,
                        byFirstCodes ? "the first ones had" : "the level sizes add up to", width,
                        byFirstCodes ? "clear() the matcher before it takes others"
                                     : "create the matcher with the level sizes of these descriptors"));
    return descriptors;
}

std::vector<Mat> checkedMasks(InputArrayOfArrays masks_, int queries, const PackedCodes& index)
{
    std::vector<Mat> masks;
    masks_.getMatVector(masks);
    if (!masks.empty() && masks.size() != index.images())
        CV_Error_(Error::StsBadSize,
                ("%d masks for %d train images: give one for each, empty for \"all allowed\"",
                        (int)masks.size(), (int)index.images()));
    bool any = false;
    for (size_t i = 0; i < masks.size(); i++)
    {
        any = any || !masks[i].empty();
        if (!masks[i].empty() && (masks[i].type() != CV_8UC1 || masks[i].rows != queries ||
                                         (size_t)masks[i].cols != index.rows(i)))
            CV_Error_(Error::StsBadMask,
                    ("masks[%d] has to be CV_8UC1 with %d rows (queries) and %d columns (train "
                     "rows)",
                            (int)i, queries, (int)index.rows(i)));
    }
    return any ? masks : std::vector<Mat>();
}

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

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "input.hpp"

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

int widthOf(const std::vector<Mat>& images)
{
    for (size_t i = 0; i < images.size(); i++)
        if (!images[i].empty())
            return images[i].cols;
    return 0;
}

Mat checkedDescriptors(const Mat& descriptors, int width, bool byFirstCodes)
{
    if (descriptors.empty())
        return Mat(0, width, CV_8U);
    if (descriptors.dims != 2 || descriptors.type() != CV_8U)
        CV_Error(Error::StsUnsupportedFormat,
                "Descriptors have to be a matrix of type CV_8U, a row a descriptor");
    if (descriptors.cols != width && byFirstCodes)
        CV_Error_(Error::StsUnmatchedSizes, ("Descriptors have %d columns, but the first ones had %d: "
                                             "clear() the matcher before it takes "
                                             "others",
                                                    descriptors.cols, width));
    if (descriptors.cols != width)
        CV_Error_(Error::StsUnmatchedSizes,
                ("Descriptors have %d columns, but the level sizes add up to %d: create "
                 "the matcher with the level sizes of these descriptors",
                        descriptors.cols, width));
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

}  // namespace iib
}  // namespace cv

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../common/image_input.hpp"
#include "compute.hpp"

namespace cv {
namespace iib {

std::vector<Mat> extraMaps(InputArrayOfArrays arrays, int expected, Size imageSize)
{
    std::vector<Mat> maps;
    if (arrays.isMat() || arrays.isUMat())
        maps.push_back(arrays.getMat());  // not its rows
    else if (!arrays.empty())
        arrays.getMatVector(maps);
    if ((int)maps.size() != expected)
        CV_Error(Error::StsBadArg,
                format("%d extra channels were given to an extractor of %d; pass computeWithChannels a list "
                       "of maps, also of one, or change setExtraChannels",
                        (int)maps.size(), expected));
    for (size_t i = 0; i < maps.size(); i++)
    {
        const String what = format("extra channel %d", (int)i);
        if (maps[i].dims > 2 || maps[i].channels() != 1)
            CV_Error(Error::StsBadArg, what + format(" has %d channels; it must have 1", maps[i].channels()));
        if (maps[i].size() != imageSize)
            CV_Error(Error::StsUnmatchedSizes,
                    what + format(" is %d x %d; the image is %d x %d", maps[i].cols, maps[i].rows,
                                   imageSize.width, imageSize.height));
        checkPixels(maps[i], what);
    }
    return maps;
}

}  // namespace iib
}  // namespace cv

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "detector_input.hpp"

#include "image_input.hpp"

namespace cv {
namespace iib {

static Mat stretchedTo8Bits(const Mat& map)
{
    double lowest = 0, highest = 0;
    minMaxLoc(map, &lowest, &highest);
    const int first = (int)lowest, range = std::max((int)(highest - lowest), 1);
    Mat result(map.size(), CV_8U);
    for (int y = 0; y < map.rows; y++)
        for (int x = 0; x < map.cols; x++)
            result.at<uchar>(y, x) = (uchar)(((map.at<ushort>(y, x) - first) * 255 + range / 2) / range);
    return result;
}

Mat imageFor(const Feature2D& detector, const Mat& image)
{
    if (image.empty() || dynamic_cast<const IIBDescriptorExtractor*>(&detector) ||
            dynamic_cast<const NormalizedDetector*>(&detector) ||
            dynamic_cast<const HessianDetector*>(&detector))
        return image;
    checkImage(image);
    if (image.depth() == CV_8U)
        return image;
    return stretchedTo8Bits(integerMap(image, Rect(Point(), image.size())));
}

Mat maskFor(InputArray maskArray, Size imageSize)
{
    const Mat mask = maskArray.getMat();
    if (mask.empty())
        return mask;
    if (mask.type() != CV_8U || mask.dims > 2)
        CV_Error(Error::StsUnsupportedFormat,
                "the mask has type " + typeToString(mask.type()) + "; it must be CV_8UC1");
    if (mask.size() != imageSize)
        CV_Error(Error::StsUnmatchedSizes, format("the mask is %d x %d; the image is %d x %d", mask.cols,
                                                   mask.rows, imageSize.width, imageSize.height));
    return mask != 0;
}

}  // namespace iib
}  // namespace cv

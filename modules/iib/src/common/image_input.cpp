// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "image_input.hpp"

namespace cv { namespace iib {

void checkPixels(const Mat& m, const String& what)
{
    if (m.depth() != CV_8U && m.depth() != CV_16U && m.depth() != CV_32F)
        CV_Error(Error::StsUnsupportedFormat,
                what + " has type " + typeToString(m.type()) + "; convert it to 8U, 16U or 32F");
    for (int y = 0; m.depth() == CV_32F && y < m.rows; y++)
    {
        const float* const row = m.ptr<float>(y);
        const int values = m.cols * m.channels();
        int wrong = 0;  // a sum, which compilers vectorize
        for (int i = 0; i < values; i++)
            wrong += !(std::abs(row[i]) <= FLT_MAX);
        if (wrong == 0)
            continue;
        const float* const bad =
                std::find_if(row, row + values, [](float v) { return !(std::abs(v) <= FLT_MAX); });
        CV_Error(Error::StsBadArg,
                what + format(" is NaN or infinite at (%d, %d); replace such pixels (patchNaNs)",
                               (int)(bad - row) / m.channels(), y));
    }
}

void checkImage(const Mat& image)
{
    if (image.dims > 2 || (image.channels() != 1 && image.channels() != 3 && image.channels() != 4))
        CV_Error(Error::StsBadArg,
                format("the image has %d dimensions and %d channels; it must have 2 and 1, 3 or 4",
                        image.dims, image.channels()));
    checkPixels(image, "the image");
}

//! Grey of float pixels, in one fixed order: cvtColor's differs between instruction sets.
static double grey(const float* pixel, int channels)
{
    return channels == 1 ? pixel[0] : 0.114 * pixel[0] + 0.587 * pixel[1] + 0.299 * pixel[2];
}

static Mat quantized(const Mat& image)
{
    double lo = DBL_MAX, hi = -DBL_MAX;
    const int cn = image.channels();
    for (int y = 0; y < image.rows; y++)
        for (int x = 0; x < image.cols; x++)
        {
            const double v = grey(image.ptr<float>(y) + x * cn, cn);
            lo = std::min(lo, v);
            hi = std::max(hi, v);
        }

    Mat result(image.size(), CV_16U);
    const double range = hi > lo ? hi - lo : 1;
    for (int y = 0; y < result.rows; y++)
    {
        const float* src = image.ptr<float>(y);
        // a quotient, not a product with the inverse, so that equal ratios round alike
        for (int x = 0; x < result.cols; x++)
            result.at<ushort>(y, x) = (ushort)cvRound((grey(src + x * cn, cn) - lo) / range * 65535);
    }
    return result;
}

Mat integerMap(const Mat& image)
{
    if (image.depth() == CV_32F)
        return quantized(image);
    if (image.channels() == 1)
        return image;
    return greyOf(image);
}

void checkKeyPoints(const std::vector<KeyPoint>& keypoints, bool withAngles)
{
    for (size_t i = 0; i < keypoints.size(); i++)
    {
        const KeyPoint& kp = keypoints[i];
        const float angle = withAngles ? kp.angle : 0;
        if (!(std::abs(kp.pt.x) <= FLT_MAX && std::abs(kp.pt.y) <= FLT_MAX && std::abs(angle) <= FLT_MAX &&
                    kp.size > 0 && kp.size <= FLT_MAX))
            CV_Error(Error::StsBadArg,
                    format("keypoint %d is at (%g, %g) with size %g and angle %g; all must be "
                           "finite and the size positive",
                            (int)i, kp.pt.x, kp.pt.y, kp.size, kp.angle));
    }
}

Point2d positionOf(const std::vector<KeyPoint>& keypoints, int index, int image)
{
    if (index < 0 || (size_t)index >= keypoints.size())
        CV_Error(Error::StsOutOfRange, format("a match is of keypoint %d of image %d, which has %d", index,
                                               image, (int)keypoints.size()));
    const Point2f pt = keypoints[index].pt;
    if (!(std::abs(pt.x) <= FLT_MAX && std::abs(pt.y) <= FLT_MAX))
        CV_Error(Error::StsBadArg,
                format("keypoint %d is at (%g, %g); positions must be finite", index, pt.x, pt.y));
    return pt;
}

Mat imageFor(const Feature2D& detector, const Mat& image)
{
    if (image.empty() || dynamic_cast<const AnyImage*>(&detector))
        return image;
    checkImage(image);
    if (image.depth() == CV_8U)
        return image;
    const Mat map = integerMap(image);
    double lowest = 0, highest = 0;
    minMaxLoc(map, &lowest, &highest);
    const int first = (int)lowest, range = std::max((int)(highest - lowest), 1);
    Mat result(map.size(), CV_8U);
    for (int y = 0; y < map.rows; y++)
        for (int x = 0; x < map.cols; x++)
            result.at<uchar>(y, x) = (uchar)(((map.at<ushort>(y, x) - first) * 255 + range / 2) / range);
    return result;
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

}}  // namespace cv::iib

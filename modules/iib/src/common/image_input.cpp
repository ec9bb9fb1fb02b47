// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "image_input.hpp"

#include "opencv2/imgproc.hpp"

namespace cv {
namespace iib {

void checkPixels(const Mat& m, const String& what)
{
    if (m.depth() != CV_8U && m.depth() != CV_16U && m.depth() != CV_32F)
        CV_Error(Error::StsUnsupportedFormat,
                what + " has type " + typeToString(m.type()) + "; convert it to 8U, 16U or 32F");
    Point bad;
    if (m.depth() == CV_32F && !checkRange(m, true, &bad))
        CV_Error(Error::StsBadArg,
                what + format(" is NaN or infinite at (%d, %d); replace such pixels (patchNaNs)", bad.x,
                               bad.y));
}

void checkImage(const Mat& image)
{
    if (image.dims > 2 || (image.channels() != 1 && image.channels() != 3 && image.channels() != 4))
        CV_Error(Error::StsBadArg,
                format("the image has %d dimensions and %d channels; it must have 2 and 1, 3 or 4",
                        image.dims, image.channels()));
    checkPixels(image, "the image");
}

//! Colour weights in one fixed order: cvtColor's float code differs between instruction sets.
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
        // a quotient, not a product with the inverse: equal ratios then round alike
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
    Mat result;
    cvtColor(image, result, image.channels() == 3 ? COLOR_BGR2GRAY : COLOR_BGRA2GRAY);
    return result;
}

void checkKeyPoints(const std::vector<KeyPoint>& keypoints)
{
    for (size_t i = 0; i < keypoints.size(); i++)
    {
        const KeyPoint& kp = keypoints[i];
        // written so that NaN fails
        if (!(std::abs(kp.pt.x) <= FLT_MAX && std::abs(kp.pt.y) <= FLT_MAX && std::abs(kp.angle) <= FLT_MAX &&
                    kp.size > 0 && kp.size <= FLT_MAX))
            CV_Error(Error::StsBadArg,
                    format("keypoint %d is at (%g, %g) with size %g and angle %g; all must be "
                           "finite and the size positive",
                            (int)i, kp.pt.x, kp.pt.y, kp.size, kp.angle));
    }
}

}  // namespace iib
}  // namespace cv

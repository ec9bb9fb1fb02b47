// SPDX-License-Identifier: Apache-2.0

#include "exif_orientation.hpp"

#include "../pose/lens.hpp"

namespace cv::iib {
namespace {

//! Two distortion parameters of a model that form a vector in the image.
struct ParameterPair
{
    const char* model;
    size_t x, y;  //!< counted after the principal point
};

const ParameterPair PAIRS[] = {{"OPENCV", 3, 2}, {"FULL_OPENCV", 3, 2}, {"THIN_PRISM_FISHEYE", 3, 2},
        {"THIN_PRISM_FISHEYE", 6, 7}, {"RAD_TAN_THIN_PRISM_FISHEYE", 6, 7},
        {"RAD_TAN_THIN_PRISM_FISHEYE", 8, 10}, {"RAD_TAN_THIN_PRISM_FISHEYE", 9, 11}};

}  // namespace

Upright::Upright(const Size& size, int orientation) : orientation_(orientation), size_(size)
{
    if (orientation < 1 || orientation > 8)
        CV_Error(Error::StsBadArg, format("orientation is %d: it must be one of EXIF, 1 to 8", orientation));
    const double cosine = orientation == 1   ? 1
                          : orientation == 3 ? -1
                                             : 0,
                 sine = orientation == 6   ? 1
                        : orientation == 8 ? -1
                                           : 0;
    fromStored_ = Matx33d(cosine, -sine, 0, sine, cosine, 0, 0, 0, 1);
    if (cosine == sine)
        CV_Error(Error::StsBadArg, format("orientation is %d, of an image stored mirrored, which no camera "
                                          "sees: flip it first, and give 1, 3, 6 or 8",
                                           orientation));
}

Mat Upright::image(const Mat& stored) const
{
    if (orientation_ == 1 || stored.empty())
        return stored;
    Mat upright;
    rotate(stored, upright,
            orientation_ == 3   ? ROTATE_180
            : orientation_ == 6 ? ROTATE_90_CLOCKWISE
                                : ROTATE_90_COUNTERCLOCKWISE);
    return upright;
}

Point2d Upright::storedPixel(const Point2d& upright) const
{
    const Vec3d turned = fromStored_.t() * Vec3d(upright.x, upright.y, 1);
    return {turned[0] + (fromStored_(0, 0) + fromStored_(1, 0) < 0 ? size_.width - 1 : 0),
            turned[1] + (fromStored_(0, 1) + fromStored_(1, 1) < 0 ? size_.height - 1 : 0)};
}

Camera Upright::camera(const Camera& stored) const
{
    Camera upright = stored;
    std::vector<double>& values = upright.parameters;
    const size_t focals = focalsOf(stored.model);
    if (orientation_ == 1 || values.size() < focals + 2)
        return upright;
    if (orientation_ != 3)
    {
        std::swap(upright.size.width, upright.size.height);
        std::swap(values[0], values[focals - 1]);
    }
    const auto turn = [&](size_t x, size_t y) {
        const Vec3d turned = fromStored_ * Vec3d(values[x], values[y], 0);
        values[x] = turned[0];
        values[y] = turned[1];
    };
    for (const ParameterPair& pair : PAIRS)
        if (stored.model == pair.model && std::max(pair.x, pair.y) + focals + 2 < values.size())
            turn(focals + 2 + pair.x, focals + 2 + pair.y);
    turn(focals, focals + 1);  // the principal point, from the corner that becomes the new origin
    values[focals] += fromStored_(0, 0) + fromStored_(0, 1) < 0 ? upright.size.width : 0;
    values[focals + 1] += fromStored_(1, 0) + fromStored_(1, 1) < 0 ? upright.size.height : 0;
    return upright;
}

Camera Camera::upright(int orientation) const { return Upright(size, orientation).camera(*this); }

}  // namespace cv::iib

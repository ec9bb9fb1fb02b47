// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "opencv2/core.hpp"
#include "opencv2/core/affine.hpp"

namespace nb = nanobind;

namespace iib_python {

//! An array of the caller, C-contiguous and of native byte order (as opencv_iib/_arrays.py makes it).
typedef nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu> Array;

//! A numpy array that owns the matrix's memory: rows x columns, or with channels last if there are several.
nb::object toNumpy(const cv::Mat& matrix);

// Types that are passed as arrays. read() returns false for another shape or type, matrixOf() is the array of a value.

//! A view of rows x columns, or with channels last.
bool read(const Array& array, cv::Mat& view);
inline const cv::Mat& matrixOf(const cv::Mat& matrix) { return matrix; }

//! Rows of x, y, size, then optionally angle, then optionally response, octave, class_id, CV_32F; written with all seven.
bool read(const Array& array, std::vector<cv::KeyPoint>& keypoints);
cv::Mat matrixOf(const std::vector<cv::KeyPoint>& keypoints);

//! Rows of queryIdx and trainIdx, CV_32S; written with imgIdx and distance.
bool read(const Array& array, std::vector<cv::DMatch>& matches);
cv::Mat matrixOf(const std::vector<cv::DMatch>& matches);

//! 4 x 4, CV_64F.
bool read(const Array& array, cv::Affine3d& pose);
inline cv::Mat matrixOf(const cv::Affine3d& pose) { return cv::Mat(pose.matrix); }

//! Rows of 2 or 3 coordinates, CV_64F.
template <typename Point> bool read(const Array& array, std::vector<Point>& points)
{
    cv::Mat rows;
    if (!read(array, rows) ||
            (!rows.empty() && (rows.type() != CV_64F || rows.cols != cv::DataType<Point>::channels)))
        return false;
    points.assign(rows.ptr<Point>(), rows.ptr<Point>() + (rows.empty() ? 0 : rows.rows));
    return true;
}

template <typename Point> cv::Mat matrixOf(const std::vector<Point>& points)
{
    return points.empty() ? cv::Mat(0, cv::DataType<Point>::channels, CV_64F)
                          : cv::Mat(points, true).reshape(1, (int)points.size());
}

//! Rows of x, y, size, angle, response, octave, class_id, CV_32F, of objects like cv2.KeyPoint.
cv::Mat readKeyPoints(nb::sequence objects);

//! The system's name of a file, from a str, bytes or os.PathLike; raises Python's own exceptions.
std::string pathOf(nb::handle path);

//! The text of write().
std::string parametersOf(const cv::Algorithm& self);
void setParameters(cv::Algorithm& self, const std::string& text);

//! For functions that need nothing of Python.
typedef nb::call_guard<nb::gil_scoped_release> WithoutGil;

}  // namespace iib_python

namespace nanobind { namespace detail {

//! Converts by read() and matrixOf(); the array lives as long as the call.
template <typename T> struct array_caster
{
    NB_TYPE_CASTER(T, const_name("numpy.typing.NDArray"))

    bool from_python(handle source, uint32_t flags, cleanup_list* cleanup) noexcept
    {
        // No implicit conversion: a view of a converted copy, of an element of a list, would outlive the copy.
        return array.from_python(source, std::is_same<T, cv::Mat>::value ? 0 : flags, cleanup) &&
               iib_python::read(array.value, value);
    }
    static handle from_cpp(const T& value, rv_policy, cleanup_list*) noexcept
    {
        return iib_python::toNumpy(iib_python::matrixOf(value)).release();
    }

private:
    make_caster<iib_python::Array> array;
};

template <> struct type_caster<cv::Mat> : array_caster<cv::Mat>
{
};
template <> struct type_caster<cv::Affine3d> : array_caster<cv::Affine3d>
{
};
template <> struct type_caster<std::vector<cv::KeyPoint>> : array_caster<std::vector<cv::KeyPoint>>
{
};
template <> struct type_caster<std::vector<cv::DMatch>> : array_caster<std::vector<cv::DMatch>>
{
};
template <> struct type_caster<std::vector<cv::Point2d>> : array_caster<std::vector<cv::Point2d>>
{
};
template <> struct type_caster<std::vector<cv::Point3d>> : array_caster<std::vector<cv::Point3d>>
{
};

}}  // namespace nanobind::detail

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

//! What crosses the border: memory of the caller, C-contiguous and native (opencv_iib/_arrays.py sees to that).
typedef nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu> Array;

//! A numpy array that owns the matrix's memory: 2 dimensions, and channels last if there are several.
nb::object toNumpy(const cv::Mat& matrix);

// What stands for arrays, read from them (false for another shape or type, which Python has checked) and written as matrices.

//! A view, of 2 dimensions, or of 3 with the channels last; empty if the array is.
bool read(const Array& array, cv::Mat& view);
inline const cv::Mat& matrixOf(const cv::Mat& matrix) { return matrix; }

//! Rows of x, y, size, and further angle, and further response, octave, class_id, CV_32F; written are all.
bool read(const Array& array, std::vector<cv::KeyPoint>& keypoints);
cv::Mat matrixOf(const std::vector<cv::KeyPoint>& keypoints);

//! Rows of queryIdx and trainIdx, CV_32S; written as queryIdx, trainIdx, imgIdx, distance.
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
                          : cv::Mat(points, true).reshape(1);
}

//! Reads the attributes of objects like cv2.KeyPoint, of any cv2 or none: x, y, size, angle, response, octave, class_id, CV_32F.
cv::Mat readKeyPoints(nb::sequence objects);

//! A file's name as the system has it, of a str, bytes or os.PathLike. What is none raises Python's own exceptions.
std::string pathOf(nb::handle path);

//! What write() tells, as text.
std::string parametersOf(const cv::Algorithm& self);
void setParameters(cv::Algorithm& self, const std::string& text);

//! Of functions that need nothing of Python.
typedef nb::call_guard<nb::gil_scoped_release> WithoutGil;

}  // namespace iib_python

namespace nanobind {
namespace detail {

//! Of what read() and matrixOf() are for; the array lives as long as the call.
template <typename T> struct array_caster
{
    NB_TYPE_CASTER(T, const_name("numpy.typing.NDArray"))

    bool from_python(handle source, uint32_t flags, cleanup_list* cleanup) noexcept
    {
        // A view of a converted copy, an element of a list, would outlive it.
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

}  // namespace detail
}  // namespace nanobind

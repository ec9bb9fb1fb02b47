// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "opencv2/core.hpp"

namespace nb = nanobind;

namespace nanobind {
namespace detail {

//! OpenCV's pointers are shared ones.
template <typename T> struct type_caster<cv::Ptr<T>>
{
    typedef make_caster<std::shared_ptr<T>> Shared;
    NB_TYPE_CASTER(cv::Ptr<T>, make_caster<T>::Name)

    bool from_python(handle source, uint32_t flags, cleanup_list* cleanup) noexcept
    {
        Shared shared;
        const bool known = shared.from_python(source, flags, cleanup);
        value = cv::Ptr<T>(shared.value);
        return known;
    }
    static handle from_cpp(const cv::Ptr<T>& pointer, rv_policy policy, cleanup_list* cleanup) noexcept
    {
        return Shared::from_cpp(static_cast<const std::shared_ptr<T>&>(pointer), policy, cleanup);
    }
};

}  // namespace detail
}  // namespace nanobind

namespace iib_python {

//! What crosses the border: memory of the caller, C-contiguous and native (opencv_iib/_arrays.py sees to that).
typedef nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu> Array;

//! A view of an array of 2 (one channel) or 3 dimensions (channels last). It is empty if the array is, of any dimensions.
//! @throws cv::Exception that names `what` for another number of dimensions or a type that a Mat has not.
cv::Mat viewOf(const Array& array, const char* what);

std::vector<cv::Mat> viewsOf(const std::vector<Array>& arrays, const char* what);

//! A file's name as the system has it, of a str, bytes or os.PathLike. What is none raises Python's own exceptions.
std::string pathOf(nb::handle path);

//! A numpy array that owns the matrix's memory. The matrix has one channel and is continuous.
nb::object toNumpy(const cv::Mat& matrix);

//! What write() tells, as text in the format of a file with this extension.
std::string parametersOf(const cv::Algorithm& self, const std::string& extension = ".json");
void setParameters(cv::Algorithm& self, const std::string& text);

//! Queries that are searched at once: with a million codes, less than a second on one core.
static constexpr int BLOCK = 512;

//! Calls `find(range)` for blocks of so many of the rows, at least once, without the GIL; Ctrl-C acts between two.
template <typename Find> void inBlocks(int rows, int size, Find find)
{
    int first = 0;
    do
    {
        const cv::Range block(first, std::min(first + size, rows));
        {
            nb::gil_scoped_release release;
            find(block);
        }
        first = block.end;
        if (PyErr_CheckSignals() != 0)
            throw nb::python_error();
    } while (first < rows);
}

}  // namespace iib_python

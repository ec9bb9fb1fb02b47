// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

namespace iib_python {

namespace {

// Plain calls of the C API: through nb::object each attribute costs twice as much, and an integer as a float makes another
// object.

//! @param value a new reference, or null after an error.
float number(PyObject* value)
{
    if (!value)
        throw nb::python_error();
    const double result = PyLong_CheckExact(value) ? PyLong_AsDouble(value) : PyFloat_AsDouble(value);
    Py_DECREF(value);
    if (result == -1 && PyErr_Occurred())
        throw nb::python_error();
    return (float)result;
}

}  // namespace

cv::Mat readKeyPoints(nb::sequence objects)
{
    const nb::object names[] = {nb::str("pt"), nb::str("size"), nb::str("angle"), nb::str("response"),
            nb::str("octave"), nb::str("class_id")};
    const size_t count = nb::len(objects);
    cv::Mat rows((int)count, 7, CV_32F);
    for (size_t i = 0; i < count; i++)
    {
        const nb::object object = objects[i];
        float* row = rows.ptr<float>((int)i);
        const nb::object pt = nb::steal(PyObject_GetAttr(object.ptr(), names[0].ptr()));
        for (int k = 0; k < 2; k++)
            row[k] = number(pt.is_valid() ? PySequence_GetItem(pt.ptr(), k) : nullptr);
        for (int k = 1; k < 6; k++)
            row[k + 1] = number(PyObject_GetAttr(object.ptr(), names[k].ptr()));
    }
    return rows;
}

}  // namespace iib_python

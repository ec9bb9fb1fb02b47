// SPDX-License-Identifier: Apache-2.0

#include "keypoints.hpp"

namespace iib_python {

namespace {

//! An attribute's number. Plain calls of the C API: through nb::object each costs twice as much, and an integer as a
//! float makes another object.
float number(PyObject* object, PyObject* name)
{
    PyObject* const value = PyObject_GetAttr(object, name);
    if (!value)
        throw nb::python_error();
    const double result = PyLong_CheckExact(value) ? PyLong_AsDouble(value) : PyFloat_AsDouble(value);
    Py_DECREF(value);
    if (result == -1 && PyErr_Occurred())
        throw nb::python_error();
    return (float)result;
}

void readPoint(PyObject* object, PyObject* name, float* xy)
{
    PyObject* const pt = PyObject_GetAttr(object, name);
    if (!pt)
        throw nb::python_error();
    const nb::object owner = nb::steal(pt);
    if (PyTuple_Check(pt) && PyTuple_Size(pt) == 2)
        for (int i = 0; i < 2; i++)
            xy[i] = (float)PyFloat_AsDouble(PyTuple_GetItem(pt, i));
    else
        for (int i = 0; i < 2; i++)
            xy[i] = nb::cast<float>(owner[i]);
    if (PyErr_Occurred())
        throw nb::python_error();
}

}  // namespace

cv::Mat readKeyPoints(nb::sequence objects)
{
    const nb::object names[] = {nb::str("pt"), nb::str("size"), nb::str("angle"), nb::str("response"),
            nb::str("octave"), nb::str("class_id")};
    const size_t count = nb::len(objects);
    cv::Mat rows((int)count, KEYPOINT_COLUMNS, CV_32F);
    for (size_t i = 0; i < count; i++)
    {
        const nb::object object = objects[i];
        float* row = rows.ptr<float>((int)i);
        readPoint(object.ptr(), names[0].ptr(), row);
        for (int k = 1; k < 6; k++)
            row[k + 1] = number(object.ptr(), names[k].ptr());
    }
    return rows;
}

std::vector<cv::KeyPoint> toKeyPoints(const cv::Mat& rows)
{
    if (rows.rows == 0)
        return std::vector<cv::KeyPoint>();
    if (rows.type() != CV_32F || (rows.cols != 3 && rows.cols != 4 && rows.cols != KEYPOINT_COLUMNS))
        CV_Error_(cv::Error::StsBadArg, ("keypoints are objects like cv2.KeyPoint or an array of 3 columns "
                                         "(x, y, size), 4 (and the angle) or "
                                         "7 (and response, octave, class_id), not of %d",
                                                rows.cols));
    std::vector<cv::KeyPoint> keypoints(rows.rows);
    for (int i = 0; i < rows.rows; i++)
    {
        const float* row = rows.ptr<float>(i);
        keypoints[i] = cv::KeyPoint(row[0], row[1], row[2], rows.cols > 3 ? row[3] : -1);
        if (rows.cols == KEYPOINT_COLUMNS)
        {
            keypoints[i].response = row[4];
            keypoints[i].octave = cv::saturate_cast<int>(row[5]);
            keypoints[i].class_id = cv::saturate_cast<int>(row[6]);
        }
    }
    return keypoints;
}

std::vector<cv::DMatch> toMatches(const cv::Mat& pairs)
{
    if (!pairs.empty() && (pairs.type() != CV_32S || pairs.cols != 2))
        CV_Error(cv::Error::StsBadArg,
                "matches are objects like cv2.DMatch or an array of 2 columns of integers "
                "(queryIdx, trainIdx)");
    std::vector<cv::DMatch> matches;
    for (int i = 0; i < pairs.rows; i++)
        matches.push_back(cv::DMatch(pairs.at<int>(i, 0), pairs.at<int>(i, 1), 0));
    return matches;
}

cv::Mat toRows(const std::vector<cv::KeyPoint>& keypoints)
{
    cv::Mat rows((int)keypoints.size(), KEYPOINT_COLUMNS, CV_32F);
    for (size_t i = 0; i < keypoints.size(); i++)
    {
        const cv::KeyPoint& k = keypoints[i];
        const float values[] = {
                k.pt.x, k.pt.y, k.size, k.angle, k.response, (float)k.octave, (float)k.class_id};
        std::copy(values, values + KEYPOINT_COLUMNS, rows.ptr<float>((int)i));
    }
    return rows;
}

}  // namespace iib_python

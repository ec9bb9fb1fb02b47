// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"

namespace iib_python {

namespace {

const struct
{
    nb::dlpack::dtype type;
    int depth;
} DEPTHS[] = {{nb::dtype<uint8_t>(), CV_8U}, {nb::dtype<bool>(), CV_8U}, {nb::dtype<int8_t>(), CV_8S},
        {nb::dtype<uint16_t>(), CV_16U}, {nb::dtype<int16_t>(), CV_16S}, {nb::dtype<int32_t>(), CV_32S},
        {nb::dtype<float>(), CV_32F}, {nb::dtype<double>(), CV_64F}};

constexpr int KEYPOINT_COLUMNS = 7;

//! @param value a new reference, or null after an error. The plain C API takes half the time of nb::object.
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

nb::object toNumpy(const cv::Mat& matrix)
{
    cv::Mat* const owned = new cv::Mat(matrix.isContinuous() ? matrix : matrix.clone());
    const nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<cv::Mat*>(p); });
    const size_t shape[] = {(size_t)matrix.rows, (size_t)matrix.cols, (size_t)matrix.channels()};
    const auto* known = DEPTHS;
    while (known->depth != matrix.depth())
        known++;
    return nb::cast(nb::ndarray<nb::numpy>(
            owned->data, matrix.channels() > 1 ? 3 : 2, shape, owner, nullptr, known->type));
}

bool read(const Array& array, cv::Mat& view)
{
    const size_t dims = array.ndim();
    const size_t rows = dims > 0 ? array.shape(0) : 1, cols = dims > 1 ? array.shape(1) : 1,
                 channels = dims > 2 ? array.shape(2) : 1;
    for (const auto& known : DEPTHS)
        if (known.type == array.dtype() && dims <= 3 && std::max(rows, cols) <= INT_MAX &&
                channels <= CV_CN_MAX)
        {
            const int type = CV_MAKETYPE(known.depth, std::max((int)channels, 1));
            view = array.size() == 0 ? cv::Mat((int)rows, (int)cols, type)
                                     : cv::Mat((int)rows, (int)cols, type, const_cast<void*>(array.data()));
            return true;
        }
    return false;
}

bool read(const Array& array, std::vector<cv::KeyPoint>& keypoints)
{
    cv::Mat rows;
    if (!read(array, rows) || (rows.rows > 0 && (rows.type() != CV_32F || rows.cols < 3)))
        return false;
    keypoints.resize((size_t)rows.rows);
    for (int i = 0; i < rows.rows; i++)
    {
        const float* row = rows.ptr<float>(i);
        cv::KeyPoint& k = keypoints[(size_t)i];
        k = cv::KeyPoint(row[0], row[1], row[2], rows.cols > 3 ? row[3] : -1);
        if (rows.cols == KEYPOINT_COLUMNS)
        {
            k.response = row[4];
            k.octave = cv::saturate_cast<int>(row[5]);
            k.class_id = cv::saturate_cast<int>(row[6]);
        }
    }
    return true;
}

cv::Mat matrixOf(const std::vector<cv::KeyPoint>& keypoints)
{
    cv::Mat rows(0, KEYPOINT_COLUMNS, CV_32F);
    rows.reserve(keypoints.size());
    for (const cv::KeyPoint& k : keypoints)
        rows.push_back(cv::Mat(cv::Matx<float, 1, KEYPOINT_COLUMNS>(
                k.pt.x, k.pt.y, k.size, k.angle, k.response, (float)k.octave, (float)k.class_id)));
    return rows;
}

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

bool read(const Array& array, std::vector<cv::DMatch>& matches)
{
    cv::Mat pairs;
    if (!read(array, pairs) || (!pairs.empty() && (pairs.type() != CV_32S || pairs.cols != 2)))
        return false;
    matches.clear();
    for (int i = 0; i < (pairs.empty() ? 0 : pairs.rows); i++)  // N x 0 is what knnMatch has without matches
        matches.emplace_back(pairs.at<int>(i, 0), pairs.at<int>(i, 1), 0.f);
    return true;
}

cv::Mat matrixOf(const std::vector<cv::DMatch>& matches)
{
    cv::Mat rows(0, 4, CV_32S);
    rows.reserve(matches.size());
    for (const cv::DMatch& m : matches)
        rows.push_back(cv::Mat(cv::Matx<int, 1, 4>(m.queryIdx, m.trainIdx, m.imgIdx, (int)m.distance)));
    return rows;
}

bool read(const Array& array, cv::Affine3d& pose)
{
    cv::Mat matrix;
    if (!read(array, matrix) || matrix.type() != CV_64F || matrix.size() != cv::Size(4, 4))
        return false;
    pose = cv::Affine3d(cv::Matx44d(matrix.ptr<double>()));
    return true;
}

std::string pathOf(nb::handle path)
{
    PyObject* bytes = nullptr;
    if (!PyUnicode_FSConverter(path.ptr(), &bytes))
        throw nb::python_error();
    const nb::bytes name = nb::steal<nb::bytes>(bytes);
    return std::string(name.c_str(), name.size());
}

std::string parametersOf(const cv::Algorithm& self)
{
    cv::FileStorage file(".json", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    self.write(file);
    return file.releaseAndGetString();
}

void setParameters(cv::Algorithm& self, const std::string& text)
{
    self.read(cv::FileStorage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY).root());
}

}  // namespace iib_python

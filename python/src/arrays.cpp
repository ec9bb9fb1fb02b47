// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"

namespace iib_python {

namespace {

int depthOf(nb::dlpack::dtype type)
{
    if (type == nb::dtype<bool>())
        return CV_8U;
    const struct
    {
        nb::dlpack::dtype type;
        int depth;
    } known[] = {{nb::dtype<uint8_t>(), CV_8U}, {nb::dtype<int8_t>(), CV_8S}, {nb::dtype<uint16_t>(), CV_16U},
            {nb::dtype<int16_t>(), CV_16S}, {nb::dtype<int32_t>(), CV_32S}, {nb::dtype<float>(), CV_32F},
            {nb::dtype<double>(), CV_64F}};
    for (const auto& k : known)
        if (k.type == type)
            return k.depth;
    return -1;
}

}  // namespace

cv::Mat viewOf(const Array& array, const char* what)
{
    const size_t dims = array.ndim();
    if (dims > 3 || (dims < 2 && array.size() > 0))
        CV_Error_(cv::Error::StsBadArg,
                ("%s: an array of 2 or 3 dimensions is needed, not %d", what, (int)dims));
    const int depth = depthOf(array.dtype());
    if (depth < 0)
        CV_Error_(cv::Error::StsUnsupportedFormat, ("%s: arrays of %d bits an element, type code %d, are not "
                                                    "supported; convert it to uint8, uint16 "
                                                    "or float32",
                                                           what, array.dtype().bits, array.dtype().code));
    const size_t channels = dims == 3 ? array.shape(2) : 1, cols = dims > 1 ? array.shape(1) : 1;
    if (array.shape(0) > INT_MAX || cols > INT_MAX || channels > CV_CN_MAX)
        CV_Error_(cv::Error::StsBadSize, ("%s: too large, or more than %d channels", what, CV_CN_MAX));
    if (array.size() == 0)
        return cv::Mat((int)array.shape(0), (int)cols, CV_MAKETYPE(depth, std::max((int)channels, 1)));
    return cv::Mat((int)array.shape(0), (int)cols, CV_MAKETYPE(depth, (int)channels),
            const_cast<void*>(array.data()));
}

std::vector<cv::Mat> viewsOf(const std::vector<Array>& arrays, const char* what)
{
    std::vector<cv::Mat> views;
    for (const Array& array : arrays)
        views.push_back(viewOf(array, what));
    return views;
}

std::string parametersOf(const cv::Algorithm& self, const std::string& extension)
{
    cv::FileStorage file("parameters" + extension, cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    self.write(file);
    return file.releaseAndGetString();
}

void setParameters(cv::Algorithm& self, const std::string& text)
{
    self.read(cv::FileStorage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY).root());
}

std::string pathOf(nb::handle path)
{
    PyObject* bytes = nullptr;
    if (!PyUnicode_FSConverter(path.ptr(), &bytes))
        throw nb::python_error();
    const nb::bytes name = nb::steal<nb::bytes>(bytes);
    return std::string(name.c_str(), name.size());
}

nb::object toNumpy(const cv::Mat& matrix)
{
    CV_Assert(matrix.channels() == 1 && (matrix.empty() || matrix.isContinuous()));
    cv::Mat* owned = new cv::Mat(matrix);
    nb::capsule owner(owned, [](void* p) noexcept { delete static_cast<cv::Mat*>(p); });
    const size_t shape[] = {(size_t)matrix.rows, (size_t)matrix.cols};
    switch (matrix.depth())
    {
    case CV_8U: return nb::cast(nb::ndarray<nb::numpy, uint8_t>(owned->data, 2, shape, owner));
    case CV_16U: return nb::cast(nb::ndarray<nb::numpy, uint16_t>(owned->data, 2, shape, owner));
    case CV_32S: return nb::cast(nb::ndarray<nb::numpy, int32_t>(owned->data, 2, shape, owner));
    case CV_64F: return nb::cast(nb::ndarray<nb::numpy, double>(owned->data, 2, shape, owner));
    default:
        CV_Assert(matrix.depth() == CV_32F);
        return nb::cast(nb::ndarray<nb::numpy, float>(owned->data, 2, shape, owner));
    }
}

}  // namespace iib_python

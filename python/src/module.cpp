// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

using namespace iib_python;

NB_MODULE(_core, m)
{
    const nb::object error = nb::steal(PyErr_NewExceptionWithDoc(
            "opencv_iib.error", "A mistake in a call, as cv2.error.", nullptr, nullptr));
    m.attr("error") = error;
    nb::register_exception_translator(
            [](const std::exception_ptr& thrown, void* type) {
                try
                {
                    std::rethrow_exception(thrown);
                }
                catch (const cv::Exception& e)  // what() has paths of the machine that built this
                {
                    // Names of files may be no UTF-8.
                    const nb::object text = nb::steal(PyUnicode_DecodeFSDefault(e.err.c_str()));
                    PyErr_SetObject(static_cast<PyObject*>(type), text.ptr());
                }
            },
            error.ptr());
    nb::set_leak_warnings(false);  // it would warn about objects that other threads hold at the program's end
    bindDetectors(m);
    bindExtractor(m);
    bindMatcher(m);
    bindMappedIndex(m);
    bindFunctions(m);
    bindLocalization(m);
    bindFiles(m);

    m.attr("VERSION") = IIB_VERSION;
    m.attr("OPENCV_VERSION") = CV_VERSION;
    m.def("readKeyPoints", &readKeyPoints);
    m.def("setNumThreads", [](int threads) { cv::setNumThreads(threads); });
    m.def("getNumThreads", [] { return cv::getNumThreads(); });
}

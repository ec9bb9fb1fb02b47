// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include "opencv2/iib_index.hpp"

namespace iib_python {

namespace {

typedef cv::iib::MappedIndex Index;

template <typename T> nb::object arrayOf(std::vector<T>&& values)
{
    std::vector<T>* const kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<1>>(kept->data(), {kept->size()}, owner));
}

//! Rows and distances, one query after another.
nb::tuple search(const Index& self, const cv::Mat& queries, int k, int segment)
{
    std::vector<int64> rows;
    std::vector<int> distances;
    {
        nb::gil_scoped_release release;
        self.knnSearch(queries, k, rows, distances, segment);
    }
    return nb::make_tuple(
            arrayOf(std::vector<int64_t>(rows.begin(), rows.end())), arrayOf(std::move(distances)));
}

}  // namespace

void bindMappedIndex(nb::module_& m)
{
    nb::class_<Index>(m, "MappedIndex")
            .def_static("create",
                    [](nb::object folder, const std::vector<int>& levelSizes) {
                        Index::create(pathOf(folder), levelSizes);
                    })
            .def_static("open",
                    [](nb::object folder) {
                        const std::string name = pathOf(folder);
                        nb::gil_scoped_release release;
                        return Index::open(name);
                    })
            .def("levelSizes", &Index::levelSizes)
            .def("images", &Index::images)
            .def("rows", &Index::rows)
            .def("segments", &Index::segments)
            .def("version", &Index::version)
            .def("imageOf", &Index::imageOf)
            .def("firstRow", &Index::firstRow)
            .def("descriptors", &Index::descriptors)
            .def(
                    "add", [](Index& self, const std::vector<cv::Mat>& images) { self.add(images); },
                    WithoutGil())
            .def("remove", &Index::remove, WithoutGil())
            .def("refresh", &Index::refresh)
            .def("search", &search);
}

}  // namespace iib_python

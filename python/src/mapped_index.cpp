// SPDX-License-Identifier: Apache-2.0

#include "bindings.hpp"
#include "held.hpp"

#include "opencv2/iib_index.hpp"

namespace iib_python {

namespace {

typedef cv::iib::MappedIndex Index;
typedef Held<Index> Self;

template <typename T> nb::object arrayOf(std::vector<T>&& values)
{
    std::vector<T>* const kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<1>>(kept->data(), {kept->size()}, owner));
}

//! Rows and distances, one query after another.
nb::tuple search(const Self& self, const cv::Mat& queries, int k, int segment)
{
    std::vector<int64> rows;
    std::vector<int> distances;
    {
        nb::gil_scoped_release release;
        self->knnSearch(queries, k, rows, distances, segment);
    }
    return nb::make_tuple(
            arrayOf(std::vector<int64_t>(rows.begin(), rows.end())), arrayOf(std::move(distances)));
}

}  // namespace

void bindMappedIndex(nb::module_& m)
{
    nb::class_<Self> cls(m, "MappedIndex");
    sharing(cls);
    cls.def("__init__",
               [](Self* self, nb::object folder) {
                   const std::string name = pathOf(folder);
                   nb::gil_scoped_release release;
                   new (self) Self{Index::open(name)};
               })
            .def_static(
                    "_create",
                    [](nb::object folder, const std::vector<int>& levelSizes) {
                        Index::create(pathOf(folder), levelSizes);
                    },
                    nb::arg().none(), nb::arg())
            .def(
                    "imageOf", [](const Self& self, int64_t row) { return self->imageOf(row); },
                    nb::sig("def imageOf(self, row: typing.SupportsIndex) -> int"), "The image of a row.")
            .def(
                    "firstRow", [](const Self& self, int64_t image) { return self->firstRow(image); },
                    nb::sig("def firstRow(self, image: typing.SupportsIndex) -> int"),
                    "The first row of an image.")
            .def(
                    "descriptors", [](const Self& self, int64_t image) { return self->descriptors(image); },
                    nb::sig("def descriptors(self, image: typing.SupportsIndex) -> "
                            "numpy.typing.NDArray[numpy.uint8]"),
                    "A copy of the descriptors of an image.")
            .def(
                    "_add", [](Self& self, const std::vector<cv::Mat>& images) { self->add(images); },
                    WithoutGil())
            .def(
                    "remove", [](Self& self, const std::vector<int64>& images) { self->remove(images); },
                    WithoutGil(),
                    nb::sig("def remove(self, images: typing.Sequence[typing.SupportsIndex]) -> None"),
                    "Hides images from all searches; their codes stay on the disk.")
            .def("_search", &search);
    method(cls, "refresh", &Index::refresh, "Goes on to the last commit.");
    method(cls, "levelSizes", &Index::levelSizes, "Bytes of each level, coarse first.");
    method(cls, "images", &Index::images, "Images ever added.");
    method(cls, "rows", &Index::rows, "Rows ever added.");
    method(cls, "segments", &Index::segments, "Files of codes, one for each call of add.");
    method(cls, "version", &Index::version, "A number that changes with every commit.");
}

}  // namespace iib_python

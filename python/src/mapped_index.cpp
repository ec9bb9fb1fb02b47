// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include "opencv2/iib_index.hpp"

namespace iib_python {

namespace {

typedef cv::iib::MappedIndex Index;

void add(Index& self, const std::vector<Array>& arrays)
{
    const std::vector<cv::Mat> views = viewsOf(arrays, "descriptors");
    nb::gil_scoped_release release;
    self.add(views);
}

void remove(Index& self, const std::vector<int64_t>& images)
{
    nb::gil_scoped_release release;
    self.remove(std::vector<int64>(images.begin(), images.end()));
}

template <typename T> nb::object matrixOf(std::vector<T>&& values, size_t columns)
{
    std::vector<T>* const kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<2>>(
            kept->data(), {columns ? kept->size() / columns : 0, columns}, owner));
}

nb::tuple search(const Index& self, const Array& queries_, int k, int segment)
{
    const cv::Mat queries = viewOf(queries_, "queries");
    std::vector<int64_t> rows;
    std::vector<int> distances;
    inBlocks(queries.rows, BLOCK, [&](const cv::Range& block) {
        std::vector<int64> foundRows;
        std::vector<int> foundDistances;
        self.knnSearch(queries.rowRange(block), k, foundRows, foundDistances, segment);
        rows.insert(rows.end(), foundRows.begin(), foundRows.end());
        distances.insert(distances.end(), foundDistances.begin(), foundDistances.end());
    });
    return nb::make_tuple(matrixOf(std::move(rows), k), matrixOf(std::move(distances), k));
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
            .def("images", [](const Index& self) { return (int64_t)self.images(); })
            .def("rows", [](const Index& self) { return (int64_t)self.rows(); })
            .def("segments", &Index::segments)
            .def("version", [](const Index& self) { return (uint64_t)self.version(); })
            .def("imageOf", [](const Index& self, int64_t row) { return (int64_t)self.imageOf(row); })
            .def("firstRow", [](const Index& self, int64_t image) { return (int64_t)self.firstRow(image); })
            .def("descriptors",
                    [](const Index& self, int64_t image) { return toNumpy(self.descriptors(image)); })
            .def("add", &add)
            .def("remove", &remove)
            .def("refresh", &Index::refresh)
            .def("search", &search);
}

}  // namespace iib_python

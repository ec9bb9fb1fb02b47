// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "arrays.hpp"
#include "bindings.hpp"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

typedef cv::iib::HierarchicalMatcher Matcher;
typedef std::vector<std::vector<cv::DMatch>> MatchRows;

std::vector<cv::Mat> viewsOf(nb::object arrays, const char* what)
{
    std::vector<cv::Mat> views;
    if (!arrays.is_none())
        for (nb::handle array : arrays)
            views.push_back(array.is_none() ? cv::Mat() : viewOf(nb::cast<Array>(array), what));
    return views;
}

const char DESCRIPTORS[] = "descriptors", MASK[] = "a mask";

// Descriptors without rows of whatever width: nothing to find.
cv::Mat descriptorsOf(const Array& array) { return viewOf(array, DESCRIPTORS); }

//! `type(queryIdx, trainIdx, imgIdx, distance)`, in a tuple of tuples.
nb::object toPython(const MatchRows& rows, nb::handle type)
{
    nb::object result = nb::steal(PyTuple_New((Py_ssize_t)rows.size()));
    if (!result)
        throw nb::python_error();
    for (size_t i = 0; i < rows.size(); i++)
    {
        nb::object row = nb::steal(PyTuple_New((Py_ssize_t)rows[i].size()));
        for (size_t k = 0; k < rows[i].size(); k++)
        {
            const cv::DMatch& m = rows[i][k];
            nb::object match = type(m.queryIdx, m.trainIdx, m.imgIdx, m.distance);
            PyTuple_SetItem(row.ptr(), (Py_ssize_t)k, match.release().ptr());
        }
        PyTuple_SetItem(result.ptr(), (Py_ssize_t)i, row.release().ptr());
    }
    return result;
}

//! Arguments of a search: in the train set given or, if that is None, in those added.
struct Search
{
    const bool inAdded;
    const cv::Mat query, train;
    const std::vector<cv::Mat> masks;

    Search(const Array& queries, nb::object train_, nb::object masks_)
        : inAdded(train_.is_none()), query(descriptorsOf(queries)),
          train(inAdded ? cv::Mat() : descriptorsOf(nb::cast<Array>(train_))), masks(viewsOf(masks_, MASK))
    {
    }

    //! The one mask of the train set given.
    cv::Mat mask() const { return masks.empty() ? cv::Mat() : masks[0]; }
};

nb::object knnMatch(Matcher& self, const Array& queries, nb::object train, int k, nb::object masks,
        bool compact, nb::handle type)
{
    const Search s(queries, train, masks);
    MatchRows rows;
    if (!s.query.empty())
    {
        nb::gil_scoped_release release;
        if (s.inAdded)
            self.knnMatch(s.query, rows, k, s.masks, compact);
        else
            self.knnMatch(s.query, s.train, rows, k, s.mask(), compact);
    }
    return toPython(rows, type);
}

nb::object radiusMatch(Matcher& self, const Array& queries, nb::object train, float maxDistance,
        nb::object masks, bool compact, nb::handle type)
{
    const Search s(queries, train, masks);
    MatchRows rows;
    if (!s.query.empty())
    {
        nb::gil_scoped_release release;
        if (s.inAdded)
            self.radiusMatch(s.query, rows, maxDistance, s.masks, compact);
        else
            self.radiusMatch(s.query, s.train, rows, maxDistance, s.mask(), compact);
    }
    return toPython(rows, type);
}

nb::tuple knnMatchArrays(Matcher& self, const Array& queries, nb::object train, int k, nb::object masks)
{
    const Search s(queries, train, masks);
    cv::Mat indices, distances, images;
    {
        nb::gil_scoped_release release;
        if (s.inAdded)
            self.knnMatchArrays(s.query, indices, distances, k, s.masks, images);
        else
            self.knnMatchArrays(s.query, s.train, indices, distances, k, s.mask());
    }
    for (cv::Mat* matrix : {&indices, &distances, &images})
        if (matrix->empty())
            matrix->create(0, k, CV_32S);
    return s.inAdded ? nb::make_tuple(toNumpy(indices), toNumpy(distances), toNumpy(images))
                     : nb::make_tuple(toNumpy(indices), toNumpy(distances));
}

void add(Matcher& self, const std::vector<Array>& arrays)
{
    std::vector<cv::Mat> copies;  // the matcher refers to what it is given, and Python may free or change it
    for (const Array& array : arrays)
        copies.push_back(descriptorsOf(array).clone());
    nb::gil_scoped_release release;
    self.add(copies);
}

nb::list trainDescriptors(const Matcher& self)
{
    nb::list arrays;
    for (const cv::Mat& descriptors : self.getTrainDescriptors())
        arrays.append(toNumpy(descriptors.clone()));
    return arrays;
}

std::string parameters(const Matcher& self)
{
    cv::FileStorage file(".json", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    self.write(file);
    return file.releaseAndGetString();
}

void setParameters(Matcher& self, const std::string& text)
{
    self.read(cv::FileStorage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY).root());
}

std::shared_ptr<Matcher> create(
        const std::vector<int>& levelSizes, int mode, float threshold, bool crossCheck)
{
    return Matcher::create(levelSizes, mode, threshold, crossCheck);
}

std::shared_ptr<Matcher> loadIndex(const std::string& filename)
{
    nb::gil_scoped_release release;
    return Matcher::loadIndex(filename);
}

void saveIndex(const Matcher& self, const std::string& filename)
{
    nb::gil_scoped_release release;
    self.saveIndex(filename);
}

std::shared_ptr<Matcher> clone(const Matcher& self, bool emptyTrainData)
{
    return self.clone(emptyTrainData).dynamicCast<Matcher>();
}

}  // namespace

void bindMatcher(nb::module_& m)
{
    nb::class_<Matcher>(m, "Matcher")
            .def_static("create", &create)
            .def_static("create", []() -> std::shared_ptr<Matcher> { return Matcher::create(); })
            .def_static("createRecommended",
                    []() -> std::shared_ptr<Matcher> { return Matcher::createRecommended(); })
            .def_static("loadIndex", &loadIndex)
            .def("saveIndex", &saveIndex)
            .def("clone", &clone)
            .def("add", &add)
            .def("clear", [](Matcher& self) { self.clear(); })
            .def("empty", [](const Matcher& self) { return self.empty(); })
            .def("trainDescriptors", &trainDescriptors)
            .def("knnMatch", &knnMatch, nb::arg(), nb::arg().none(), nb::arg(), nb::arg().none(), nb::arg(),
                    nb::arg())
            .def("radiusMatch", &radiusMatch, nb::arg(), nb::arg().none(), nb::arg(), nb::arg().none(),
                    nb::arg(), nb::arg())
            .def("knnMatchArrays", &knnMatchArrays, nb::arg(), nb::arg().none(), nb::arg(), nb::arg().none())
            .def("levelSizes", &Matcher::levelSizes)
            .def("setMode", &Matcher::setMode)
            .def("getMode", &Matcher::getMode)
            .def("setThresholds", &Matcher::setThresholds)
            .def("getThresholds", &Matcher::getThresholds)
            .def("setCrossCheck", &Matcher::setCrossCheck)
            .def("getCrossCheck", &Matcher::getCrossCheck)
            .def("setMaxRatio", &Matcher::setMaxRatio)
            .def("getMaxRatio", &Matcher::getMaxRatio)
            .def("matchCost", &Matcher::matchCost)
            .def("resetCost", &Matcher::resetCost)
            .def("parameters", &parameters)
            .def("setParameters", &setParameters);
}

}  // namespace iib_python

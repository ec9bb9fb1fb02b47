// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

namespace {

typedef cv::iib::HierarchicalMatcher Matcher;

std::vector<cv::Mat> masksOf(nb::object arrays)
{
    std::vector<cv::Mat> views;
    if (!arrays.is_none())
        for (nb::handle array : arrays)
            views.push_back(array.is_none() ? cv::Mat() : viewOf(nb::cast<Array>(array), "a mask"));
    return views;
}

// Descriptors without rows of whatever width: nothing to find.
cv::Mat descriptorsOf(const Array& array) { return viewOf(array, "descriptors"); }

//! A search in the train set given or, if that is None, in those added.
class Search
{
public:
    Search(Matcher& self, const Array& queries, nb::object train, nb::object masks)
        : query_(descriptorsOf(queries)), masks_(masksOf(masks)), searched_(&self)
    {
        if (train.is_none())
            return;
        const std::vector<cv::Mat> given = {descriptorsOf(nb::cast<Array>(train))};
        nb::gil_scoped_release release;
        given_ = self.clone(true).dynamicCast<Matcher>();  // it counts its cost with that of `self`
        given_->add(given);
        searched_ = given_.get();
    }

    bool inAdded() const { return !given_; }

    //! Calls `find(matcher, queries, masks, number of the first query)` for blocks of queries. All queries are one block for a
    //! cross-check, which has to know the others.
    template <typename Find> void inBlocks(Find find) const
    {
        bool whole = searched_->getCrossCheck();
        for (const cv::Mat& mask : masks_)
            whole |= !mask.empty() && mask.rows != query_.rows;  // a mistake, which the matcher tells
        iib_python::inBlocks(query_.rows, whole ? query_.rows : BLOCK, [&](const cv::Range& block) {
            std::vector<cv::Mat> masks;
            for (const cv::Mat& mask : masks_)
                masks.push_back(mask.empty() || whole ? mask : mask.rowRange(block));
            find(*searched_, query_.rowRange(block), masks, block.start);
        });
    }

private:
    const cv::Mat query_;
    const std::vector<cv::Mat> masks_;
    cv::Ptr<Matcher> given_;
    Matcher* searched_;
};

// Rows of four columns: queryIdx, trainIdx, imgIdx, distance.
nb::object radiusMatch(
        Matcher& self, const Array& queries, nb::object train, float maxDistance, nb::object masks)
{
    cv::Mat all(0, 4, CV_32S);
    Search(self, queries, train, masks)
            .inBlocks([&](Matcher& matcher, const cv::Mat& query, const std::vector<cv::Mat>& allowed,
                              int first) {
                std::vector<std::vector<cv::DMatch>> block;
                matcher.radiusMatch(query, block, maxDistance, allowed, true);
                for (const std::vector<cv::DMatch>& row : block)
                    for (const cv::DMatch& m : row)
                        all.push_back(cv::Mat(cv::Matx<int, 1, 4>(
                                m.queryIdx + first, m.trainIdx, m.imgIdx, (int)m.distance)));
            });
    return toNumpy(all);
}

nb::tuple knnMatchArrays(Matcher& self, const Array& queries, nb::object train, int k, nb::object masks)
{
    const Search search(self, queries, train, masks);
    cv::Mat all[3];  // indices, distances, images
    search.inBlocks([&](Matcher& matcher, const cv::Mat& query, const std::vector<cv::Mat>& allowed, int) {
        cv::Mat block[3];
        matcher.knnMatchArrays(query, block[0], block[1], k, allowed, block[2]);
        for (int i = 0; i < 3; i++)
            all[i].push_back(block[i]);
    });
    for (cv::Mat& matrix : all)
        if (matrix.empty())
            matrix.create(0, k, CV_32S);
    return search.inAdded() ? nb::make_tuple(toNumpy(all[0]), toNumpy(all[1]), toNumpy(all[2]))
                            : nb::make_tuple(toNumpy(all[0]), toNumpy(all[1]));
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

cv::Ptr<Matcher> clone(const Matcher& self, bool emptyTrainData)
{
    return self.clone(emptyTrainData).dynamicCast<Matcher>();
}

}  // namespace

void bindMatcher(nb::module_& m)
{
    nb::class_<Matcher>(m, "Matcher")
            .def_static(
                    "create", nb::overload_cast<const std::vector<int>&, int, float, bool>(&Matcher::create))
            .def_static("create", nb::overload_cast<>(&Matcher::create))
            .def_static("createRecommended", &Matcher::createRecommended)
            .def_static(
                    "loadIndex",
                    [](nb::object file) {
                        const std::string name = pathOf(file);
                        nb::gil_scoped_release release;
                        return Matcher::loadIndex(name);
                    },
                    nb::arg().none())
            .def(
                    "saveIndex",
                    [](const Matcher& self, nb::object file) {
                        const std::string name = pathOf(file);
                        nb::gil_scoped_release release;
                        self.saveIndex(name);
                    },
                    nb::arg().none())
            .def("clone", &clone)
            .def("add", &add)
            .def("clear", &Matcher::clear)
            .def("empty", &Matcher::empty)
            .def("getTrainDescriptors", &trainDescriptors)
            .def("radiusMatch", &radiusMatch, nb::arg(), nb::arg().none(), nb::arg(), nb::arg().none())
            .def("knnMatchArrays", &knnMatchArrays, nb::arg(), nb::arg().none(), nb::arg(), nb::arg().none())
            .def("levelSizes", &Matcher::levelSizes)
            .def_prop_rw("mode", &Matcher::getMode, &Matcher::setMode)
            .def("setThresholds", &Matcher::setThresholds)
            .def("getThresholds", &Matcher::getThresholds)
            .def_prop_rw("crossCheck", &Matcher::getCrossCheck, &Matcher::setCrossCheck)
            .def_prop_rw("maxRatio", &Matcher::getMaxRatio, &Matcher::setMaxRatio)
            .def("matchCost", &Matcher::matchCost)
            .def("resetCost", &Matcher::resetCost)
            .def("parameters", [](const Matcher& self) { return parametersOf(self); })
            .def("setParameters", [](Matcher& self, const std::string& text) { setParameters(self, text); });
}

}  // namespace iib_python

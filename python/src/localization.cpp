// SPDX-License-Identifier: Apache-2.0

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include "arrays.hpp"
#include "bindings.hpp"

#include "opencv2/iib/localization.hpp"

namespace iib_python {

namespace {

using cv::iib::Camera;
using cv::iib::Location;
using cv::iib::MapUpdate;

nb::bytes bytesOf(const std::string& text) { return nb::bytes(text.data(), text.size()); }

//! N x 2 or N x 3 of points.
template <typename Point> nb::object pointsToNumpy(const std::vector<Point>& points)
{
    cv::Mat rows((int)points.size(), cv::DataType<Point>::channels, CV_64F);
    if (!points.empty())
        cv::Mat(points).reshape(1).copyTo(rows);
    return toNumpy(rows);
}

template <typename Point> std::vector<Point> pointsOf(const Array& array)
{
    const cv::Mat rows = viewOf(array, "points");
    CV_Assert(rows.empty() || (rows.type() == CV_64F && rows.cols == cv::DataType<Point>::channels));
    const Point* begin = rows.ptr<Point>();
    return std::vector<Point>(begin, begin + rows.rows);
}

cv::Affine3d poseOf(const Array& array)
{
    const cv::Mat matrix = viewOf(array, "a pose");
    CV_Assert(matrix.type() == CV_64F && matrix.size() == cv::Size(4, 4));
    return cv::Affine3d(cv::Matx44d(matrix.ptr<double>()));
}

nb::object poseToNumpy(const Location& location)
{
    return location.found ? toNumpy(cv::Mat(location.cameraFromWorld.matrix)) : nb::none();
}

nb::object covarianceToNumpy(const Location& location)
{
    return location.found ? toNumpy(cv::Mat(location.covariance)) : nb::none();
}

Location localize(const cv::iib::Localizer& self, const Array& image, const Camera& camera,
        const std::optional<Array>& prior)
{
    const cv::Mat view = viewOf(image, "the image");
    cv::Affine3d pose;
    if (prior)
        pose = poseOf(*prior);
    nb::gil_scoped_release release;
    return self.localize(view, camera, prior ? &pose : nullptr);
}

void buildMap(nb::handle model, const nb::callable& read, nb::handle map, int points, bool lines,
        const nb::callable& report)
{
    const auto image = [&read](const std::string& name) {
        nb::gil_scoped_acquire gil;
        return viewOf(nb::cast<Array>(read(bytesOf(name))), "an image").clone();
    };
    const auto step = [&report](size_t done, size_t all, const std::string& problem) {
        nb::gil_scoped_acquire gil;
        report(done, all, bytesOf(problem));
    };
    const std::string from = pathOf(model), to = pathOf(map);
    nb::gil_scoped_release release;
    cv::iib::MapOptions options(points);
    options.lines = lines;
    cv::iib::buildMap(from, image, to, options, step);
}

//! A name, a camera, a pose and the pixels of keypoints for each image.
void writeModel(nb::handle folder, const std::vector<std::tuple<std::string, Camera, Array, Array>>& images)
{
    std::vector<cv::iib::PosedImage> written;
    for (const auto& [name, camera, pose, pixels] : images)
    {
        written.emplace_back();
        cv::iib::PosedImage& image = written.back();
        image.name = name;
        image.camera = camera;
        image.cameraFromWorld = poseOf(pose);
        image.pixels = pointsOf<cv::Point2d>(pixels);
        image.sees.assign(image.pixels.size(), -1);
    }
    const std::string to = pathOf(folder);
    nb::gil_scoped_release release;
    cv::iib::writeModel(to, written);
}

Location add(MapUpdate& self, const std::string& name, const Array& image, const Camera& camera)
{
    const cv::Mat view = viewOf(image, "the image");
    nb::gil_scoped_release release;
    return self.add(name, view, camera);
}

nb::tuple commit(MapUpdate& self)
{
    MapUpdate::Counts counts;
    {
        nb::gil_scoped_release release;
        counts = self.commit();
    }
    return nb::make_tuple(counts.localized, counts.added, counts.dropped);
}

}  // namespace

void bindLocalization(nb::module_& m)
{
    nb::class_<Camera>(m, "Camera")
            .def_static("parse", &Camera::parse)
            .def_ro("model", &Camera::model)
            .def_prop_ro("width", [](const Camera& self) { return self.size.width; })
            .def_prop_ro("height", [](const Camera& self) { return self.size.height; })
            .def_ro("params", &Camera::parameters)
            .def(
                    "project",
                    [](const Camera& self, const Array& points) {
                        return pointsToNumpy(self.project(pointsOf<cv::Point3d>(points)));
                    },
                    nb::sig("def project(self, points: NDArray, /) -> NDArray"));
    nb::class_<Location>(m, "Location")
            .def_ro("reason", &Location::reason)
            .def_prop_ro(
                    "cam_from_world", &poseToNumpy, nb::sig("def cam_from_world(self) -> NDArray | None"))
            .def_prop_ro("covariance", &covarianceToNumpy, nb::sig("def covariance(self) -> NDArray | None"))
            .def_ro("matches", &Location::matches)
            .def_ro("inliers", &Location::inliers)
            .def_prop_ro(
                    "pixels", [](const Location& self) { return pointsToNumpy(self.pixels); },
                    nb::sig("def pixels(self) -> NDArray"))
            .def_prop_ro(
                    "points", [](const Location& self) { return pointsToNumpy(self.points); },
                    nb::sig("def points(self) -> NDArray"));
    nb::class_<cv::iib::Localizer>(m, "Localizer")
            .def("__init__",
                    [](cv::iib::Localizer* self, nb::handle map, int points, bool lines) {
                        const std::string folder = pathOf(map);
                        nb::gil_scoped_release release;
                        new (self) cv::iib::Localizer(folder, points, lines);
                    })
            .def("cameras", &cv::iib::Localizer::cameras)
            .def("localize", &localize);
    nb::class_<MapUpdate>(m, "MapUpdate")
            .def("__init__",
                    [](MapUpdate* self, nb::handle map, nb::handle out) {
                        const std::string from = pathOf(map), to = pathOf(out);
                        nb::gil_scoped_release release;
                        new (self) MapUpdate(from, to);
                    })
            .def("cameras", &MapUpdate::cameras)
            .def("add", &add)
            .def("commit", &commit);
    m.def("buildMap", &buildMap);
    m.def("writeModel", &writeModel);
}

}  // namespace iib_python

// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include <nanobind/stl/pair.h>

#include "opencv2/iib/localization.hpp"

namespace iib_python {

namespace {

using cv::iib::Camera;
using cv::iib::Localizer;
using cv::iib::Location;
using cv::iib::MapUpdate;
using cv::iib::PosedImage;

nb::bytes bytesOf(const std::string& text) { return nb::bytes(text.data(), text.size()); }

typedef std::pair<std::optional<cv::Affine3d>, std::optional<cv::Mat>> PoseAndCovariance;

//! The arguments of Python's Location.
auto valuesOf(const Location& location)
{
    PoseAndCovariance known;
    if (location.found)
        known = {location.cameraFromWorld, cv::Mat(location.covariance)};
    return std::make_tuple(known.first, known.second, location.reason, location.matches, location.inliers,
            location.pixels, location.points);
}

auto localize(const Localizer& self, const cv::Mat& image, const Camera& camera,
        const std::optional<cv::Affine3d>& prior, int orientation, const cv::Mat& mask)
{
    return valuesOf(self.localize(image, camera, prior ? &*prior : nullptr, orientation, mask));
}

void buildMap(nb::handle model, const nb::callable& read, nb::handle map, int points, bool lines,
        bool orbAndAkaze, int maxSize, const nb::callable& report)
{
    const auto image = [&read](const std::string& name) {
        nb::gil_scoped_acquire gil;
        const nb::object answer = read(bytesOf(name));  // owns the arrays until they are copied
        const auto [pixels, orientation, mask] = nb::cast<std::tuple<cv::Mat, int, cv::Mat>>(answer);
        return cv::iib::Photograph(pixels.clone(), orientation, mask.clone());
    };
    const auto step = [&report](size_t done, size_t all, const std::string& problem) {
        nb::gil_scoped_acquire gil;
        report(done, all, bytesOf(problem));
    };
    const std::string from = pathOf(model), to = pathOf(map);
    nb::gil_scoped_release release;
    cv::iib::MapOptions options(points);
    options.lines = lines;
    options.orbAndAkaze = orbAndAkaze;
    options.maxSize = maxSize;
    cv::iib::buildMap(from, image, to, options, step);
}

void writeModel(nb::handle folder, const std::vector<PosedImage>& images)
{
    const std::string to = pathOf(folder);
    nb::gil_scoped_release release;
    cv::iib::writeModel(to, images);
}

//! @param readings rows of nanoseconds, rate and force, CV_64F.
std::tuple<std::vector<std::optional<cv::Affine3d>>, std::string> smoothPoses(
        const std::vector<int64_t>& times, const std::vector<PoseAndCovariance>& known,
        const cv::Mat& readings, const cv::Affine3d& imuFromCamera)
{
    std::vector<Location> images(known.size());
    for (size_t i = 0; i < known.size(); i++)
        if (known[i].first)
        {
            images[i].found = true;
            images[i].cameraFromWorld = *known[i].first;
            images[i].covariance = cv::Matx66d(known[i].second->ptr<double>());
        }
    std::vector<cv::iib::ImuReading> all;
    for (int i = 0; i < readings.rows; i++)
    {
        const double* const row = readings.ptr<double>(i);
        all.push_back({int64(row[0]), cv::Vec3d(row + 1), cv::Vec3d(row + 4)});
    }
    const std::string reason = cv::iib::smoothPoses({times.begin(), times.end()}, images, all, imuFromCamera);
    std::vector<std::optional<cv::Affine3d>> poses;
    for (const Location& image : images)
        poses.push_back(image.found ? std::make_optional(image.cameraFromWorld) : std::nullopt);
    return {poses, reason};
}

std::tuple<int, int, int> commit(MapUpdate& self)
{
    const MapUpdate::Counts counts = self.commit();
    return {counts.localized, counts.added, counts.dropped};
}

}  // namespace

void bindLocalization(nb::module_& m)
{
    nb::class_<Camera>(m, "Camera")
            .def(nb::init<const Camera&>())
            .def_static("parse", &Camera::parse)
            .def_ro("model", &Camera::model)
            .def_prop_ro("width", [](const Camera& self) { return self.size.width; })
            .def_prop_ro("height", [](const Camera& self) { return self.size.height; })
            .def_ro("params", &Camera::parameters)
            .def("resized",
                    [](const Camera& self, int width, int height) {
                        return self.resized({width, height});
                    })
            .def("upright", &Camera::upright)
            .def("project", &Camera::project)
            .def("undistorted", &Camera::undistorted)
            .def_prop_ro("matrix", [](const Camera& self) { return cv::Mat(self.matrix()); });
    nb::class_<PosedImage>(m, "PosedImage")
            .def("__init__", [](PosedImage* self, const std::string& name, const Camera& camera,
                                     const cv::Affine3d& pose, const std::vector<cv::Point2d>& pixels) {
                new (self) PosedImage{name, camera, pose, pixels, std::vector<int>(pixels.size(), -1)};
            });
    nb::class_<Localizer>(m, "Localizer")
            .def("__init__",
                    [](Localizer* self, nb::handle map, int points, bool lines) {
                        const std::string folder = pathOf(map);
                        nb::gil_scoped_release release;
                        new (self) Localizer(folder, points, lines);
                    })
            .def("cameras", &Localizer::cameras)
            .def("localize", &localize, WithoutGil());
    nb::class_<MapUpdate>(m, "MapUpdate")
            .def("__init__",
                    [](MapUpdate* self, nb::handle map, nb::handle out) {
                        const std::string from = pathOf(map), to = pathOf(out);
                        nb::gil_scoped_release release;
                        new (self) MapUpdate(from, to);
                    })
            .def("cameras", &MapUpdate::cameras)
            .def(
                    "add",
                    [](MapUpdate& self, const std::string& name, const cv::Mat& image, const Camera& camera,
                            int orientation, const cv::Mat& mask) {
                        return valuesOf(self.add(name, image, camera, orientation, mask));
                    },
                    WithoutGil())
            .def("commit", &commit, WithoutGil());
    m.def("buildMap", &buildMap);
    m.def("writeModel", &writeModel);
    m.def("smoothPoses", &smoothPoses, WithoutGil());
}

}  // namespace iib_python

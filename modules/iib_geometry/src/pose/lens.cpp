// SPDX-License-Identifier: Apache-2.0

#include "lens.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>

namespace cv::iib {
namespace {

enum Kind
{
    STRAIGHT,
    POLYNOMIAL,
    FISHEYE,
    FIELD_OF_VIEW,
    THIN_PRISM,
    RAD_TAN_THIN_PRISM,
    DIVISION,
    UNIFIED
};

struct Model
{
    const char* name;
    size_t focals, others;  // numbers of focal lengths, and of parameters after the centre
    Kind kind;
};

//! In the order of COLMAP's numbers.
const Model MODELS[] = {{"SIMPLE_PINHOLE", 1, 0, STRAIGHT}, {"PINHOLE", 2, 0, STRAIGHT},
        {"SIMPLE_RADIAL", 1, 1, POLYNOMIAL}, {"RADIAL", 1, 2, POLYNOMIAL}, {"OPENCV", 2, 4, POLYNOMIAL},
        {"OPENCV_FISHEYE", 2, 4, FISHEYE}, {"FULL_OPENCV", 2, 8, POLYNOMIAL}, {"FOV", 2, 1, FIELD_OF_VIEW},
        {"SIMPLE_RADIAL_FISHEYE", 1, 1, FISHEYE}, {"RADIAL_FISHEYE", 1, 2, FISHEYE},
        {"THIN_PRISM_FISHEYE", 2, 8, THIN_PRISM}, {"RAD_TAN_THIN_PRISM_FISHEYE", 2, 12, RAD_TAN_THIN_PRISM},
        {"SIMPLE_DIVISION", 1, 1, DIVISION}, {"DIVISION", 2, 1, DIVISION}, {"SIMPLE_FISHEYE", 1, 0, FISHEYE},
        {"FISHEYE", 2, 0, FISHEYE}, {"EUCM", 2, 2, UNIFIED}};
constexpr double MAX_RATIO = 1000;  // of a focal length and the longer side
constexpr int ROUNDS = 100;
constexpr int DIRECTIONS = 8, ANGLES = 64;  // of rays that sample a lens's range

//! Parses finite numbers separated by commas; empty if the text holds anything else.
std::vector<double> numbersOf(const std::string& text)
{
    std::istringstream stream(text);  // no std::from_chars: before macOS 26 it reads no numbers with a point
    stream.imbue(std::locale::classic());
    std::vector<double> values;
    do
    {
        double value = 0;
        if (!(stream >> std::noskipws >> value) || !std::isfinite(value))
            return {};
        values.push_back(value);
    } while (stream.get() == ',');
    return stream.eof() ? values : std::vector<double>();
}

[[noreturn]] void fail(const std::string& what) { CV_Error(Error::StsBadArg, what); }

const Model& modelOf(const Camera& camera)
{
    const int number = modelNumber(camera.model);
    if (number < 0)
    {
        std::string names;
        for (const Model& m : MODELS)
            names += (names.empty() ? "" : ", ") + std::string(m.name);
        fail("camera model " + camera.model + " is not one of " + names);
    }
    const Model& model = MODELS[number];
    const std::vector<double>& p = camera.parameters;
    if (p.size() != parametersOf(camera.model))
        fail(format("camera model %s has %d parameters, not %d", model.name, int(parametersOf(camera.model)),
                int(p.size())));
    const double side = std::max(camera.size.width, camera.size.height);
    for (size_t i = 0; i < p.size(); i++)
    {
        const bool focal = i < model.focals, centre = !focal && i < model.focals + 2;
        if (focal && !(p[i] * MAX_RATIO > side && p[i] < MAX_RATIO * side))
            fail("a camera's size and focal length must be positive, and not a thousand times each other");
        if (!std::isfinite(p[i]) || (centre && std::abs(p[i]) > MAX_RATIO * side))
            fail("a camera's parameters must be finite, and its centre not a thousand widths away");
    }
    if (camera.size.empty())
        fail("a camera's size and focal length must be positive");
    return model;
}

}  // namespace

int modelNumber(const std::string& name)
{
    for (size_t i = 0; i < std::size(MODELS); i++)
        if (name == MODELS[i].name)
            return int(i);
    return -1;
}

std::string modelName(uint32_t number)
{
    return number < std::size(MODELS) ? MODELS[number].name : std::to_string(number);
}

size_t parametersOf(const std::string& model)
{
    const int number = modelNumber(model);
    return number < 0 ? 0 : MODELS[number].focals + 2 + MODELS[number].others;
}

size_t focalsOf(const std::string& model)
{
    const int number = modelNumber(model);
    return number < 0 ? 0 : MODELS[number].focals;
}

Lens::Lens(const Camera& camera)
{
    const Model& model = modelOf(camera);
    const double* const p = camera.parameters.data();
    const double *const centre = p + model.focals, *const others = centre + 2;
    matrix_ = {p[0], 0, centre[0] - .5, 0, p[model.focals - 1], centre[1] - .5, 0, 0, 1};
    kind_ = model.kind;
    std::copy(others, others + model.others, k_.val);
    range_ = findRange();
}

//! The formulas are COLMAP's (src/colmap/sensor/models.h); a ray is (x / z, y / z).
Vec2d Lens::distorted(const Vec2d& ray) const
{
    const double r = norm(ray), r2 = r * r;
    const auto shifted = [](const Vec2d& at, double p1, double p2) {
        const double xy = 2 * at[0] * at[1], square = at.dot(at);
        return Vec2d(
                p1 * xy + p2 * (square + 2 * at[0] * at[0]), p2 * xy + p1 * (square + 2 * at[1] * at[1]));
    };
    if (r == 0 || kind_ == STRAIGHT)
        return ray;
    if (kind_ == POLYNOMIAL)
    {
        const double above = 1 + r2 * (k_[0] + r2 * (k_[1] + r2 * k_[4])),
                     below = 1 + r2 * (k_[5] + r2 * (k_[6] + r2 * k_[7]));
        return ray * (above / below) + shifted(ray, k_[2], k_[3]);
    }
    if (kind_ == FIELD_OF_VIEW)
        return k_[0] == 0 ? ray : ray * (std::atan(2 * r * std::tan(k_[0] / 2)) / (r * k_[0]));
    if (kind_ == DIVISION)
        return ray * (2 / (1 + std::sqrt(1 - 4 * k_[0] * r2)));
    if (kind_ == UNIFIED)
        return ray * (1 / (k_[0] * std::sqrt(k_[1] * r2 + 1) + 1 - k_[0]));
    const Vec2d bent = ray * (std::atan(r) / r);  // equidistant
    const double t2 = bent.dot(bent);
    if (kind_ == FISHEYE)
        return bent * (1 + t2 * (k_[0] + t2 * (k_[1] + t2 * (k_[2] + t2 * k_[3]))));
    if (kind_ == THIN_PRISM)
        return bent * (1 + t2 * (k_[0] + t2 * (k_[1] + t2 * (k_[4] + t2 * k_[5])))) +
               shifted(bent, k_[2], k_[3]) + Vec2d(k_[6], k_[7]) * t2;
    const double radial =
            1 + t2 * (k_[0] + t2 * (k_[1] + t2 * (k_[2] + t2 * (k_[3] + t2 * (k_[4] + t2 * k_[5])))));
    const Vec2d at = bent * radial;
    const double s2 = at.dot(at);
    return at + shifted(at, k_[7], k_[6]) + s2 * Vec2d(k_[8] + s2 * k_[9], k_[10] + s2 * k_[11]);
}

//! By central differences.
Matx22d Lens::slope(const Vec2d& ray) const
{
    if (kind_ == STRAIGHT)
        return Matx22d::eye();
    const double step = 1e-5 * (1 + norm(ray));
    const Vec2d x(step, 0), y(0, step), byX = (distorted(ray + x) - distorted(ray - x)) / (2 * step),
                                        byY = (distorted(ray + y) - distorted(ray - y)) / (2 * step);
    return {byX[0], byY[0], byX[1], byY[1]};
}

/** The range ends where the distortion polynomial is largest. Beyond that angle, it would project points back into the image, which
no lens does. Distortion may be asymmetric, so the smallest range of several directions counts. */
double Lens::findRange() const
{
    double range = std::numeric_limits<double>::infinity();
    for (int d = 0; d < DIRECTIONS && kind_ != STRAIGHT; d++)
    {
        const Vec2d direction(std::cos(2 * CV_PI * d / DIRECTIONS), std::sin(2 * CV_PI * d / DIRECTIONS));
        const auto seen = [&](double angle) { return direction.dot(distorted(std::tan(angle) * direction)); };
        const double step = CV_PI / 2 / ANGLES;
        double last = 0;
        for (int k = 1; k < ANGLES && std::tan((k - 1) * step) < range; k++)
        {
            const double next = seen(k * step);
            if (!(next > last))  // the largest lies between k - 2 and k
            {
                double begin = std::max(k - 2, 0) * step, end = k * step;
                while (end - begin > 1e-7)
                {
                    const double a = begin + (end - begin) / 3, b = end - (end - begin) / 3;
                    if (seen(b) > seen(a))
                        begin = a;
                    else
                        end = b;
                }
                range = std::min(range, std::tan(begin));
                break;
            }
            last = next;
        }
    }
    return range;
}

std::vector<Point2d> Lens::undistorted(const std::vector<Point2d>& pixels) const
{
    std::vector<Point2d> straight;
    for (const Point2d& p : pixels)
    {
        const Vec2d seen((p.x - matrix_(0, 2)) / matrix_(0, 0), (p.y - matrix_(1, 2)) / matrix_(1, 1));
        Vec2d ray = seen * std::min(1., .9 * range_ / norm(seen)), step(1, 1);
        const auto errorAt = [&](const Vec2d& at) { return norm(distorted(at) - seen); };
        double error = errorAt(ray);
        for (int round = 0; round < ROUNDS && norm(step) > 1e-12 * (1 + norm(ray)); round++)
        {
            step = slope(ray).inv() * (seen - distorted(ray));
            if (!std::isfinite(norm(step)))  // no ray reaches this pixel
                break;
            double next = errorAt(ray + step);  // Newton's step is shortened until the error falls
            for (; !(next < error && norm(ray + step) <= range_) && norm(step) > 1e-12 * (1 + norm(ray));
                    next = errorAt(ray + step))
                step *= .5;
            if (next < error)
            {
                ray += step;
                error = next;
            }
        }
        if (!(error < 1e-8))
            ray = Vec2d::all(std::numeric_limits<double>::quiet_NaN());
        straight.emplace_back(matrix_(0, 0) * ray[0] + matrix_(0, 2), matrix_(1, 1) * ray[1] + matrix_(1, 2));
    }
    return straight;
}

std::vector<Point2d> Lens::project(const std::vector<Point3d>& points, std::vector<Matx23d>* jacobians) const
{
    std::vector<Point2d> pixels;
    if (jacobians)
        jacobians->clear();
    for (const Point3d& p : points)
    {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        Vec2d ray(p.x / p.z, p.y / p.z);
        if (!(p.z > 0 && norm(ray) <= range_))
            ray = {nan, nan};
        const Vec2d seen = distorted(ray);
        pixels.emplace_back(matrix_(0, 0) * seen[0] + matrix_(0, 2), matrix_(1, 1) * seen[1] + matrix_(1, 2));
        if (jacobians)
            jacobians->push_back(Matx22d(matrix_(0, 0), 0, 0, matrix_(1, 1)) * slope(ray) *
                                 Matx23d(1, 0, -ray[0], 0, 1, -ray[1]) * (1 / p.z));
    }
    return pixels;
}

Camera Camera::parse(const std::string& text)
{
    const size_t comma = std::min(text.find(','), text.size() - 1);
    const std::vector<double> values = numbersOf(text.substr(comma + 1));
    if (values.size() < 3)
        CV_Error(Error::StsBadArg, "camera " + text + " is not MODEL,WIDTH,HEIGHT,PARAMETERS");
    const double width = values[0], height = values[1];
    if (!(width >= 1 && height >= 1 && std::max(width, height) < 1 << 16) || width != std::floor(width) ||
            height != std::floor(height))
        CV_Error(Error::StsBadArg, "camera " + text + ": width and height are whole numbers of pixels");
    const Camera camera = {text.substr(0, comma), Size(int(width), int(height)),
            std::vector<double>(values.begin() + 2, values.end())};
    Lens checked(camera);
    return camera;
}

std::vector<Point2d> Camera::project(const std::vector<Point3d>& points) const
{
    return Lens(*this).project(points);
}

std::vector<Point2d> Camera::undistorted(const std::vector<Point2d>& pixels) const
{
    return Lens(*this).undistorted(pixels);
}

Matx33d Camera::matrix() const { return Lens(*this).matrix(); }

Camera Camera::resized(const Size& to) const
{
    const size_t scaled = modelOf(*this).focals + 2;
    const double scale = double(std::max(to.width, to.height)) / std::max(size.width, size.height);
    if (to.empty() || std::abs(to.width - scale * size.width) > 1 ||
            std::abs(to.height - scale * size.height) > 1)
        fail(format("a camera of %d x %d pixels cannot be resized to %d x %d: give a size of the same shape",
                size.width, size.height, to.width, to.height));
    Camera small = *this;
    small.size = to;
    for (size_t i = 0; i < scaled; i++)
        small.parameters[i] *= scale;
    return small;
}

}  // namespace cv::iib

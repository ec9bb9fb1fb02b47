// SPDX-License-Identifier: Apache-2.0

#include "trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "opencv2/core/quaternion.hpp"

namespace iib_localization {
namespace {

constexpr double MAX_LEVER = 1000;           // metres from an IMU to its camera
constexpr int64_t MAX_TIME = int64_t(4e18);  // nanoseconds: differences of times must not overflow

//! The finite numbers that a text holds, separated by commas; none if it holds anything else.
std::vector<double> numbersOf(const std::string& text)
{
    std::vector<double> values;
    for (const char* at = text.c_str();; at++)
    {
        char* end = nullptr;
        values.push_back(std::strtod(at, &end));
        if (end == at || !std::isfinite(values.back()) || (*end != ',' && end != text.c_str() + text.size()))
            return {};
        if (*end == '\0')
            return values;
        at = end;
    }
}

//! The decimal of the fewest digits, 15 at least but for zeros, that reads back as the same number.
std::string shortest(double value)
{
    std::string text;
    for (int digits = 15; digits <= 17 && (text.empty() || std::strtod(text.c_str(), nullptr) != value);
            digits++)
        text = cv::format("%.*g", digits, value);
    return text;
}

}  // namespace

std::string trajectoryLine(const std::string& name, const cv::Affine3d& cameraFromWorld)
{
    const cv::Matx33d turn = cameraFromWorld.rotation().t();
    const cv::Quatd q = cv::Quatd::createFromRotMat(turn);
    const cv::Vec3d t = -(turn * cameraFromWorld.translation());
    std::string line = name;
    for (double v : {t[0], t[1], t[2], q.x, q.y, q.z, q.w})
        line += " " + shortest(v);
    return line + "\n";
}

cv::Affine3d parsePose(const std::string& text)
{
    std::vector<double> values = numbersOf(text);
    const bool valid = values.size() == 7;
    values.resize(7);
    const cv::Quatd q(values[6], values[3], values[4], values[5]);
    if (!valid || !(std::abs(q.norm() - 1) <= 1e-2) || cv::norm(cv::Vec3d(values.data())) > MAX_LEVER)
        CV_Error(cv::Error::StsBadArg,
                text + " is not tx,ty,tz,qx,qy,qz,qw with a quaternion of length 1 and metres");
    return {q.normalize().toRotMat3x3(), cv::Vec3d(values.data())};
}

std::optional<int64_t> nanoseconds(const std::string& name)
{
    const size_t point = std::min(name.find('.'), name.size());
    const std::string whole = name.substr(0, point), fraction = name.substr(std::min(point + 1, name.size()));
    const auto digits = [](const std::string& s) {
        return s.find_first_not_of("0123456789") == std::string::npos;
    };
    if (whole.empty() || !digits(whole) || !digits(fraction))
        return std::nullopt;
    if (whole.size() >= 15 && whole.size() <= 19 && std::stoull(whole) <= uint64_t(MAX_TIME))
        return std::stoll(whole);
    if (whole.size() > 10)  // neither seconds nor nanoseconds of our time
        return std::nullopt;
    return std::stoll(whole) * 1000000000 + std::stoll((fraction + "000000000").substr(0, 9));
}

std::vector<cv::iib::ImuReading> readImu(const std::string& path)
{
    std::ifstream stream(path);
    if (!stream || stream.peek() == EOF)
        CV_Error(cv::Error::StsError, path + " cannot be opened, or is empty");
    std::vector<cv::iib::ImuReading> readings;
    int number = 0;
    for (std::string line; std::getline(stream, line);)
    {
        number++;
        if (line.empty() || line[0] == '#')
            continue;
        const std::string where = path + ":" + std::to_string(number) + ": ";
        const std::vector<double> values = numbersOf(line.substr(0, line.find('\r')));
        if (values.size() != 7)
            CV_Error(cv::Error::StsError, where + "not a time and six numbers");
        if (std::abs(values[0]) > double(MAX_TIME))
            CV_Error(cv::Error::StsError, where + "the time is not in nanoseconds");
        const int64_t time = int64_t(values[0]);  // to a quarter of a microsecond
        if (!readings.empty() && time <= readings.back().nanoseconds)
            CV_Error(cv::Error::StsError, where + "the time does not rise");
        readings.push_back({time, cv::Vec3d(&values[1]), cv::Vec3d(&values[4])});
    }
    if (readings.empty())
        CV_Error(cv::Error::StsError, path + " has no readings");
    return readings;
}

}  // namespace iib_localization

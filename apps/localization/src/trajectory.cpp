// SPDX-License-Identifier: Apache-2.0

#include "trajectory.hpp"

#include <cmath>

#include "text_file.hpp"

namespace iib_localization {

std::vector<NamedPose> readTrajectory(const std::string& path)
{
    std::vector<NamedPose> poses;
    TextFile file(path);
    while (file.next())
    {
        if (file.size() != 8)
            file.fail(cv::format("%d values, not name tx ty tz qx qy qz qw", int(file.size())));
        NamedPose named{file.word(0), {}};
        named.pose.position = {file.number(1), file.number(2), file.number(3)};
        named.pose.rotation = {file.number(7), file.number(4), file.number(5), file.number(6)};
        if (std::abs(named.pose.rotation.norm() - 1) > 1e-2)
            file.fail("the quaternion's length is not 1");
        named.pose.rotation.normalize();
        poses.push_back(named);
    }
    return poses;
}

void writeTrajectory(const std::string& path, const std::vector<NamedPose>& poses)
{
    std::ofstream stream = createFile(path);
    stream << "# name tx ty tz qx qy qz qw\n";
    for (const auto& [name, pose] : poses)
    {
        stream << name;
        for (double v : pose.position)
            stream << " " << shortest(v);
        for (double v : pose.rotation.coeffs())  // x, y, z, w
            stream << " " << shortest(v);
        stream << "\n";
    }
    finishFile(stream, path);
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
    if (whole.size() >= 15 && whole.size() <= 19 && std::stoull(whole) <= INT64_MAX)
        return std::stoll(whole);
    if (whole.size() > 10)  // neither seconds nor nanoseconds of our time
        return std::nullopt;
    return std::stoll(whole) * 1000000000 + std::stoll((fraction + "000000000").substr(0, 9));
}

const Pose* findPose(const std::vector<NamedPose>& poses, const std::string& name)
{
    const std::optional<int64_t> time = nanoseconds(name);
    const Pose* sameTime = nullptr;
    for (const NamedPose& p : poses)
    {
        if (p.name == name)
            return &p.pose;
        const std::optional<int64_t> other = time ? nanoseconds(p.name) : std::nullopt;
        if (other && std::abs(*other - *time) <= 1000)
            sameTime = &p.pose;
    }
    return sameTime;
}

std::vector<ImuReading> readImu(const std::string& path)
{
    std::vector<ImuReading> readings;
    TextFile file(path, ',');
    while (file.next())
    {
        ImuReading r;
        r.nanoseconds = file.whole(0, 0, INT64_MAX);
        r.rate = {file.number(1), file.number(2), file.number(3)};
        r.force = {file.number(4), file.number(5), file.number(6)};
        if (!readings.empty() && r.nanoseconds <= readings.back().nanoseconds)
            file.fail("the time does not rise");
        readings.push_back(r);
    }
    return readings;
}

}  // namespace iib_localization

// SPDX-License-Identifier: Apache-2.0

#include <iostream>
#include <limits>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "common/command_line.hpp"
#include "focal_check.hpp"
#include "images.hpp"
#include "line_features.hpp"
#include "localizer.hpp"
#include "new_folder.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "smoother.hpp"
#include "text_file.hpp"
#include "trajectory.hpp"

namespace {
using namespace iib_localization;

constexpr int NOTHING_FOUND = 3;  // status

std::string csvHeader()
{
    std::string header = "name,found,reason,matches,inliers,line_inliers,bound_m,bound_deg";
    for (const std::string& stage : Location::stages())
        header += "," + stage + "_ms";
    return header + "\n";
}

std::string csvRow(const std::string& name, const Location& location)
{
    std::string row = cv::format("%s,%d,%s,%d,%d,%d,%.4f,%.4f", name.c_str(), location.found,
            location.reason.c_str(), int(location.matched.size()), int(location.inliers.size()),
            int(location.lineInliers.size()), location.metres, location.degrees);
    for (size_t i = 0; i < Location::stages().size(); i++)
        row += i < location.times.size() ? cv::format(",%.2f", location.times[i]) : ",";
    return row + "\n";
}

//! The image with the points and lines of the map that agree: where they are seen in green, where the pose has them in red.
void writePicture(
        const std::string& path, const cv::Mat& grey, const Location& location, const Camera& camera)
{
    const auto at = [&](const Eigen::Vector2d& p) {
        const Eigen::Vector2d seen = camera.distorted(p);
        return cv::Point(cv::Point2d(seen.x(), seen.y()));
    };
    cv::Mat picture;
    cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
    for (const LineObservation& o : location.lineInliers)
    {
        const Pose& pose = location.estimate.pose;
        const auto mapped = [&](const Eigen::Vector3d& p) {
            return at(camera.pinhole().project(pose.toCamera(p)));
        };
        cv::line(picture, mapped(o.begin), mapped(o.end), {0, 0, 255});
        cv::line(picture, at(o.segment.begin), at(o.segment.end), {0, 200, 0}, 1, cv::LINE_AA);
    }
    for (const Observation& o : location.inliers)
    {
        const cv::Point seen = at(o.pixel);
        const cv::Point mapped = at(camera.pinhole().project(location.estimate.pose.toCamera(o.point)));
        cv::line(picture, seen, mapped, {0, 0, 255});
        cv::circle(picture, seen, 3, {0, 200, 0}, 1, cv::LINE_AA);
    }
    if (!cv::imwrite(path, picture))
        CV_Error(cv::Error::StsError, path + " cannot be written");
}

//! Of the images alone.
std::vector<std::optional<Pose>> posesOf(const std::vector<Location>& locations)
{
    std::vector<std::optional<Pose>> poses;
    for (const Location& location : locations)
        poses.push_back(location.found ? std::optional<Pose>(location.estimate.pose) : std::nullopt);
    return poses;
}

//! In nanoseconds, as the smoother takes them.
std::vector<int64_t> timesOf(const std::vector<ImageFile>& images)
{
    std::vector<int64_t> times;
    for (const ImageFile& image : images)
    {
        const std::optional<int64_t> time = nanoseconds(image.name);
        if (!time || (!times.empty() && *time <= times.back()))
            CV_Error(cv::Error::StsError, image.path + ": with --imu the images must be named by their "
                                                       "times, in seconds or nanoseconds, in order");
        times.push_back(*time);
    }
    return times;
}

std::vector<std::optional<Pose>> withImu(const std::vector<int64_t>& times,
        const std::vector<Location>& locations, const std::vector<ImuReading>& readings,
        const Pinhole& camera)
{
    const std::vector<std::optional<Pose>> poses = posesOf(locations);
    std::vector<VisualFrame> frames;
    for (size_t i = 0; i < times.size(); i++)
        frames.push_back({times[i], poses[i], locations[i].inliers});
    return smooth(camera, frames, readings);
}

//! Keeps the buffers of one image for the next: to give their pages back and to fetch them again takes 40 % of the time.
void keepFreedMemory()
{
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 25);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

int run(const iib_tools::CommandLine& line)
{
    keepFreedMemory();
    for (const char* needed : {"map", "images", "cameras", "out"})
        if (!line.has(needed))
            CV_Error(cv::Error::StsBadArg, cv::format("--%s is needed (--help tells more)", needed));
    const Cameras cameras = readCameras(line.text("cameras"));
    if (cameras.size() != 1)
        CV_Error(cv::Error::StsBadArg, line.text("cameras") + " must have one camera, that of all images");
    const std::vector<ImageFile> images = listImages(line.text("images"));
    const std::vector<NamedPose> priors =
            line.has("prior") ? readTrajectory(line.text("prior")) : std::vector<NamedPose>();
    const bool imu = line.has("imu");
    const std::vector<ImuReading> readings = imu ? readImu(line.text("imu")) : std::vector<ImuReading>();
    const std::vector<int64_t> times = imu ? timesOf(images) : std::vector<int64_t>();
    const Map map = readMap(line.text("map"));
    const Localizer localizer(map, cameras.begin()->second, line.has("no-lines") ? Lines::OFF : Lines::ON);
    if (!line.has("no-lines") && !map.lines.lines.empty() && !linesAvailable())
        std::cerr
                << "the map's lines are not used: this program was built without OpenCV's line_descriptor\n";

    NewFolder results(line.text("out"), {"frames.csv", "trajectory.txt", "*.matches.png"});
    const std::string& out = results.path();
    std::ofstream frames = createFile(out + "/frames.csv");
    frames << csvHeader();
    std::vector<Location> locations;
    FocalCheck focal(cameras.begin()->second.pinhole());
    // As many images at once as there are threads: the steps of one image leave most of them idle.
    const size_t atOnce = size_t(std::max(cv::getNumThreads(), 1));
    for (size_t first = 0; first < images.size(); first = locations.size())
    {
        std::vector<cv::Mat> greys(std::min(atOnce, images.size() - first));
        locations.resize(first + greys.size());
        cv::parallel_for_(cv::Range(0, int(greys.size())), [&](const cv::Range& range) {
            for (size_t i = size_t(range.start); i < size_t(range.end); i++)
            {
                const ImageFile& image = images[first + i];
                greys[i] = cv::imread(image.path, cv::IMREAD_GRAYSCALE);
                locations[first + i] = localizer.locate(greys[i], findPose(priors, image.name));
            }
        });
        for (size_t i = 0; i < greys.size(); i++)
        {
            const std::string& name = images[first + i].name;
            Location& location = locations[first + i];
            if (line.has("pictures") && location.found)
                writePicture(out + "/" + name + ".matches.png", greys[i], location, cameras.begin()->second);
            frames << csvRow(name, location);
            focal.add(location);
            location.matched = {};  // a long run has no room for all
            location.lineInliers = {};
        }
    }
    finishFile(frames, out + "/frames.csv");
    if (const double scale = focal.scale(); scale != 1)
        std::cerr << line.text("cameras") << ": the images fit a focal length " << cv::format("%.3f", scale)
                  << " times as long better: calibrate the camera\n";
    const std::vector<std::optional<Pose>> poses =
            imu ? withImu(times, locations, readings, cameras.begin()->second.pinhole()) : posesOf(locations);

    std::vector<NamedPose> trajectory;
    for (size_t i = 0; i < images.size(); i++)
        if (poses[i])
            trajectory.push_back({images[i].name, *poses[i]});
    writeTrajectory(out + "/trajectory.txt", trajectory);
    results.publish();
    std::cout << trajectory.size() << " of " << images.size() << " images have a pose\n";
    return trajectory.empty() ? NOTHING_FOUND : 0;
}

}  // namespace

int main(int argc, char** argv)
{
    return iib_tools::runTool(argc, argv,
            "Finds where images were taken, in a map that iib_map made.\n"
            "  iib_localize --map MAP --images DIR --cameras cameras.txt --out OUT [--imu imu.csv] "
            "[--no-lines]\n"
            "OUT/trajectory.txt has the poses (TUM's format), OUT/frames.csv what became of each image.\n"
            "The status is 3 if none has a pose.",
            "{map|<none>|the map, a folder}"
            "{images|<none>|folder of the images}"
            "{cameras|<none>|COLMAP's cameras.txt with the camera of all images}"
            "{prior|<none>|TUM's poses: about where the images were taken}"
            "{imu|<none>|EuRoC's imu.csv, in the camera's axes; images must be named by their times}"
            "{no-lines||use points only, also if the map has lines}"
            "{pictures||write each image with the points that agree, as OUT/NAME.matches.png}"
            "{out|<none>|folder for the results; older results there are replaced}",
            run);
}

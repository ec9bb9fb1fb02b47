// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <optional>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "common/command_line.hpp"
#include "images.hpp"
#include "new_folder.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "progress.hpp"
#include "trajectory.hpp"

namespace {
using namespace iib_localization;
using namespace cv::iib;

constexpr int NOTHING_FOUND = 3, SOME_FOUND = 4;  // status

int statusOf(size_t found, size_t all) { return found == all ? 0 : found > 0 ? SOME_FOUND : NOTHING_FOUND; }

//! A field of a CSV file (RFC 4180).
std::string quoted(const std::string& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string result = "\"";
    for (char c : text)
        result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

//! Behind the fifth name, the upper triangle of the covariance.
const char* const CSV_HEADER = "name,found,reason,matches,inliers,x_x,x_y,x_z,x_rx,x_ry,x_rz,y_y,y_z,y_rx,y_"
                               "ry,y_rz,z_z,z_rx,z_ry,z_rz,"
                               "rx_rx,rx_ry,rx_rz,ry_ry,ry_rz,rz_rz\n";

std::string csvRow(const std::string& name, const Location& location)
{
    std::string row =
            quoted(name) + cv::format(",%d,%s,%d,%d", location.found, quoted(location.reason).c_str(),
                                   location.matches, location.inliers);
    for (int i = 0; i < 6; i++)
        for (int k = i; k < 6; k++)
            row += location.found ? cv::format(",%.6g", location.covariance(i, k)) : ",";
    return row + "\n";
}

void write(const std::string& path, const std::string& content)
{
    std::ofstream stream(path, std::ios::binary);
    stream << content << std::flush;
    if (!stream)
        CV_Error(cv::Error::StsError, path + " cannot be written");
}

//! The image with the points of the map that agree: where they are seen in green, where the pose has them in red.
void writePicture(
        const std::string& path, const cv::Mat& grey, const Location& location, const Camera& camera)
{
    cv::Mat picture;
    cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
    std::vector<cv::Point3d> points;
    cv::transform(location.points, points, location.cameraFromWorld.matrix.get_minor<3, 4>(0, 0));
    const std::vector<cv::Point2d> mapped = camera.project(points);
    for (size_t i = 0; i < mapped.size(); i++)
    {
        cv::line(picture, location.pixels[i], mapped[i], {0, 0, 255});
        cv::circle(picture, location.pixels[i], 3, {0, 200, 0}, 1, cv::LINE_AA);
    }
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::vector<uchar> png;
    cv::imencode(".png", picture, png);
    write(path, std::string(png.begin(), png.end()));  // imwrite would not tell of a full disk
}

//! The cameras that images may have; each has that of its size.
std::vector<Camera> chooseCameras(const iib_tools::CommandLine& line, const Localizer& localizer)
{
    return line.has("camera") ? std::vector<Camera>{Camera::parse(line.text("camera"))} : localizer.cameras();
}

//! Localizes an image, reduced if its longer side has more than maxSize pixels (0: as it is); places are in its own pixels.
Location localize(const Localizer& localizer, const cv::Mat& grey, const Camera& camera, int maxSize,
        const cv::Affine3d* prior)
{
    const double scale = double(maxSize) / std::max(grey.cols, grey.rows);
    if (scale == 0 || scale >= 1 || scale * std::min(grey.cols, grey.rows) < 1)
        return localizer.localize(grey, camera, prior);
    cv::Mat small;
    cv::resize(grey, small, cv::Size(), scale, scale, cv::INTER_AREA);
    Location location = localizer.localize(small, camera.resized(small.size()), prior);
    for (cv::Point2d& pixel : location.pixels)  // whose first one has its centre at 0
        pixel = (pixel + cv::Point2d(.5, .5)) / scale - cv::Point2d(.5, .5);
    return location;
}

//! Of an image file; what is wrong with it is the reason. @param camera gets that of the image.
Location locate(const Localizer& localizer, const std::vector<Camera>& cameras, const cv::Mat& grey,
        int maxSize, const cv::Affine3d* prior, Camera& camera)
{
    const auto fits = [&](const Camera& c) { return c.size == grey.size(); };
    const auto found = std::find_if(cameras.begin(), cameras.end(), fits);
    Location location;
    if (grey.empty())
        location.reason = "the image cannot be read";
    else if (found == cameras.end())
        location.reason = cv::format("no camera of %d x %d pixels: give --camera", grey.cols, grey.rows);
    else if (std::any_of(found + 1, cameras.end(), fits))
        location.reason = cv::format(
                "the map has several cameras of %d x %d pixels: give --camera", grey.cols, grey.rows);
    else
    {
        camera = *found;
        location = localize(localizer, grey, camera, maxSize, prior);
    }
    return location;
}

//! A path a line on standard input, a pose a line on standard output.
int stream(const Localizer& localizer, const std::vector<Camera>& cameras, int maxSize)
{
    size_t all = 0, found = 0;
    std::optional<cv::Affine3d> last;
    for (std::string path; std::getline(std::cin, path); all++)
    {
        Camera camera;
        Location location;
        if (path[0] == '#')  // would look like a failure
            location.reason = "a path must not begin with #: write ./ before it";
        else
            location = locate(localizer, cameras, readImage(path), maxSize, last ? &*last : nullptr, camera);
        if (location.found)
            std::cout << trajectoryLine(path, location.cameraFromWorld);
        else
            std::cout << "# " << path << ": " << location.reason << "\n";
        if (!(std::cout << std::flush))
            CV_Error(cv::Error::StsError, "standard output cannot be written");
        last = location.found ? std::optional<cv::Affine3d>(location.cameraFromWorld) : std::nullopt;
        found += location.found;
    }
    return statusOf(found, all);
}

//! In nanoseconds, as the smoother takes them. Puts the names in the order of their times.
std::vector<int64_t> timesOf(std::vector<std::string>& names, const std::vector<ImuReading>& readings)
{
    std::vector<std::pair<int64_t, std::string>> timed;
    for (const std::string& name : names)
    {
        const std::optional<int64_t> time = nanoseconds(withoutExtension(name));
        if (!time)
            CV_Error(cv::Error::StsError,
                    name + ": with --imu the images must be named by their times, in seconds or nanoseconds");
        timed.emplace_back(*time, name);
    }
    std::sort(timed.begin(), timed.end());
    if (timed.back().first < readings.front().nanoseconds ||
            timed.front().first > readings.back().nanoseconds)
        CV_Error(cv::Error::StsError,
                timed.front().second + ": the images' times, in seconds or nanoseconds, are not those of the "
                                       "IMU's readings, in nanoseconds");
    std::vector<int64_t> times;
    for (size_t i = 0; i < timed.size(); i++)
    {
        if (i > 0 && timed[i].first == timed[i - 1].first)
            CV_Error(cv::Error::StsError, timed[i - 1].second + " and " + timed[i].second + " have one time");
        times.push_back(timed[i].first);
        names[i] = timed[i].second;
    }
    return times;
}

//! Keeps the buffers of one image for the next: to give their pages back and to fetch them again takes 40 % of the time.
void keepFreedMemory()
{
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 25);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

//! In the map, or in one of the model. @param points as Localizer takes them.
Localizer open(const iib_tools::CommandLine& line, int points)
{
    MapOptions options;
    options.lines = line.has("lines");
    options.orbAndAkaze = line.has("orb-and-akaze");
    if (line.has("map"))
        return Localizer(line.text("map"), points, options.lines);
    std::optional<Progress> progress;
    const std::string photographs = line.text("photographs");
    return Localizer(
            line.text("model"), [&](const std::string& name) { return readImage(photographs + "/" + name); },
            points,
            [&](size_t, size_t all, const std::string& problem) {
                if (!progress)
                    progress.emplace("mapping", all);
                if (problem.empty())
                    progress->step();
                else
                    std::cerr << problem << "\n";
            },
            options);
}

int run(const iib_tools::CommandLine& line)
{
    keepFreedMemory();
    const bool streaming = line.has("stream");
    if (!line.positional().empty())
        CV_Error(cv::Error::StsBadArg, line.positional()[0] + ": only options are taken (--help lists them)");
    for (const char* option : {"images", "out", "imu", "pictures"})
        if (streaming && line.has(option))
            CV_Error(cv::Error::StsBadArg, cv::format("--stream goes without --%s", option));
    if (line.has("map") == line.has("model") || line.has("model") != line.has("photographs"))
        CV_Error(cv::Error::StsBadArg,
                "either --map or --model and --photographs are needed (--help tells more)");
    for (const char* needed : {"images", "out"})
        if (!line.has(needed) && !streaming)
            CV_Error(cv::Error::StsBadArg, cv::format("--%s is needed (--help tells more)", needed));
    const int maxSize = line.whole("max-size", 0, 1 << 16);
    if (maxSize > 0 && maxSize < 32)
        CV_Error(cv::Error::StsBadArg,
                cv::format("--max-size is %d: at least 32 pixels are needed, or 0", maxSize));
    if (streaming)
    {
        const Localizer localizer = open(line, 1000);
        return stream(localizer, chooseCameras(line, localizer), maxSize);
    }
    const std::string folder = line.text("images");
    std::vector<std::string> names = listImages(folder, line.text("out"));
    const bool imu = line.has("imu");
    const std::vector<ImuReading> readings = imu ? readImu(line.text("imu")) : std::vector<ImuReading>();
    const std::vector<int64_t> times = imu ? timesOf(names, readings) : std::vector<int64_t>();
    const cv::Affine3d imuFromCamera = parsePose(line.text("imu-from-camera"));
    const Localizer localizer = open(line, 0);
    const std::vector<Camera> cameras = chooseCameras(line, localizer);

    NewFolder results(
            line.text("out"), {"frames.csv", "trajectory.txt", "matches/", "matches/*/", "matches/*.png"});
    std::vector<Location> locations(names.size());
    std::vector<std::string> rows(names.size());
    Progress progress("localizing", names.size());
    // Several images at once: the steps of one leave most threads idle.
    cv::parallel_for_(cv::Range(0, int(names.size())), [&](const cv::Range& range) {
        for (size_t i = size_t(range.start); i < size_t(range.end); i++)
        {
            const cv::Mat grey = readImage(folder + "/" + names[i]);
            Camera camera;
            Location location = locate(localizer, cameras, grey, maxSize, nullptr, camera);
            rows[i] = csvRow(names[i], location);
            if (line.has("pictures") && location.found)
                writePicture(results.path() + "/matches/" + names[i] + ".png", grey, location, camera);
            location.pixels.clear();
            location.points.clear();
            locations[i] = location;
            progress.step();
        }
    });
    std::string table = CSV_HEADER, trajectory = "# name tx ty tz qx qy qz qw\n";
    for (const std::string& row : rows)
        table += row;
    if (imu)
        smoothPoses(times, locations, readings, imuFromCamera);
    size_t found = 0;
    for (size_t i = 0; i < names.size(); i++)
        if (locations[i].found)
        {
            trajectory += trajectoryLine(withoutExtension(names[i]), locations[i].cameraFromWorld);
            found++;
        }
    write(results.path() + "/frames.csv", table);
    write(results.path() + "/trajectory.txt", trajectory);
    results.publish();
    std::cout << found << " of " << names.size() << " images have a pose\n";
    return statusOf(found, names.size());
}

}  // namespace

int main(int argc, char** argv)
{
    return iib_tools::runTool(argc, argv,
            "Finds where images were taken, in a map that Python's opencv-iib made, or in a COLMAP model.\n"
            "  iib_localize --map MAP --images DIR --out OUT [--camera MODEL,WIDTH,HEIGHT,PARAMETERS]\n"
            "  iib_localize --model SPARSE --photographs DIR --images DIR --out OUT [--camera ...]\n"
            "  iib_localize --map MAP --stream [--camera ...]\n"
            "OUT/trajectory.txt has the poses (TUM's format), OUT/frames.csv what became of each image.\n"
            "The status is 0 if all have a pose, 4 if some have, 3 if none has.",
            "{map|<none>|the map, a folder}"
            "{model|<none>|in place of --map: COLMAP's model, a folder, which is mapped first}"
            "{photographs|<none>|with --model: folder of the images that it was made of}"
            "{images|<none>|folder of the images}"
            "{camera|<none>|of all images, as COLMAP names models and parameters; without it, the map's of "
            "the same size}"
            "{max-size|0|pixels of the longer side to which larger images are reduced; 0: they are not}"
            "{lines||refine poses by lines too; a --map must have been made with them}"
            "{orb-and-akaze||with --model: the paper's points and bits in place of the recommended ones}"
            "{imu|<none>|EuRoC's imu.csv; images must be named by their times}"
            "{imu-from-camera|0,0,0,0,0,0,1|where the camera is in the IMU's axes: tx,ty,tz,qx,qy,qz,qw}"
            "{pictures||write each image with the points that agree, as OUT/matches/NAME.png}"
            "{stream||read the path of an image a line, and write its pose a line: `PATH tx ty tz qx qy qz "
            "qw`, or "
            "`# PATH: why not`}"
            "{out|<none>|folder for the results; older results there are replaced}",
            run);
}

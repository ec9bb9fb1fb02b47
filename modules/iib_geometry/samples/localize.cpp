// SPDX-License-Identifier: Apache-2.0

/* Localizes images in a map that cv::iib::buildMap or the command `opencv-iib map` made from a COLMAP model:
    localize MAP CAMERA [IMAGE...] > poses.csv
CAMERA is COLMAP's MODEL,WIDTH,HEIGHT,PARAMETERS, or 'map' for the map's only camera. Without images, their names are
read from standard input, one a line, and each is answered at once; the last pose is the prior of the next image.
Status: 0 if all images have a pose, 4 if some have, 3 if none has, 1 for an error and 2 for a wrong command line. */

#include <iostream>
#include <optional>

#include "opencv2/core/quaternion.hpp"
#include "opencv2/iib_geometry.hpp"
#include "opencv2/imgcodecs.hpp"

namespace {

using cv::iib::Camera;
using cv::iib::Localizer;
using cv::iib::Location;

enum Status
{
    ALL_FOUND = 0,
    FAILED = 1,
    MISTAKE = 2,
    NONE_FOUND = 3,
    SOME_FOUND = 4
};

//! The camera given by a text. @throws cv::Exception for another text, and for `map` if the map has several cameras.
Camera cameraOf(const std::string& text, const Localizer& localizer)
{
    if (text != "map")
        return Camera::parse(text);
    const std::vector<Camera> known = localizer.cameras();
    if (known.size() != 1)
        CV_Error(cv::Error::StsBadArg,
                cv::format("the map has %d cameras: give one, as MODEL,WIDTH,HEIGHT,PARAMETERS",
                        int(known.size())));
    return known[0];
}

//! Reads the pixels as stored: like COLMAP, without EXIF's orientation.
cv::Mat readGrey(const std::string& name)
{
    try
    {
        return cv::imread(name, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    }
    catch (const cv::Exception&)  // too many pixels for OpenCV
    {
        return cv::Mat();
    }
}

//! The location of an image, or the reason why there is none.
Location locate(const Localizer& localizer, const Camera& camera, const std::string& name,
        const std::optional<cv::Affine3d>& prior)
{
    const cv::Mat grey = readGrey(name);
    Location location;
    if (grey.empty())
        location.reason = "the image cannot be read";
    else if (grey.size() != camera.size)
        location.reason = cv::format("it has %d x %d pixels, its camera %d x %d", grey.cols, grey.rows,
                camera.size.width, camera.size.height);
    else
        location = localizer.localize(grey, camera, prior ? &*prior : nullptr);
    return location;
}

//! A field of a CSV file (RFC 4180).
std::string quoted(const std::string& text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string result = "\"";
    for (const char c : text)
        result += c == '"' ? "\"\"" : std::string(1, c);
    return result + "\"";
}

const char* const HEADER = "name,found,reason,matches,inliers,tx,ty,tz,qx,qy,qz,qw,deviation";

/** A line of the table: the camera's centre in the map's unit, the quaternion from the camera's axes to the world's,
and the standard deviation of the centre (root of the trace of its covariance). */
std::string row(const std::string& name, const Location& location)
{
    std::string line =
            quoted(name) + cv::format(",%d,%s,%d,%d", location.found, quoted(location.reason).c_str(),
                                   location.matches, location.inliers);
    if (!location.found)
        return line + ",,,,,,,,";
    const cv::Affine3d pose = location.cameraFromWorld.inv();
    const cv::Vec3d centre = pose.translation();
    const cv::Quatd turn = cv::Quatd::createFromRotMat(pose.rotation());
    for (const double value : {centre[0], centre[1], centre[2], turn.x, turn.y, turn.z, turn.w})
        line += cv::format(",%.12g", value);
    const cv::Matx66d& covariance = location.covariance;
    return line + cv::format(",%.3g", std::sqrt(covariance(0, 0) + covariance(1, 1) + covariance(2, 2)));
}

int run(const std::string& map, const std::string& cameraText, const std::vector<std::string>& images)
{
    const bool streaming = images.empty();
    // Single images get as many points as the map's: twice the time, but more poses in difficult illumination.
    const Localizer localizer(map, streaming ? 1000 : 0);
    const Camera camera = cameraOf(cameraText, localizer);
    size_t all = 0, found = 0;
    std::optional<cv::Affine3d> last;
    std::cout << HEADER << std::endl;
    std::string name;
    for (; streaming ? bool(std::getline(std::cin, name)) : all < images.size(); all++)
    {
        if (!streaming)
            name = images[all];
        const Location location = locate(localizer, camera, name, last);
        if (streaming)
            last = location.found ? std::make_optional(location.cameraFromWorld) : std::nullopt;
        found += location.found;
        if (!(std::cout << row(name, location) << std::endl))
            CV_Error(cv::Error::StsError, "standard output cannot be written");
    }
    return found == all ? ALL_FOUND : found > 0 ? SOME_FOUND : NONE_FOUND;
}

}  // namespace

int main(int argc, char** argv)
{
    if (argc < 3)
    {
        std::cerr << "usage: localize MAP CAMERA [IMAGE...] > poses.csv; without images, their names come "
                     "from standard input\n";
        return MISTAKE;
    }
    try
    {
        return run(argv[1], argv[2], {argv + 3, argv + argc});
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "localize: " << e.err << "\n";
        return FAILED;
    }
}

// SPDX-License-Identifier: Apache-2.0

#include "images.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include "opencv2/imgcodecs.hpp"

namespace iib_localization {

namespace fs = std::filesystem;

namespace {

//! Whether a JPEG ends before its end: OpenCV fills what is missing with grey.
bool isCutOff(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const auto byte = [&](size_t i) { return i < bytes.size() ? uchar(bytes[i]) : 0u; };
    size_t at = 2;
    if (byte(0) != 0xff || byte(1) != 0xd8)
        return false;
    while (byte(at) == 0xff && byte(at + 1) != 0xda)  // segments, up to that of the pixels
        at += 2 + (byte(at + 2) << 8 | byte(at + 3));
    return bytes.find("\xff\xd9", at) == std::string::npos;
}

}  // namespace

std::string withoutExtension(const std::string& name) { return fs::path(name).replace_extension().string(); }

cv::Mat readImage(const std::string& path)
{
    std::error_code error;
    if (!fs::is_regular_file(path, error) || isCutOff(path))  // a pipe would not end
        return cv::Mat();
    try
    {
        return cv::imread(path, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
    }
    catch (const cv::Exception&)  // a header that asks for more pixels than OpenCV reads
    {
        return cv::Mat();
    }
}

std::vector<std::string> listImages(const std::string& folder, const std::string& results)
{
    static const std::vector<std::string> extensions = {
            ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp", ".ppm", ".pgm"};
    std::vector<std::string> names;
    std::error_code error;
    for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
    {
        std::error_code unknown;  // of a link that leads to itself
        std::string extension = at->path().extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(), ::tolower);
        if (fs::is_directory(*at, unknown))
        {
            for (const char* suffix : {"", ".iib_partial", ".iib_partial.old"})
                if (!results.empty() && fs::equivalent(*at, results + suffix, unknown))
                    at.disable_recursion_pending();
        }
        else if (std::count(extensions.begin(), extensions.end(), extension) != 0)
            names.push_back(at->path().lexically_relative(folder).string());
    }
    if (error)
        CV_Error(cv::Error::StsError, folder + " or a folder in it cannot be read: " + error.message());
    if (names.empty())
        CV_Error(cv::Error::StsError, folder + " has no images");
    std::sort(names.begin(), names.end());
    std::map<std::string, std::string> files;  // without their extensions
    for (const std::string& name : names)
    {
        if (name[0] == '#' || name.find_first_of("\r\n") != std::string::npos)
            CV_Error(cv::Error::StsError, name + ": rename it, without a leading # and line breaks: a "
                                                 "trajectory cannot hold these");
        const auto [other, isNew] = files.emplace(withoutExtension(name), name);
        if (!isNew)
            CV_Error(cv::Error::StsError,
                    name + " and " + other->second + " would have one pose: rename one of them");
    }
    return names;
}

}  // namespace iib_localization

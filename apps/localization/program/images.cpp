// SPDX-License-Identifier: Apache-2.0

#include "images.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "opencv2/imgcodecs.hpp"

namespace iib_localization {

namespace fs = std::filesystem;

std::string withoutExtension(const std::string& name) { return fs::path(name).replace_extension().string(); }

cv::Mat readImage(const std::string& path)
{
    std::error_code error;
    if (!fs::is_regular_file(path, error))  // a pipe would not end
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

std::vector<std::string> listImages(const std::string& folder)
{
    static const std::vector<std::string> extensions = {
            ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".ppm", ".pgm"};
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::recursive_directory_iterator(folder, error))
    {
        std::string extension = entry.path().extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(), ::tolower);
        if (std::count(extensions.begin(), extensions.end(), extension) != 0 && !entry.is_directory())
            names.push_back(entry.path().lexically_relative(folder).string());
    }
    if (names.empty())
        CV_Error(cv::Error::StsError, folder + (error ? " cannot be read" : " has no images"));
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

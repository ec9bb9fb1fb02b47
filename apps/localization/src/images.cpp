// SPDX-License-Identifier: Apache-2.0

#include "images.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "opencv2/core.hpp"

namespace iib_localization {

std::vector<ImageFile> listImages(const std::string& folder)
{
    static const std::set<std::string> extensions = {
            ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".ppm", ".pgm"};
    std::vector<ImageFile> images;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    {
        std::string extension = entry.path().extension().string();
        std::transform(extension.begin(), extension.end(), extension.begin(), ::tolower);
        if (extensions.count(extension) != 0)
            images.push_back(
                    {entry.path().string(), entry.path().filename().string(), entry.path().stem().string()});
    }
    if (images.empty())
        CV_Error(cv::Error::StsError, folder + (error ? " cannot be read" : " has no images"));
    std::sort(images.begin(), images.end(),
            [](const ImageFile& a, const ImageFile& b) { return a.file < b.file; });
    std::map<std::string, std::string> files;  // by name
    for (const ImageFile& image : images)
    {
        if (image.file[0] == '#' || image.file.find_first_of(" \t\r\n,\"") != std::string::npos)
            CV_Error(cv::Error::StsError,
                    image.path + ": rename it, without blanks, commas, quotes and a leading #: "
                                 "files of poses cannot hold these");
        const auto [other, isNew] = files.emplace(image.name, image.file);
        if (!isNew)
            CV_Error(cv::Error::StsError,
                    image.path + " and " + other->second + " would have one pose: rename one of them");
    }
    return images;
}

}  // namespace iib_localization

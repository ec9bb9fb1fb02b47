// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <fstream>

#include "dataset.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

namespace iib_tools {
namespace {

cv::Mat readExtra(const std::string& imageFile, const std::string& name, cv::Size size)
{
    const size_t start = imageFile.find_last_of('/') + 1;
    const std::string number = imageFile.substr(start, imageFile.find('.', start) - start);
    const std::string file = imageFile.substr(0, start) + name + "/" + number + ".png";
    const cv::Mat map = readImage(file, cv::IMREAD_UNCHANGED);
    if (map.size() != size || map.channels() != 1)
        CV_Error(cv::Error::StsBadSize, file + ": not one channel of the image's size");
    return map;
}

}  // namespace

LoadedPair loadPair(const ImagePair& pair)
{
    LoadedPair loaded;
    loaded.homography =
            pair.homographyFile.empty() ? cv::Matx33d::eye() : readHomography(pair.homographyFile);
    loaded.reference = readImage(pair.referenceFile, cv::IMREAD_GRAYSCALE);
    loaded.target = readImage(pair.targetFile, cv::IMREAD_GRAYSCALE);
    for (const std::string& name : pair.extraNames)
    {
        loaded.referenceExtra[name] = readExtra(pair.referenceFile, name, loaded.reference.size());
        loaded.targetExtra[name] = readExtra(pair.targetFile, name, loaded.target.size());
    }
    return loaded;
}

cv::Matx33d readHomography(const std::string& file)
{
    std::ifstream in(file);
    if (!in)
        CV_Error(cv::Error::StsObjectNotFound, file + ": cannot be read");
    cv::Matx33d H;
    for (double& value : H.val)
        if (!(in >> value) || !std::isfinite(value))
            CV_Error(cv::Error::StsParseError, file + ": not a homography of nine finite numbers");
    std::string rest;
    if (in >> rest)
        CV_Error(cv::Error::StsParseError, file + ": more than nine numbers");
    cv::Matx31d singular;
    cv::SVD::compute(H, singular);
    if (!(singular(2) > 1e-12 * singular(0)))
        CV_Error(cv::Error::StsBadArg, file + ": the homography is singular");
    return H;
}

cv::Mat readImage(const std::string& file, int flags)
{
    cv::Mat image;
    if (cv::utils::fs::exists(file))
        image = cv::imread(file, flags);
    if (image.empty())
        CV_Error(cv::Error::StsObjectNotFound, file + ": not a readable image");
    return image;
}

}  // namespace iib_tools

// SPDX-License-Identifier: Apache-2.0

#include "dataset.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "views.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

std::string join(const std::string& folder, const std::string& name) { return fs::join(folder, name); }

std::string baseName(const std::string& path)
{
    const size_t end = path.find_last_not_of('/');
    const size_t slash = path.find_last_of('/', end);
    return path.substr(slash + 1, end - slash);
}

std::string folderOf(const std::string& path)
{
    const size_t slash = path.find_last_of('/', path.find_last_not_of('/'));
    return slash == std::string::npos ? "." : path.substr(0, slash);
}

Kind kindOf(const std::string& sequence)
{
    static const std::map<std::string, Kind> oxford = {{"bark", "zoom"}, {"boat", "zoom"},
            {"graf", "viewpoint"}, {"wall", "viewpoint"}, {"bikes", "blur"}, {"trees", "blur"},
            {"ubc", "jpeg"}};
    const auto known = oxford.find(sequence);
    if (known != oxford.end())
        return known->second;
    return sequence.compare(0, 2, "v_") == 0 ? "viewpoint" : "light";
}

//! The images `<prefix>k.<extension>` of a folder, by k; empty without k = 1.
std::map<int, std::string> numberedImages(const std::string& folder, const std::string& prefix)
{
    static const std::set<std::string> extensions = {"png", "ppm", "pgm", "jpg", "jpeg", "tif", "tiff"};
    std::vector<cv::String> files;
    fs::glob(folder, prefix + "*", files);
    std::map<int, std::string> images;
    for (const std::string& file : files)
    {
        const std::string name = baseName(file);
        const size_t dot = name.find('.');
        const std::string number = name.substr(prefix.size(), dot - prefix.size());
        if (dot != std::string::npos && extensions.count(name.substr(dot + 1)) && !number.empty() &&
                number.size() <= 6 && number.find_first_not_of("0123456789") == std::string::npos)
            images.insert(std::make_pair(std::atoi(number.c_str()), file));
    }
    return images.count(1) ? images : std::map<int, std::string>();
}

//! Appends the folder's pairs; false if it is no sequence.
bool addSequence(const std::string& folder, std::vector<ImagePair>& pairs)
{
    bool oxford = false;
    std::map<int, std::string> images = numberedImages(folder, "");
    if (images.empty())
    {
        images = numberedImages(folder, "img");
        oxford = true;
    }
    if (images.empty())
        return false;

    ImagePair common;
    common.set = baseName(folderOf(folder));
    common.sequence = baseName(folder);
    common.kind = kindOf(common.sequence);
    common.referenceFile = images[1];
    for (const char* extra : {"depth", "labels"})
        if (fs::exists(join(join(folder, extra), "1.png")))
            common.extraNames.push_back(extra);

    std::vector<cv::String> homographies;
    fs::glob(folder, oxford ? "H1to*" : "H_1_*", homographies);
    for (const auto& image : images)
    {
        if (image.first <= 1)
            continue;
        ImagePair pair = common;
        pair.target = std::to_string(image.first);
        pair.targetFile = image.second;
        if (!homographies.empty())
            pair.homographyFile = join(folder, oxford ? "H1to" + pair.target + "p" : "H_1_" + pair.target);
        pairs.push_back(pair);
    }
    return true;
}

void search(const std::string& folder, int depth, std::vector<ImagePair>& pairs)
{
    const bool isWalk = fs::isDirectory(join(folder, "frames"));  // of tools/synthetic: the camera moves
    if (isWalk || holdsViews(folder) || addSequence(folder, pairs) || depth == 0)
        return;
    std::vector<cv::String> entries;
    fs::glob(folder, "*", entries, false, true);
    std::sort(entries.begin(), entries.end());
    for (const std::string& entry : entries)
        if (fs::isDirectory(entry))
            search(entry, depth - 1, pairs);
}

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

std::string ImagePair::name() const { return set + "/" + sequence + "/" + target; }

std::vector<ImagePair> findPairs(const std::vector<std::string>& roots)
{
    std::vector<ImagePair> pairs;
    for (const std::string& root : roots)
    {
        if (!fs::isDirectory(root))
            CV_Error(cv::Error::StsObjectNotFound, root + ": no such folder");
        search(fs::canonical(root), 4, pairs);
    }
    std::set<std::string> names;
    for (const ImagePair& pair : pairs)
        if (!names.insert(pair.name()).second)
            CV_Error(cv::Error::StsBadArg, "two pairs are called " + pair.name() + "; rename a folder");
    return pairs;
}

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

// SPDX-License-Identifier: Apache-2.0

#include "dataset.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

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

//! Appends the folder's pairs; false if it is not a sequence.
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
    common.set = baseName(fs::getParent(folder));
    common.sequence = baseName(folder);
    common.kind = kindOf(common.sequence);
    common.referenceFile = images[1];
    for (const char* extra : {"depth", "labels"})
        if (fs::exists(fs::join(fs::join(folder, extra), "1.png")))
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
            pair.homographyFile =
                    fs::join(folder, oxford ? "H1to" + pair.target + "p" : "H_1_" + pair.target);
        pairs.push_back(pair);
    }
    return true;
}

void search(const std::string& folder, int depth, const std::function<bool(const std::string&)>& visit)
{
    if (!visit(folder) || depth == 0)
        return;
    std::vector<cv::String> entries;
    fs::glob(folder, "*", entries, false, true);
    std::sort(entries.begin(), entries.end());
    for (const std::string& entry : entries)
        if (fs::isDirectory(entry))
            search(entry, depth - 1, visit);
}

cv::Mat readExtra(const std::string& imageFile, const std::string& name, cv::Size size)
{
    const std::string file = fs::join(fs::getParent(imageFile), name + "/" + stem(imageFile) + ".png");
    const cv::Mat map = readImage(file, cv::IMREAD_UNCHANGED);
    if (map.size() != size || map.channels() != 1)
        CV_Error(cv::Error::StsBadSize, file + ": not one channel of the image's size");
    return map;
}

}  // namespace

std::string ImagePair::name() const { return set + "/" + sequence + "/" + target; }

std::string baseName(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

std::string stem(const std::string& path)
{
    const std::string name = baseName(path);
    return name.substr(0, name.rfind('.'));
}

void visitFolders(const std::vector<std::string>& roots, const std::function<bool(const std::string&)>& visit)
{
    for (const std::string& root : roots)
    {
        if (!fs::isDirectory(root))
            CV_Error(cv::Error::StsObjectNotFound, root + ": no such folder");
        search(fs::canonical(root), 4, visit);
    }
}

bool holdsViews(const std::string& folder)
{
    return fs::exists(fs::join(folder, "cameras.txt")) && fs::exists(fs::join(folder, "poses.txt")) &&
           fs::isDirectory(fs::join(folder, "images"));
}

std::vector<ImagePair> findPairs(const std::vector<std::string>& roots)
{
    std::vector<ImagePair> pairs;
    visitFolders(roots,
            [&](const std::string& folder) { return !holdsViews(folder) && !addSequence(folder, pairs); });
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
    loaded.reference = readImage(pair.referenceFile);
    loaded.target = readImage(pair.targetFile);
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

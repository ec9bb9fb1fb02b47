// SPDX-License-Identifier: Apache-2.0

#include "pair_list.hpp"

#include <fstream>
#include <set>
#include <sstream>

#include "dataset.hpp"
#include "opencv2/core/utils/filesystem.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;

//! Whether K is a camera matrix without skew, since rotating images does not support skew.
bool isCamera(const cv::Matx33d& K)
{
    return K(0, 0) > 0 && K(1, 1) > 0 && K == cv::Matx33d(K(0, 0), 0, K(0, 2), 0, K(1, 1), K(1, 2), 0, 0, 1);
}

//! Whether R is a rotation, up to the rounding of files.
bool isRotation(const cv::Matx33d& R)
{
    return cv::norm(R * R.t() - cv::Matx33d::eye()) < 1e-2 && cv::determinant(R) > 0;
}

bool readPair(const std::string& line, ViewPair& pair)
{
    std::istringstream words(line);
    std::string names[2], rest;
    cv::Matx44d pose;
    words >> names[0] >> names[1] >> pair.referenceTurns >> pair.targetTurns;
    for (cv::Matx33d* camera : {&pair.referenceCamera, &pair.targetCamera})
        for (double& value : camera->val)
            words >> value;
    for (double& value : pose.val)
        words >> value;
    if (!words || words >> rest)
        return false;
    pair.sequence = fs::getParent(names[0]);
    pair.target = names[0] + " " + names[1];
    pair.referenceFile = names[0];
    pair.targetFile = names[1];
    pair.rotation = pose.get_minor<3, 3>(0, 0);
    pair.translation = cv::Vec3d(pose(0, 3), pose(1, 3), pose(2, 3));
    for (int turns : {pair.referenceTurns, pair.targetTurns})
        if (turns < 0 || turns > 3)
            return false;
    return pair.target.find(',') == std::string::npos && isCamera(pair.referenceCamera) &&
           isCamera(pair.targetCamera) && isRotation(pair.rotation) && cv::norm(pair.translation) > 0 &&
           pose.row(3) == cv::Matx14d(0, 0, 0, 1);
}

//! From a camera's axes to those of the camera whose image is rotated a quarter turn counter-clockwise.
const cv::Matx33d QUARTER(0, 1, 0, -1, 0, 0, 0, 0, 1);

//! Rotates an image and its camera by quarter turns counter-clockwise. @return the rotation of the camera's axes.
cv::Matx33d turn(cv::Mat& image, cv::Matx33d& K, int quarters)
{
    cv::Matx33d turned = cv::Matx33d::eye();
    for (; quarters > 0; quarters--)
    {
        K = cv::Matx33d(K(1, 1), 0, K(1, 2), 0, K(0, 0), image.cols - 1 - K(0, 2), 0, 0, 1);
        cv::rotate(image, image, cv::ROTATE_90_COUNTERCLOCKWISE);
        turned = QUARTER * turned;
    }
    return turned;
}

}  // namespace

std::vector<ViewPair> readPairList(const std::string& file, const std::string& folder)
{
    std::ifstream in(file);
    if (!in)
        CV_Error(cv::Error::StsObjectNotFound, file + ": cannot be read");
    std::vector<ViewPair> pairs;
    std::set<std::string> known;
    std::string line;
    while (std::getline(in, line))
    {
        ViewPair pair = ViewPair();
        if (!readPair(line, pair))
            CV_Error(cv::Error::StsParseError,
                    cv::format("%s, line %d: not two images, their turns, cameras and pose, 38 words",
                            file.c_str(), int(pairs.size()) + 1));
        if (!known.insert(pair.target).second)
            CV_Error(cv::Error::StsParseError,
                    cv::format("%s, line %d: the pair is there twice: remove one of them", file.c_str(),
                            int(pairs.size()) + 1));
        pair.set = "list " + baseName(file);
        pair.referenceFile = fs::join(folder, pair.referenceFile);
        pair.targetFile = fs::join(folder, pair.targetFile);
        pairs.push_back(pair);
    }
    return pairs;
}

void turnUpright(ViewPair& pair, cv::Mat& reference, cv::Mat& target)
{
    const cv::Matx33d first = turn(reference, pair.referenceCamera, pair.referenceTurns),
                      second = turn(target, pair.targetCamera, pair.targetTurns);
    pair.rotation = second * pair.rotation * first.t();
    pair.translation = second * pair.translation;
    pair.referenceTurns = pair.targetTurns = 0;
}

}  // namespace iib_tools

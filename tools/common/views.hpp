// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "opencv2/core.hpp"

namespace iib_tools {

//! An image with a known pose.
struct View
{
    std::string name, file;
    cv::Matx33d rotation;  //!< camera to world
    cv::Vec3d position;
};

//! Images under one illumination by one camera.
struct ViewFolder
{
    std::string name;
    cv::Matx33d camera;  //!< focal lengths and centre, pixels
    std::vector<View> views;
};

/** Finds folders in the layout of tools/synthetic/localization.py, up to four levels below the roots. Each has
`cameras.txt` (COLMAP, one PINHOLE camera), `poses.txt` (TUM, camera to world, a name a line) and `images/<name>.png` or
.jpg. Names without an image are left out.
@return the folders by their parent folder.
@throws cv::Exception, with file and line, for broken files. */
std::map<std::string, std::vector<ViewFolder>> findViewFolders(const std::vector<std::string>& roots);

//! Two images of one scene with known poses.
struct ViewPair
{
    std::string set;       //!< name of the views' parent folder
    std::string sequence;  //!< name of the target's folder
    std::string target;    //!< the images' names, joined by a hyphen
    std::string referenceFile, targetFile;
    cv::Matx33d referenceCamera, targetCamera;  //!< focal lengths and centre, pixels
    cv::Matx33d rotation;                       //!< from the reference's axes to the target's
    cv::Vec3d translation;                      //!< likewise; methods under test do not know its length
    bool sameLight;                             //!< whether both images are of one folder

    std::string name() const { return set + "/" + sequence + "/" + target; }
    std::vector<std::string> key() const { return {set, sequence, target}; }  //!< of rows of results
};

//! Whether a folder holds `cameras.txt`, `poses.txt` and `images`.
bool holdsViews(const std::string& folder);

//! The pair of two views.
ViewPair pairOf(
        const std::string& set, const ViewFolder& from, const View& a, const ViewFolder& to, const View& b);

const double DEPTH_STEP = .004;  //!< metres a step of depth images; tools/synthetic/common.inc

//! The depth image of `images/NAME.png`, which may be missing: `depth/NAME.png`.
std::string depthFile(const std::string& imageFile);

/** Finds pairs in the folders of findViewFolders. An image is paired with the next three of its folder. If there is
also a folder `map`, each image of the other folders is instead paired with the map's nearest image at least half a
metre away.
@throws cv::Exception as findViewFolders. */
std::vector<ViewPair> findViewPairs(const std::vector<std::string>& roots);

}  // namespace iib_tools

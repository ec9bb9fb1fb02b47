// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/affine.hpp"

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
    std::string set;       //!< name of the views' parent folder, or of a list of pairs (pair_list.hpp)
    std::string sequence;  //!< name of the target's folder; in a list: of the reference's
    std::string target;    //!< the images' names, joined by a hyphen; in a list: by a blank
    std::string referenceFile, targetFile;
    cv::Matx33d referenceCamera, targetCamera;  //!< focal lengths and centre, pixels
    cv::Matx33d rotation;                       //!< from the reference's axes to the target's
    cv::Vec3d translation;                      //!< likewise; methods under test do not know its length
    bool sameLight;                             //!< whether both images are of one folder
    int referenceTurns, targetTurns;            //!< clockwise quarter turns at which the images were taken

    std::string name() const { return set + "/" + sequence + "/" + target; }
    std::vector<std::string> key() const { return {set, sequence, target}; }  //!< of rows of results
};

//! Whether a folder holds `cameras.txt`, `poses.txt` and `images`.
bool holdsViews(const std::string& folder);

//! A walk by tools/synthetic/render.py: a folder `<scene>_<light>` with `camera.yml`, `frames/k.png` and `depth/k.png`.
struct Walk
{
    std::string folder, scene, light;
    cv::Matx33d camera;               //!< pixels
    double depthScale;                //!< metres a step of depth
    std::vector<cv::Affine3d> poses;  //!< of frames 1, 2, ...: from the world's axes to the camera's, metres

    //! The path of a frame's file, which may be missing. @param kind "frames" or "depth"
    std::string file(const char* kind, int frame) const;
};

/** Finds walks up to four levels below the folders.
@throws cv::Exception for an incomplete camera file. */
std::vector<Walk> findWalks(const std::vector<std::string>& roots);

/** Finds pairs in the folders of findViewFolders. An image is paired with the next three of its folder. If there is
also a folder `map`, each image of the other folders is instead paired with the map's nearest image at least half a
metre away. In the same way, frames of a walk under other light are paired with those at noon; their set is
`walk_<scene>`.
@throws cv::Exception as findViewFolders. */
std::vector<ViewPair> findViewPairs(const std::vector<std::string>& roots);

}  // namespace iib_tools

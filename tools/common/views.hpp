// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/affine.hpp"

namespace iib_tools {

//! An image from a known place.
struct View
{
    std::string name, file;
    cv::Matx33d rotation;  //!< camera to world
    cv::Vec3d position;
};

//! Images of one light and one camera.
struct ViewFolder
{
    std::string name;
    cv::Matx33d camera;  //!< focal lengths and centre, pixels
    std::vector<View> views;
};

/** The folders as tools/synthetic/localization.py writes them, up to four levels below the roots, by what holds them:
`cameras.txt` (COLMAP, one PINHOLE camera), `poses.txt` (TUM, camera to world, a name a line) and `images/<name>.png` or .jpg. Names
without an image are left out.
@throws cv::Exception, with file and line, for a folder whose files are broken. */
std::map<std::string, std::vector<ViewFolder>> findViewFolders(const std::vector<std::string>& roots);

//! Two images of one scene from known places.
struct ViewPair
{
    std::string
            set;  //!< name of the folder that holds the views' folders, or of a list of pairs (pair_list.hpp)
    std::string sequence;  //!< name of the target's folder; of a list: of the reference's
    std::string target;    //!< the images' names, joined by a hyphen; of a list: by a blank
    std::string referenceFile, targetFile;
    cv::Matx33d referenceCamera, targetCamera;  //!< focal lengths and centre, pixels
    cv::Matx33d rotation;                       //!< from the reference's axes to the target's
    cv::Vec3d translation;                      //!< of the same, its length unknown to the methods under test
    bool sameLight;                             //!< whether both images are of one folder
    int referenceTurns, targetTurns;            //!< quarters clockwise that an image was taken turned by
};

//! Whether a folder holds `cameras.txt`, `poses.txt` and `images`.
bool holdsViews(const std::string& folder);

//! A walk as tools/synthetic/render.py writes it: a folder `<scene>_<light>` with `camera.yml`, `frames/k.png` and `depth/k.png`.
struct Walk
{
    std::string folder, scene, light;
    cv::Matx33d camera;               //!< pixels
    double depthScale;                //!< metres a step of depth
    std::vector<cv::Affine3d> poses;  //!< of frames 1, 2, ...: from the world's axes to the camera's, metres

    //! Of the file of a frame, "frames" or "depth", which may be missing.
    std::string file(const char* kind, int frame) const;
};

/** The walks up to four levels below the folders.
@throws cv::Exception for a camera file without what is needed. */
std::vector<Walk> findWalks(const std::vector<std::string>& roots);

/** Finds pairs in the folders of findViewFolders. An image is paired with the next three of its folder; where other folders lie
beside a folder `map`, each of their images is paired with the map's next one at a distance of half a metre or more instead. So are
the frames of a walk in other light with those at noon; their set is `walk_<scene>`.
@throws cv::Exception as findViewFolders. */
std::vector<ViewPair> findViewPairs(const std::vector<std::string>& roots);

}  // namespace iib_tools

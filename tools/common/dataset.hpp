// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "opencv2/core.hpp"

namespace iib_tools {

/** The change between the images of a sequence: "light", "blur", "jpeg", "viewpoint" or "zoom" (with rotation). Derived
from the names of Oxford's sequences and HPatches' prefix `v_`; otherwise "light". */
typedef std::string Kind;

//! A reference image and a target image of the same scene; only loadPair reads the files.
struct ImagePair
{
    std::string set;       //!< name of the folder above the sequence
    std::string sequence;  //!< name of the sequence's folder
    std::string target;    //!< the target's number, or its file name in a list
    Kind kind;
    std::string referenceFile, targetFile;
    std::string homographyFile;  //!< empty: static camera, identity
    //! Folders with maps of both images, of the image's size: "depth", "labels", in this order.
    std::vector<std::string> extraNames;

    std::string name() const;  //!< "set/sequence/target", unique in a data set
    std::vector<std::string> key() const { return {set, sequence, target}; }  //!< of rows of results
};

struct LoadedPair
{
    cv::Mat reference, target;                                   //!< CV_8UC1
    cv::Matx33d homography;                                      //!< reference to target, pixels
    std::map<std::string, cv::Mat> referenceExtra, targetExtra;  //!< by ImagePair::extraNames, 8U or 16U
};

/** Calls `visit` for the roots and folders up to four levels below them, in the order of paths; it returns whether to
descend.
@throws cv::Exception for a root that is not a folder. */
void visitFolders(
        const std::vector<std::string>& roots, const std::function<bool(const std::string&)>& visit);

//! The last component of a path.
std::string baseName(const std::string& path);
//! The last component of a path, without its extension.
std::string stem(const std::string& path);

//! Whether a folder holds images from known places: `cameras.txt`, `poses.txt` and `images`, as tools/synthetic/views.py writes them.
bool holdsViews(const std::string& folder);

/** Finds all pairs (1, k) below the given folders, up to four levels deep, in the layouts
 - `1.png`, `H_1_k` (also .ppm, .pgm, .jpg, .tif: HPatches), with `depth/k.png`, `labels/k.png` if any;
 - `img1.ppm`, `H1to2p` (original Oxford).
Sequences without any H file have a static camera. Folders of views are left out.
Pairs are ordered by path, numbers by value.
@throws cv::Exception for a root that is not a folder, or two pairs of one name. */
std::vector<ImagePair> findPairs(const std::vector<std::string>& roots);

//! @throws cv::Exception that names the file, for a broken image or H file.
LoadedPair loadPair(const ImagePair& pair);

//! Reads nine finite numbers, row by row. @throws cv::Exception for anything else, and for a singular matrix.
cv::Matx33d readHomography(const std::string& file);

//! Reads a grey image, or by other flags of cv::imread. @throws cv::Exception if the image cannot be read.
cv::Mat readImage(const std::string& file, int flags = 0);

}  // namespace iib_tools

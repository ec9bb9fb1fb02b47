// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "opencv2/core.hpp"

namespace iib_tools {

/** What changes between the images of a sequence: "light", "blur", "jpeg", "viewpoint" or "zoom" (with rotation). Known
for the sequences of Oxford by name and for HPatches by the prefix `v_`; "marked" for pairs with correspondences by hand;
"light" otherwise. */
typedef std::string Kind;

//! A reference image and a target image of the same scene; files are read by loadPair alone.
struct ImagePair
{
    std::string set;       //!< name of the folder above the sequence
    std::string sequence;  //!< name of the sequence's folder
    std::string target;    //!< the target's number, or its file name in a list
    Kind kind;
    std::string referenceFile, targetFile;
    std::string homographyFile;  //!< empty: static camera, identity
    //! Maps of the image's size that lie beside reference and target: "depth", "labels", in this order.
    std::vector<std::string> extraNames;

    std::string name() const;  //!< "set/sequence/target", unique in a data set
};

struct LoadedPair
{
    cv::Mat reference, target;                                   //!< CV_8UC1
    cv::Matx33d homography;                                      //!< reference to target, pixels
    std::map<std::string, cv::Mat> referenceExtra, targetExtra;  //!< by ImagePair::extraNames, 8U or 16U
};

/** Calls `visit` with the folders and those up to four levels below them, in the order of the paths; it tells whether to go on
within the one it is given. @throws cv::Exception for a root that is no folder. */
void visitFolders(
        const std::vector<std::string>& roots, const std::function<bool(const std::string&)>& visit);

//! A path's last name.
std::string baseName(const std::string& path);
//! The same without its extension.
std::string stem(const std::string& path);

/** Finds all pairs (1, k) below the given folders, up to four levels deep, in the layouts
 - `1.png`, `H_1_k` (also .ppm, .pgm, .jpg, .tif: HPatches), with `depth/k.png`, `labels/k.png` if any;
 - `img1.ppm`, `H1to2p` (original Oxford);
 - `01.png`, `02.png`, `corrs.txt` (WxBS, also .jpg): lines of x1 y1 x2 y2 in place of a homography;
Sequences without any H file are of a static camera; folders that hold `frames` (walks) and those of views.hpp are left
out. The order is by path, numbers by value.
@param marked whether to find those of the last layout, or all others
@throws cv::Exception for a root that is no folder, or two pairs of the same name. */
std::vector<ImagePair> findPairs(const std::vector<std::string>& roots, bool marked = false);

//! @throws cv::Exception, in one line with the file's name, for a broken image or H file.
LoadedPair loadPair(const ImagePair& pair);

//! Nine finite numbers, row by row, not singular. @throws cv::Exception otherwise.
cv::Matx33d readHomography(const std::string& file);

//! @throws cv::Exception if the file is no readable image. flags as in cv::imread.
cv::Mat readImage(const std::string& file, int flags);

}  // namespace iib_tools

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "textures.hpp"

namespace opencv_test {

//! Polygons and ellipses in front of each other, CV_8U.
Mat scene(Size size, int seed);

//! A grey image below OPENCV_TEST_DATA_PATH; the test skips where it is not there.
Mat readIllumination(const String& name, int flags = IMREAD_GRAYSCALE);

//! Nine numbers of a text file; the identity if there is no such file.
Matx33d readHomography(const String& file);

//! The scene under changed illumination: dimmed, from the side, with a response curve and noise.
Mat relit(const Mat& image, int seed);

//! For setSelection(): up to `count` quads of levels 1 to 5, each with some of the bits that its channel may have
//! there.
//! @param ends of their rows and columns on each level
Mat_<int> randomSelection(int count, const std::vector<int>& ends, const std::vector<int>& masksOfChannels);

//! Number of matches within 3 pixels of their place by a homography.
int countCorrect(const std::vector<DMatch>& matches, const std::vector<KeyPoint>& queries,
        const std::vector<KeyPoint>& trains, const Matx33d& homography = Matx33d::eye());

//! A scene, the same under changed illumination and rotated clockwise about its centre, and 600 ORB points in each.
struct RotatedPair
{
    Mat images[2];
    Matx33d homography;
    std::vector<KeyPoint> keypoints[2];

    explicit RotatedPair(double degrees, double zoom = 1);
    int correct(const std::vector<DMatch>& matches) const;
};

}  // namespace opencv_test

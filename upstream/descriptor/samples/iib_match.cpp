// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches ORB's points of two images by the IIB descriptor, and draws the matches.

#include "opencv2/core/utility.hpp"
#include "opencv2/highgui.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/imgcodecs.hpp"

#include <iostream>

using namespace cv;

int main(int argc, char** argv)
{
    const CommandLineParser parser(argc, argv,
            "{help h | | print this}{@image1 | | }{@image2 | | the other image of the place}"
            "{out | | picture to write instead of showing it}");
    const Mat images[2] = {imread(parser.get<String>(0)), imread(parser.get<String>(1))};
    if (parser.has("help") || images[0].empty() || images[1].empty())
    {
        parser.printMessage();
        return 1;
    }

    const Ptr<Feature2D> detector = ORB::create(1000);
    const Ptr<iib::IIB> iib = iib::IIB::create(2.f);  // what ORB's keypoints need
    std::vector<KeyPoint> keypoints[2];
    Mat descriptors[2], picture;
    for (int i = 0; i < 2; i++)
    {
        detector->detect(images[i], keypoints[i]);
        iib->compute(images[i], keypoints[i], descriptors[i]);
    }
    std::vector<DMatch> matches;
    if (!descriptors[0].empty() && !descriptors[1].empty())
        BFMatcher(NORM_HAMMING, true).match(descriptors[0], descriptors[1], matches);
    std::cout << matches.size() << " mutual matches\n";

    drawMatches(images[0], keypoints[0], images[1], keypoints[1], matches, picture);
    if (parser.has("out"))
        return imwrite(parser.get<String>("out"), picture) ? 0 : 1;
    imshow("matches", picture);
    waitKey();
    return 0;
}

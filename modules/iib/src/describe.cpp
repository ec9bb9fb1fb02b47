// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "describe.hpp"

#include "input.hpp"

#include "../test/oracle.cpp"

namespace cv {
namespace iib {

void describe(const Parameters& p, const Mat& image, const std::vector<Mat>& extra,
              const std::vector<KeyPoint>& keypoints, Mat& descriptors)
{
    const Rect whole(Point(), image.size());
    std::vector<Mat> maps;
    for (const Mat& m : extra)
        maps.push_back(integerMap(m, whole));
    Ptr<IIB> iib = IIB::create(p.scaleFactor, p.granularity, p.channels, p.mapping, p.overlap, p.useOrientation,
                               p.extraChannels);
    iib->setSelection(p.selection);
    oracle::describe(*iib, integerMap(image, whole), maps, keypoints).copyTo(descriptors);
}

}  // namespace iib
}  // namespace cv

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "stress.hpp"

namespace iib_stress {

using namespace cv;
using cv::iib::IIB;

void manyKeypoints(int count)
{
    const Mat image = noise(Size(1280, 720), CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), count);
    for (const bool rotated : {false, true})
    {
        const Ptr<IIB> iib = IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, rotated);
        Mat descriptors;
        {
            const Report report(format("%d keypoints on 1280 x 720%s", count, rotated ? ", rotated" : ""));
            descriptors = describe(*iib, image, keypoints);
        }
        for (int i = 0; i < 1000; i++)
        {
            const int k = (int)((int64)i * count / 1000);
            require(equal(descriptors.row(k), describe(*iib, image, std::vector<KeyPoint>(1, keypoints[k]))),
                    "a keypoint alone is described otherwise");
        }
    }
}

void largeImages(int megapixels)
{
    const Size size(12500, megapixels * 80);
    for (const int type : {CV_8UC1, CV_16UC1, CV_8UC3, CV_32FC1})
        for (const bool rotated : {false, true})
        {
            const Mat image = noise(size, type, 1);
            std::vector<KeyPoint> keypoints = scatter(size - Size(200, 200), 2000);
            keypoints.push_back(
                    KeyPoint((float)size.width / 2, (float)size.height / 2, (float)size.width, 10));
            const Ptr<IIB> iib =
                    IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, rotated);
            Mat descriptors;
            {
                const Report report(format("%d x %d, %s%s", size.width, size.height,
                        typeToString(type).c_str(), rotated ? ", rotated" : ""));
                descriptors = describe(*iib, image, keypoints);
            }
            if (type == CV_32FC1)
                continue;  // its steps depend on the whole image
            for (int k = 0; k < 2000; k += 10)
            {
                const Point corner(
                        std::max((int)keypoints[k].pt.x - 150, 0), std::max((int)keypoints[k].pt.y - 150, 0));
                const Rect around = Rect(corner, Size(300, 300)) & Rect(Point(), size);
                KeyPoint kp = keypoints[k];
                kp.pt.x -= (float)corner.x;
                kp.pt.y -= (float)corner.y;
                require(equal(descriptors.row(k),
                                describe(*iib, image(around).clone(), std::vector<KeyPoint>(1, kp))),
                        "a part of the image is described otherwise");
            }
        }
}

}  // namespace iib_stress

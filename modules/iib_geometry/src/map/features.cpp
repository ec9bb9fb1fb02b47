// SPDX-License-Identifier: Apache-2.0

#include "features.hpp"

#include <algorithm>

#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

#if CV_VERSION_MAJOR < 5
//! The strongest keypoints of ORB and AKAZE in turn, with sizes adapted to one scale factor.
class OrbAndAkaze : public Feature2D
{
public:
    explicit OrbAndAkaze(int points) : each_(size_t(points + 1) / 2) {}

    void detect(InputArray image, std::vector<KeyPoint>& keypoints, InputArray mask) override
    {
        const Ptr<Feature2D> detectors[] = {ORB::create(int(each_)), AKAZE::create()};
        std::vector<KeyPoint> found[2];
        for (int i : {0, 1})
        {
            detectors[i]->detect(image, found[i], mask);
            std::stable_sort(found[i].begin(), found[i].end(),
                    [](const KeyPoint& a, const KeyPoint& b) { return a.response > b.response; });
            for (KeyPoint& k : found[i])
                k.size *= IIB::scaleFactorFor(detectors[i]) / IIB::scaleFactorFor(detectors[0]);
        }
        keypoints.clear();
        for (size_t rank = 0; rank < each_; rank++)
            for (const std::vector<KeyPoint>& own : found)
                if (rank < own.size())
                    keypoints.push_back(own[rank]);
    }

private:
    const size_t each_;
};
#endif

}  // namespace

void extract(IIB& iib, const Mat& image, const Mat& mask, MapImage& features, int maxSize, float angle)
{
    const int side = std::max(image.cols, image.rows);
    const double scale = maxSize > 0 && side > maxSize ? (double)maxSize / side : 1;
    Mat seen = image, allowed = mask;
    if (scale < 1)
    {
        resize(image, seen, Size(), scale, scale, INTER_AREA);
        if (!mask.empty())
            resize(mask, allowed, seen.size(), 0, 0, INTER_NEAREST);
    }
    std::vector<KeyPoint> keypoints;
    iib.detect(seen, keypoints, allowed);
    for (KeyPoint& k : keypoints)
        k.angle = angle;
    iib.compute(seen, keypoints, features.codes);
    for (const KeyPoint& k : keypoints)
    {
        features.pixels.emplace_back((k.pt.x + .5) / scale - .5, (k.pt.y + .5) / scale - .5);
        features.sizes.push_back(float(k.size / scale));
    }
    features.sees.assign(keypoints.size(), -1);
    features.misses.assign(keypoints.size(), 0);
    features.picture = pictureOf(seen);
    features.picture.scale *= scale;
}

Ptr<IIB> extractorOf(bool orbAndAkaze, int points)
{
    if (!orbAndAkaze)
    {
        const Ptr<IIB> iib = IIB::createRecommended(points);
        iib->setOrientation(IIB::ORIENTATION_KEYPOINT);
        return iib;
    }
#if CV_VERSION_MAJOR < 5
    const Ptr<IIB> iib = IIB::create(IIB::scaleFactorFor(ORB::create()));
    iib->setDetector(makePtr<OrbAndAkaze>(points));
    iib->setOrientation(IIB::ORIENTATION_KEYPOINT);
    return iib;
#else
    CV_Error(Error::StsNotImplemented, "OpenCV 5 has no AKAZE: maps of AKAZE points need OpenCV 4");
#endif
}

}  // namespace cv::iib

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "affine_backend.hpp"

#include "opencv2/imgproc.hpp"

namespace cv {
namespace iib {

namespace {

//! Corners, edges and blobs for every detector: discs of several sizes and brightnesses, and rectangles around some.
Mat manyFeatures()
{
    const int STEP = 32, SIDE = 6 * STEP;
    Mat image(SIDE, SIDE, CV_8U, Scalar(120));
    for (int i = 0; i < 36; i++)
    {
        const Point centre(i % 6 * STEP + STEP / 2, i / 6 * STEP + STEP / 2);
        const int radius = 4 + i % 5;
        if (i % 3 == 0)
            rectangle(image, centre - Point(12, 9 + i % 4), centre + Point(9 + i % 6, 12),
                    Scalar(i % 2 ? 200 : 60), FILLED);
        circle(image, centre, radius, Scalar(i % 4 ? 10 + i : 245 - i), FILLED, LINE_AA);
    }
    return image;
}

bool areAlike(const KeyPoint& a, const KeyPoint& b)
{
    return std::abs(a.pt.x - b.pt.x) < 0.01f && std::abs(a.pt.y - b.pt.y) < 0.01f &&
           std::abs(a.size - b.size) < 0.001f * b.size && a.octave == b.octave;
}

}  // namespace

Ptr<Feature2D> affineBackend(Feature2D& affine)
{
    const Mat image = manyFeatures();
    std::vector<KeyPoint> keypoints, candidates;
    affine.detect(image, keypoints);
    const Ptr<Feature2D> known[] = {
        ORB::create(2000),
        SIFT::create(),
#if CV_VERSION_MAJOR < 5  // opencv_contrib's since then
        AKAZE::create(),
        BRISK::create(),
        KAZE::create(),
        AgastFeatureDetector::create(),
#endif
        FastFeatureDetector::create(),
        GFTTDetector::create(),
        SimpleBlobDetector::create()
    };
    Ptr<Feature2D> best;
    int most = 0;
    for (const Ptr<Feature2D>& detector : known)
    {
        detector->detect(image, candidates);
        int alike = 0;
        for (const KeyPoint& kp : keypoints)
            alike += std::any_of(candidates.begin(), candidates.end(),
                    [&](const KeyPoint& candidate) { return areAlike(kp, candidate); });
        if (alike > most)
        {
            most = alike;
            best = detector;
        }
    }
    if (best)
        return best;
    CV_Error(Error::StsBadArg,
            "AffineFeature does not tell which detector it wraps, and its keypoints are of "
            "none that is known; give create() the scale factor of that one (see "
            "scaleFactorFor) and setDetector() the AffineFeature");
}

}  // namespace iib
}  // namespace cv

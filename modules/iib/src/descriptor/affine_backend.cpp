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
    keypoints.erase(std::remove_if(keypoints.begin(), keypoints.end(),
                            [](const KeyPoint& kp) { return kp.class_id != 0; }),
            keypoints.end());  // those of the first view
    // the most usual first; to make a BRISK takes longer than to detect with the others
    typedef Ptr<Feature2D> Any;
    Any (*const known[])() = {
        [] { return Any(ORB::create(2000)); },
        [] { return Any(SIFT::create()); },
        [] { return Any(FastFeatureDetector::create()); },
        [] { return Any(GFTTDetector::create()); },
        [] { return Any(SimpleBlobDetector::create()); },
#if CV_VERSION_MAJOR < 5  // opencv_contrib's since then
        [] { return Any(AKAZE::create()); },
        [] { return Any(AgastFeatureDetector::create()); },
        [] { return Any(KAZE::create()); },
        [] { return Any(BRISK::create()); },
#endif
    };
    Ptr<Feature2D> best;
    int most = 0;
    for (const auto create : known)
    {
        const Ptr<Feature2D> detector = create();
        detector->detect(image, candidates);
        int alike = 0;
        for (const KeyPoint& kp : keypoints)
            alike += std::any_of(candidates.begin(), candidates.end(),
                    [&](const KeyPoint& candidate) { return areAlike(kp, candidate); });
        if (2 * alike > (int)keypoints.size())
            return detector;
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

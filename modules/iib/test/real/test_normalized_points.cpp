// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"

namespace opencv_test { namespace {

struct DetectorGain
{
    Ptr<Feature2D> detector;
    double gain;  //!< ratio of correct matches, normalized to plain; slightly below the measured value
};

TEST(IIB_NormalizedDetector, right_matches_by_changed_light)
{
    const DetectorGain detectors[] = {
            {AKAZE::create(AKAZE::DESCRIPTOR_MLDB, 0, 3, 0.0003f), 1.05}, {ORB::create(1000), 1.15}};
    const char* pairs[][2] = {{"amos_daynight/cam01/1.png", "amos_daynight/cam01/4.png"},
            {"amos_daynight/cam04/1.png", "amos_daynight/cam04/3.png"},
            {"tilde_webcam/chamonix/1.png", "tilde_webcam/chamonix/5.png"},
            {"tilde_webcam/courbevoie/1.png", "tilde_webcam/courbevoie/6.png"}};
    for (const DetectorGain& d : detectors)
    {
        int plain = 0, normalizedPoints = 0;
        for (const auto& pair : pairs)
        {
            const Mat images[] = {readIllumination(pair[0]), readIllumination(pair[1])};
            plain += matchDetected(d.detector, images, 1000).correct;
            normalizedPoints += matchDetected(NormalizedDetector::create(d.detector), images, 1000).correct;
        }
        std::cout << format("[          ] %s: %d right matches at plain points, %d at normalized ones\n",
                d.detector->getDefaultName().c_str(), plain, normalizedPoints);
        EXPECT_GE(normalizedPoints, d.gain * plain);
    }
}

}}  // namespace opencv_test

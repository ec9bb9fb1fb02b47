// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"

#include <fstream>

/* Real images, below OPENCV_TEST_DATA_PATH: illumination/<set>/<sequence>. They belong to their authors and are not
 part of the project; without them these tests skip. */
namespace opencv_test { namespace {

String textFile(const String& name) { return cvtest::findDataFile("illumination/" + name, false); }

//! The paper's seed points; they count from 1.
std::vector<KeyPoint> readKeyPoints(const String& name)
{
    std::ifstream file(textFile(name).c_str());
    std::vector<KeyPoint> keypoints;
    std::string line;
    std::getline(file, line);
    EXPECT_EQ("x,y,size,angle", line);
    KeyPoint kp;
    char comma;
    while (file >> kp.pt.x >> comma >> kp.pt.y >> comma >> kp.size >> comma >> kp.angle)
        keypoints.push_back(kp);
    return keypoints;
}

std::vector<DMatch> mutualMatches(const Mat& a, const Mat& b)
{
    std::vector<DMatch> matches;
    BFMatcher(NORM_HAMMING, true).match(a, b, matches);
    return matches;
}

/* The paper's own code finds 808 and 574 of 1000; that is the bar. Measured here: 809 and 577 (colour), 811 and 588
 (grey, whose rounding differs from cvtColor's). */
TEST(IIB_Real, paper_scene)
{
    const String sequence = "iib_demo/scene";
    const Ptr<IIB> iib = IIB::create(1.f);
    const std::vector<KeyPoint> keypoints = readKeyPoints(sequence + "/keypoints.csv");
    ASSERT_EQ(1000u, keypoints.size());
    for (int flags : {(int)IMREAD_COLOR, (int)IMREAD_GRAYSCALE})
    {
        const Mat reference = describe(*iib, readIllumination(sequence + "/1.png", flags), keypoints);
        for (int k = 2; k <= 3; k++)
        {
            int correct = 0;
            for (const DMatch& m : mutualMatches(reference,
                         describe(*iib, readIllumination(sequence + format("/%d.png", k), flags), keypoints)))
                correct += m.queryIdx == m.trainIdx;
            std::cout << format("[          ] 1 - %d: %d correct\n", k, correct);
            EXPECT_GE(correct, k == 2 ? 808 : 574);
        }
    }
}

TEST(IIB_Real, leuven_with_orb_keypoints)
{
    const String sequence = "oxford_affine/leuven";
    const Ptr<ORB> orb = ORB::create(2000);
    const Ptr<IIB> iib = IIB::create(IIB::scaleFactorFor(orb));
    std::vector<KeyPoint> keypoints[6];
    Mat own[6], ours[6];
    for (int k = 0; k < 6; k++)
    {
        const Mat image = readIllumination(sequence + format("/%d.png", k + 1));
        orb->detectAndCompute(image, noArray(), keypoints[k], own[k]);
        ours[k] = describe(*iib, image, keypoints[k]);
    }
    for (int k = 1; k < 6; k++)
    {
        const Matx33d h = readHomography(textFile(sequence + format("/H_1_%d", k + 1)));
        const std::vector<DMatch> byOrb = mutualMatches(own[0], own[k]),
                                  byIib = mutualMatches(ours[0], ours[k]);
        const int orbs = countCorrect(byOrb, keypoints[0], keypoints[k], h),
                  iibs = countCorrect(byIib, keypoints[0], keypoints[k], h);
        std::cout << format("[          ] 1 - %d: ORB %d of %d, IIB %d of %d correct\n", k + 1, orbs,
                (int)byOrb.size(), iibs, (int)byIib.size());
        EXPECT_GT(iibs, orbs);
        EXPECT_GT((double)iibs / byIib.size(), (double)orbs / byOrb.size());
    }
}

}}  // namespace opencv_test

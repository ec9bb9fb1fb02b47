// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/test_images.hpp"
#include "refinement_scene.hpp"

namespace opencv_test {
namespace {

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

//! How many standard deviations an error is long: Mahalanobis' distance.
double inSigmas(const Point2d& error, const Point3d& c)
{
    return std::sqrt((c.z * error.x * error.x - 2 * c.y * error.x * error.y + c.x * error.y * error.y) /
                     (c.x * c.z - c.y * c.y));
}

// All bars of this suite are of issue "From matches to measurements"; 39 and 86 % of normally distributed errors are
// inside the ellipses of one and two sigma.
TEST(IIB_RefinementAccuracy, errors_bias_and_covariances)
{
    std::vector<double> errors, x, y, plain;
    int matches = 0, inside[2] = {0, 0};
    for (int seed = 1; seed <= 4; seed++)
    {
        const RefinementScene scene(seed);
        const Refined r = refine(scene);
        const Mat_<Point2f> points1 = r.points1.reshape(2), points2 = r.points2.reshape(2);
        const Mat_<Point3f> covariances = r.covariances.reshape(3);
        const Mat_<float> similarities = r.similarities;
        matches += similarities.rows;
        for (int i = 0; i < similarities.rows; i++)
        {
            const Point2d detected = scene.keypoints[1][i].pt, truth = scene.truth(points1(i));
            plain.push_back(cv::norm(detected - truth));
            if (similarities(i) < 0)
                continue;
            const Point2d error = Point2d(points2(i)) - truth;
            errors.push_back(cv::norm(error));
            x.push_back(error.x);
            y.push_back(error.y);
            const double distance = inSigmas(error, covariances(i));
            for (int sigma : {1, 2})
                inside[sigma - 1] += distance < sigma;
        }
    }
    const double n = (double)errors.size();
    EXPECT_GT(matches, 800);
    EXPECT_GT(n, .9 * matches);
    EXPECT_GT(median(plain), .35);
    EXPECT_LT(median(errors), .04);
    EXPECT_LT(std::abs(median(x)), .01);
    EXPECT_LT(std::abs(median(y)), .01);
    EXPECT_GT(inside[0] / n, .30);
    EXPECT_LT(inside[0] / n, .55);
    EXPECT_GT(inside[1] / n, .75);
    EXPECT_LT(inside[1] / n, .95);
}

/* Photographs of one camera under another exposure, so that the truth is known: errors and ellipses. Their errors are
 larger than noise explains. Clouds and leaves that moved are in them too. */
TEST(IIB_RefinementAccuracy, photographs_in_other_exposure)
{
    const Ptr<IIB> iib = IIB::createRecommended(1000);
    std::vector<double> plain, errors, sigmas;
    for (const char* name : {"Bathtub", "BelgiumHouse", "Candle", "Cave", "Church", "Farmhouse"})
    {
        Mat images[2], codes[2];
        std::vector<KeyPoint> keypoints[2];
        std::vector<DMatch> matches;
        for (int i = 0; i < 2; i++)
        {
            images[i] = readIllumination(format("mefb_exposure/%s/%d.png", name, i + 1));
            iib->detectAndCompute(images[i], noArray(), keypoints[i], codes[i]);
        }
        HierarchicalMatcher::createRecommended()->match(codes[0], codes[1], matches);
        const Refined r = refine(images[0], keypoints[0], images[1], keypoints[1], matches);
        for (int i = 0; i < r.points2.rows; i++)
        {
            const Point2f truth = r.points1.at<Point2f>(i), error = r.points2.at<Point2f>(i) - truth;
            const double before = cv::norm(keypoints[1][matches[i].trainIdx].pt - truth);
            if (before > 2 || r.similarities.at<float>(i) < 0)
                continue;
            plain.push_back(before);
            errors.push_back(cv::norm(error));
            sigmas.push_back(inSigmas(error, r.covariances.at<Point3f>(i)));
        }
    }
    const auto inside = [&](double sigma) {
        return std::count_if(sigmas.begin(), sigmas.end(), [&](double s) { return s < sigma; }) /
               (double)sigmas.size();
    };
    RecordProperty("median error", format("%.3f, plain %.3f", median(errors), median(plain)));
    RecordProperty("inside 1 and 2 sigma", format("%.2f %.2f", inside(1), inside(2)));
    EXPECT_GT(sigmas.size(), 1000u);
    EXPECT_LT(median(errors), .6 * median(plain));
    EXPECT_GT(inside(1), .2);
    EXPECT_GT(inside(2), .5);
}

}  // namespace
}  // namespace opencv_test

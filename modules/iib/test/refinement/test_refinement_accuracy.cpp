// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "refinement_scene.hpp"

namespace opencv_test {
namespace {

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

// All bars of this suite are of issue "From matches to measurements"; 39 and 86 % of normally distributed errors are inside
// the ellipses of one and two sigma.
TEST(IIB_RefinementAccuracy, errors_bias_and_covariances)
{
    std::vector<double> errors, x, y, plain;
    int matches = 0, inside[2] = {0, 0};
    for (int seed = 1; seed <= 4; seed++)
    {
        const RefinementScene scene(seed);
        Mat_<Point2f> points1, points2;
        Mat_<Point3f> covariances;
        Mat_<float> similarities;
        Mat first, second, covariance;
        refineMatches(scene.images[0], scene.keypoints[0], scene.images[1], scene.keypoints[1], scene.matches,
                first, second, covariance, similarities);
        points1 = first.reshape(2);
        points2 = second.reshape(2);
        covariances = covariance.reshape(3);
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
            const Point3d c = covariances(i);
            const double determinant = c.x * c.z - c.y * c.y;
            const double distance =
                    (c.z * error.x * error.x - 2 * c.y * error.x * error.y + c.x * error.y * error.y) /
                    determinant;
            for (int sigma : {1, 2})
                inside[sigma - 1] += distance < sigma * sigma;
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

}  // namespace
}  // namespace opencv_test

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../normalization/normalization_oracle.hpp"
#include "../support/test_images.hpp"
#include "refinement_scene.hpp"

#include "opencv2/imgproc.hpp"

namespace opencv_test { namespace {

//! refineMatches as its documentation says it, on doubles: for keypoints without angles and of one size.
class Oracle
{
public:
    Oracle(const Mat& image1, const Mat& image2) : first(prepared(image1)), second(prepared(image2)) {}

    struct Result
    {
        bool accepted;
        Vec2d point;
        double similarity;
    };

    Result align(const Point2d& detected1, const Point2d& detected2) const
    {
        // the patch lies on whole pixels; the point moves with it
        const Vec2d point1(cvRound(detected1.x), cvRound(detected1.y)), point2(detected2.x, detected2.y);
        const Vec2d beside = Vec2d(detected1.x, detected1.y) - point1;
        const Result refused = {false, point2, -1};
        const Matx22d none = Matx22d::eye();
        std::vector<double> fixed = samples(first, point1, none);
        const double contrast = deviation(fixed);
        if (!normalize(fixed))
            return refused;
        // derivatives by x, y and a linear warp, less the share of brightness and contrast
        std::vector<std::vector<double>> derivatives(6);
        for (int d = 0; d < 2; d++)
        {
            const Vec2d half = d == 0 ? Vec2d(1, 0) : Vec2d(0, 1);
            const std::vector<double> before = samples(first, point1 - half, none),
                                      after = samples(first, point1 + half, none);
            for (int i = 0; i < N * N; i++)
            {
                const double derivative = (after[i] - before[i]) / 2 / contrast;
                derivatives[d].push_back(derivative);
                derivatives[2 + 2 * d].push_back(derivative * place(i)[0] / 16);
                derivatives[3 + 2 * d].push_back(derivative * place(i)[1] / 16);
            }
        }
        Matx66d normal;
        for (std::vector<double>& values : derivatives)
        {
            const double mean = sum(values, std::vector<double>(N * N, 1)), along = sum(values, fixed);
            for (int i = 0; i < N * N; i++)
                values[i] -= mean + along * fixed[i];
        }
        for (int i = 0; i < 6; i++)
            for (int j = 0; j < 6; j++)
                normal(i, j) = sum(derivatives[i], derivatives[j]) + (i != j ? 0 : i < 2 ? 1e-5 : 5e-3);

        Matx22d warp = none;
        Vec2d centre = point2 - beside, moved = point2;
        double similarity = 0;
        for (int step = 0; step < 30; step++)
        {
            std::vector<double> values = samples(second, centre, warp);
            if (!normalize(values))
                return refused;
            similarity = sum(values, fixed);
            Vec6d gradient;
            for (int i = 0; i < 6; i++)
                gradient[i] = sum(derivatives[i], values);
            const Vec6d d = normal.inv() * gradient;
            warp = warp * Matx22d(1 + d[2] / 16, d[3] / 16, d[4] / 16, 1 + d[5] / 16).inv();
            centre -= warp * Vec2d(d[0], d[1]);
            moved = centre + warp * beside;
            if (!(cv::norm(moved - point2) < 20))
                return refused;
        }
        const bool accepted = cv::norm(moved - point2) < 2 && similarity > .5;
        return accepted ? Result{true, moved, similarity} : refused;
    }

private:
    static const int N = 16;

    static Mat prepared(const Mat& image)
    {
        Mat result;
        GaussianBlur(oracle::normalizeLocally(image, 8), result, Size(3, 3), 0, 0, BORDER_REPLICATE);
        result.convertTo(result, CV_64F);
        return result;
    }

    static Vec2d place(int i) { return Vec2d(2 * (i % N) - (N - 1), 2 * (i / N) - (N - 1)); }

    static std::vector<double> samples(const Mat& image, const Vec2d& centre, const Matx22d& warp)
    {
        std::vector<double> values;
        for (int i = 0; i < N * N; i++)
        {
            const Vec2d p = centre + warp * place(i);
            const int x = cvFloor(p[0]), y = cvFloor(p[1]);
            const auto at = [&](int dx, int dy) {
                return image.at<double>(std::min(std::max(y + dy, 0), image.rows - 1),
                        std::min(std::max(x + dx, 0), image.cols - 1));
            };
            const double right = p[0] - x, down = p[1] - y;
            values.push_back((at(0, 0) * (1 - right) + at(1, 0) * right) * (1 - down) +
                             (at(0, 1) * (1 - right) + at(1, 1) * right) * down);
        }
        return values;
    }

    //! Sum of products, weighted by a Gaussian of 8 pixels whose sum is 1.
    static double sum(const std::vector<double>& a, const std::vector<double>& b)
    {
        double weights = 0, result = 0;
        for (int i = 0; i < N * N; i++)
        {
            const double weight = std::exp(-place(i).dot(place(i)) / 128);
            weights += weight;
            result += weight * a[i] * b[i];
        }
        return result / weights;
    }

    static double deviation(std::vector<double> values)
    {
        const double mean = sum(values, std::vector<double>(N * N, 1));
        return std::sqrt(std::max(sum(values, values) - mean * mean, 0.));
    }

    static bool normalize(std::vector<double>& values)
    {
        const double mean = sum(values, std::vector<double>(N * N, 1)), scale = deviation(values);
        for (double& value : values)
            value = (value - mean) / scale;
        return scale > .5;
    }

    const Mat first, second;
};

// Matches near the truth, and some that are wrong by 0 to 4 pixels or altogether. Places agree within .05 pixels,
// similarities within .06: the library uses integers and fewer steps.
TEST(IIB_RefinementOracle, agrees_with_the_documentation)
{
    const RefinementScene& scene = RefinementScene::seven();
    const Oracle oracle(scene.images[0], scene.images[1]);
    std::vector<KeyPoint> first, second;
    std::vector<DMatch> matches;
    for (int i = 0; i < 120; i++)
    {
        first.push_back(KeyPoint(scene.keypoints[0][i].pt, 8));
        const Point2f wrong(i % 10 * .4f, i % 7 * .3f);
        const int other = i % 12 == 2 ? (i + 7) % 120 : i;
        second.push_back(KeyPoint(scene.keypoints[1][other].pt + (i % 3 == 1 ? wrong : Point2f()), 8));
        matches.push_back(DMatch(i, i, 0));
    }
    const Refined actual = refine(scene.images[0], first, scene.images[1], second, matches);
    int agreed = 0, accepted = 0, near = 0;
    for (int i = 0; i < 120; i++)
    {
        const Oracle::Result expected = oracle.align(first[i].pt, second[i].pt);
        const bool found = actual.similarities.at<float>(i) > 0;
        agreed += expected.accepted == found;
        if (!expected.accepted || !found)
            continue;
        accepted++;
        near += cv::norm(expected.point - Vec2d(actual.points2.at<Vec2f>(i))) < .05 &&
                std::abs(expected.similarity - actual.similarities.at<float>(i)) < .06;
    }
    EXPECT_GE(agreed, 116);
    EXPECT_GT(accepted, 70);
    EXPECT_LT(accepted, 115);
    EXPECT_GE(near, .97 * accepted);
}

// The same bits on every machine and build. Images and keypoints are made of integers alone. A change of the algorithm
// may change them; a failure prints the new numbers.
TEST(IIB_RefinementGolden, bits)
{
    const Mat whole = texture(Size(330, 250), CV_8U, 11);
    const Mat first = whole(Rect(5, 4, 320, 240)).clone();
    Mat second = whole(Rect(7, 7, 320, 240)).clone();
    for (int y = 0; y < second.rows; y++)
        for (int x = 0; x < second.cols; x++)
            second.at<uchar>(y, x) = (uchar)(second.at<uchar>(y, x) * (300 + x) / 700 + 20);
    const std::vector<KeyPoint> keypoints = scatter(first.size(), 120, 8, 30, 3);
    std::vector<KeyPoint> moved = keypoints;
    std::vector<DMatch> matches;
    for (int i = 0; i < (int)moved.size(); i++)
    {
        moved[i].pt += Point2f(i % 5 * .25f - 2.5f, i % 3 * .5f - 3.5f);
        moved[i].size *= i % 4 == 0 ? 1.25f : 1.f;
        moved[i].angle += i % 7 == 0 && moved[i].angle >= 0 ? 3 : 0;
        matches.push_back(DMatch(i, i, 0));
    }
    const auto expectHash = [](uint64 expected, const Mat& m) {
        EXPECT_EQ(expected, hashOf(m)) << std::hex << hashOf(m);
    };
    const Refined r = refine(first, keypoints, second, moved, matches);
    EXPECT_GT(countNonZero(r.similarities > 0), 60);
    expectHash(CV_BIG_UINT(0x88ade9101cb435c0), r.points2);
    expectHash(CV_BIG_UINT(0xcead3d66988b6e3f), r.covariances);
    expectHash(CV_BIG_UINT(0x268c6474a0e987a5), r.similarities);
    Mat points1, points2;
    matches.resize(40);
    propagateMatches(first, keypoints, second, moved, matches, points1, points2);
    EXPECT_GT(points2.rows, 55);
    expectHash(CV_BIG_UINT(0xf5d5074e5807b25f), points2);
}

}}  // namespace opencv_test

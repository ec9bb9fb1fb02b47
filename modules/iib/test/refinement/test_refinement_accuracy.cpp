// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../support/describe.hpp"
#include "refinement_scene.hpp"

#include "opencv2/imgproc.hpp"

namespace opencv_test { namespace {

double median(std::vector<double> values)
{
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

//! Errors of points, in pixels and in standard deviations.
struct Errors
{
    std::vector<double> x, y, lengths, sigmas;

    void add(const Point2d& error, const Point3d& covariance)
    {
        x.push_back(error.x);
        y.push_back(error.y);
        lengths.push_back(cv::norm(error));
        sigmas.push_back(inSigmas(error, covariance));
    }

    //! The share of errors below this many standard deviations.
    double inside(double sigma) const
    {
        return std::count_if(sigmas.begin(), sigmas.end(), [&](double s) { return s < sigma; }) /
               (double)sigmas.size();
    }
};

//! Adds the errors of a still camera's matches by the recommended chain that begin within 2 pixels.
void addStill(
        const Mat& first, const Mat& second, const Point2f& shift, Errors& errors, std::vector<double>& plain)
{
    const Ptr<IIB> iib = IIB::createRecommended(1000);
    Mat codes[2];
    std::vector<KeyPoint> keypoints[2];
    std::vector<DMatch> matches;
    iib->detectAndCompute(first, noArray(), keypoints[0], codes[0]);
    iib->detectAndCompute(second, noArray(), keypoints[1], codes[1]);
    HierarchicalMatcher::createRecommended()->match(codes[0], codes[1], matches);
    const Refined r = refine(first, keypoints[0], second, keypoints[1], matches);
    for (int i = 0; i < r.points2.rows; i++)
    {
        const Point2f truth = r.points1.at<Point2f>(i) + shift;
        const double before = cv::norm(keypoints[1][matches[i].trainIdx].pt - truth);
        if (before > 2 || r.similarities.at<float>(i) < 0)
            continue;
        plain.push_back(before);
        errors.add(r.points2.at<Point2f>(i) - truth, r.covariances.at<Point3f>(i));
    }
}

// 39 and 86 % of normally distributed errors are
// inside the ellipses of one and two sigma.
TEST(IIB_RefinementAccuracy, errors_bias_and_covariances)
{
    Errors errors;
    std::vector<double> plain;
    for (int seed = 1; seed <= 4; seed++)
    {
        const RefinementScene scene(seed);
        const Refined r = refine(scene);
        for (int i = 0; i < r.points2.rows; i++)
        {
            const Point2d truth = scene.truth(r.points1.at<Point2f>(i));
            plain.push_back(cv::norm(Point2d(scene.keypoints[1][i].pt) - truth));
            if (r.similarities.at<float>(i) > 0)
                errors.add(Point2d(r.points2.at<Point2f>(i)) - truth, r.covariances.at<Point3f>(i));
        }
    }
    EXPECT_GT(plain.size(), 800u);
    EXPECT_GT(errors.x.size(), .9 * plain.size());
    EXPECT_GT(median(plain), .35);
    EXPECT_LT(median(errors.lengths), .04);
    EXPECT_LT(std::abs(median(errors.x)), .01);
    EXPECT_LT(std::abs(median(errors.y)), .01);
    EXPECT_GT(errors.inside(1), .30);
    EXPECT_LT(errors.inside(1), .55);
    EXPECT_GT(errors.inside(2), .75);
    EXPECT_LT(errors.inside(2), .95);
}

// Linear interpolation alone would be off by .015 pixels, a quarter of a pixel from a whole one.
TEST(IIB_RefinementAccuracy, is_drawn_to_no_part_of_a_pixel)
{
    const int fine = 4;  // pixels of a camera's
    Mat whole;
    resize(texture(Size(640, 480) * 2, CV_8U, 5), whole, Size(640, 480) * fine, 0, 0, INTER_CUBIC);
    GaussianBlur(whole, whole, Size(), 2);
    Integers integers(3);
    Mat first;
    resize(whole(Rect(fine, 0, 600 * fine, 440 * fine)), first, Size(600, 440), 0, 0, INTER_AREA);
    const std::vector<KeyPoint> keypoints = found(*HessianDetector::create(800), first);
    for (int shift = 0; shift < fine; shift++)
    {
        Mat second;
        resize(whole(Rect(fine - shift, 0, 600 * fine, 440 * fine)), second, Size(600, 440), 0, 0,
                INTER_AREA);
        std::vector<KeyPoint> moved = keypoints;
        std::vector<DMatch> matches;
        for (KeyPoint& kp : moved)
        {
            kp.pt.y += integers.between(-50, 51) / 100.f;
            kp.pt.x += integers.between(-50, 51) / 100.f;
            matches.push_back(DMatch((int)matches.size(), (int)matches.size(), 0));
        }
        const Refined r = refine(first, keypoints, second, moved, matches);
        std::vector<double> errors;
        for (int i = 0; i < r.points2.rows; i++)
            if (r.similarities.at<float>(i) > 0)
                errors.push_back(r.points2.at<Point2f>(i).x - keypoints[i].pt.x - shift / (double)fine);
        EXPECT_GT(errors.size(), .9 * keypoints.size());
        EXPECT_LT(std::abs(median(errors)), .005) << shift << ": " << median(errors);
    }
}

//! An image and noise, twice.
std::vector<Mat> withNoise(const Mat& image, double sigma)
{
    std::vector<Mat> images(2);
    RNG rng(cvRound(sigma));
    for (Mat& noisy : images)
    {
        Mat noise(image.size(), CV_16S);
        rng.fill(noise, RNG::NORMAL, 0, sigma);
        cv::add(image, noise, noisy, noArray(), CV_8U);
    }
    return images;
}

TEST(IIB_RefinementAccuracy, white_noise)
{
    const Mat image = scene(Size(660, 500), 9);
    for (int sigma : {1, 3, 6, 10, 20, 30})
    {
        const std::vector<Mat> images = withNoise(image, sigma);
        Errors errors;
        std::vector<double> plain;
        addStill(images[0](Rect(10, 10, 640, 480)), images[1](Rect(7, 15, 640, 480)), Point2f(3, -5), errors,
                plain);
        double squares = 0;
        for (double s : errors.sigmas)
            squares += s * s / 2;
        EXPECT_LT(squares / errors.sigmas.size(), 2.5) << sigma;
        EXPECT_GT(errors.inside(1), .3) << sigma;
        EXPECT_LT(errors.inside(1), .55) << sigma;
        EXPECT_GT(errors.inside(2), .75) << sigma;
        EXPECT_LT(errors.inside(2), .95) << sigma;
    }
}

// Along a straight edge only noise can match: points stay about half a pixel off, with large covariances.
TEST(IIB_RefinementAccuracy, along_straight_edges)
{
    for (double degrees : {0., 30., 90.})
        for (double sigma : {2., 4., 16.})
        {
            Mat_<uchar> image(480, 640);
            const Point2d across(std::cos(degrees * CV_PI / 180), std::sin(degrees * CV_PI / 180));
            for (int y = 0; y < image.rows; y++)
                for (int x = 0; x < image.cols; x++)
                    image(y, x) = saturate_cast<uchar>(
                            20 + 200 / (1 + std::exp(-across.dot(Point2d(x - 320, y - 240)) / 1.5)));
            const std::vector<Mat> images = withNoise(image, sigma);
            RNG rng(1);
            std::vector<KeyPoint> keypoints[2];
            std::vector<DMatch> matches;
            for (int i = 0; i < 300; i++)
            {
                const double along = rng.uniform(-150., 150.), beside = rng.uniform(-3., 3.);
                const Point2f place(
                        Point2d(320, 240) + across * beside + Point2d(-across.y, across.x) * along);
                const double offY = rng.gaussian(.7), offX = rng.gaussian(.7);
                const Point2f off((float)offX, (float)offY);
                keypoints[0].push_back(KeyPoint(place, 20));
                keypoints[1].push_back(KeyPoint(place + off, 20));
                matches.push_back(DMatch(i, i, 0));
            }
            const Refined r = refine(images[0], keypoints[0], images[1], keypoints[1], matches);
            Errors errors;
            for (int i = 0; i < r.points2.rows; i++)
                if (r.similarities.at<float>(i) > 0)
                    errors.add(r.points2.at<Point2f>(i) - r.points1.at<Point2f>(i),
                            r.covariances.at<Point3f>(i));
            EXPECT_GT(errors.inside(1), .25) << degrees << ", noise " << sigma;
            EXPECT_GT(errors.inside(2), .65) << degrees << ", noise " << sigma;
        }
}

/* Photographs of one camera under another exposure, so that the truth is known: errors and ellipses. Their errors are
 larger than noise explains. Clouds and leaves that moved are in them too. */
TEST(IIB_RefinementAccuracy, photographs_in_other_exposure)
{
    Errors errors;
    std::vector<double> plain;
    for (const char* name : {"Bathtub", "BelgiumHouse", "Candle", "Cave", "Church", "Farmhouse"})
        addStill(readIllumination(format("mefb_exposure/%s/1.png", name)),
                readIllumination(format("mefb_exposure/%s/2.png", name)), Point2f(), errors, plain);
    RecordProperty("median error", format("%.3f, plain %.3f", median(errors.lengths), median(plain)));
    RecordProperty("inside 1 and 2 sigma", format("%.2f %.2f", errors.inside(1), errors.inside(2)));
    EXPECT_GT(errors.sigmas.size(), 1000u);
    EXPECT_LT(median(errors.lengths), .6 * median(plain));
    EXPECT_GT(errors.inside(1), .3);
    EXPECT_GT(errors.inside(2), .75);
}

// A still camera with lamps on other sides: errors come from shading.
TEST(IIB_RefinementAccuracy, photographs_by_other_lamps)
{
    Errors errors;
    std::vector<double> plain;
    for (const char* name : {"frog", "leaves_TL"})
        for (int k = 2; k <= 8; k++)
            addStill(readIllumination(format("photometric_stereo/%s/1.png", name)),
                    readIllumination(format("photometric_stereo/%s/%d.png", name, k)), Point2f(), errors,
                    plain);
    RecordProperty("inside 1 and 2 sigma", format("%.2f %.2f", errors.inside(1), errors.inside(2)));
    EXPECT_GT(errors.sigmas.size(), 1000u);
    EXPECT_GT(errors.inside(1), .3);
    EXPECT_LT(errors.inside(1), .6);
    EXPECT_GT(errors.inside(2), .7);
    EXPECT_LT(errors.inside(2), .95);
}

}}  // namespace opencv_test

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "test_images.hpp"

#include "oracle_pixels.hpp"

#include <fstream>

namespace opencv_test {

int Integers::below(int end)
{
    uint64 z = state += CV_BIG_UINT(0x9e3779b97f4a7c15);
    z = (z ^ z >> 30) * CV_BIG_UINT(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * CV_BIG_UINT(0x94d049bb133111eb);
    return (int)((z ^ z >> 31) % (unsigned)end);
}

//! Binomial weights along rows or columns; the border is repeated.
static Mat_<int> blurred(const Mat_<int>& m, Point direction)
{
    static const int weights[] = {1, 4, 6, 4, 1};
    Mat_<int> result(m.size());
    for (int y = 0; y < m.rows; y++)
        for (int x = 0; x < m.cols; x++)
        {
            int sum = 8;
            for (int i = -2; i <= 2; i++)
                sum += weights[i + 2] * oracle::pixel(m, y + i * direction.y, x + i * direction.x);
            result(y, x) = sum / 16;
        }
    return result;
}

Mat texture(Size size, int depth, int seed)
{
    CV_Assert(depth == CV_8U || depth == CV_16U);
    Integers integers(seed);
    Mat_<int> m(size);
    for (int& pixel : m)
        pixel = integers.below(depth == CV_8U ? 256 : 65536);
    if (size.width > 16 && size.height > 16)
    {
        m = blurred(blurred(m, Point(1, 0)), Point(0, 1));
        m(Rect(size.width / 4, size.height / 4, size.width / 3, size.height / 3)) = 77;
    }
    Mat result;
    m.convertTo(result, depth);
    return result;
}

static Point pointIn(Size size, Integers& integers)
{
    const int y = integers.below(size.height), x = integers.below(size.width);
    return Point(x, y);
}

Mat scene(Size size, int seed)
{
    Integers integers(seed);
    Mat image(size, CV_8U, Scalar(128));
    for (int i = 0; i < 400; i++)
    {
        const Point centre = pointIn(size, integers);
        const int largest = i < 100 ? 60 : 16;
        const Scalar grey(integers.between(40, 216));
        if (i % 3 == 0)
        {
            const int turn = integers.below(180), height = integers.between(4, largest),
                      width = integers.between(4, largest);
            ellipse(image, centre, Size(width, height), turn, 0, 360, grey, FILLED);
        }
        else
        {
            std::vector<Point> corners;
            for (int c = 0; c < 3 + i % 2; c++)
            {
                const int x = integers.between(-largest, largest), y = integers.between(-largest, largest);
                corners.push_back(centre + Point(x, y));
            }
            fillPoly(image, std::vector<std::vector<Point>>(1, corners), grey);
        }
    }
    for (int i = 0; i < 60; i++)  // blobs
    {
        const Point centre = pointIn(size, integers);
        circle(image, centre, 12, Scalar(integers.between(170, 216)), FILLED);
        circle(image, centre, integers.between(4, 8), Scalar(40), FILLED);
    }
    GaussianBlur(image, image, Size(3, 3), 0.7);
    return image;
}

Mat readIllumination(const String& name, int flags)
{
    const Mat image = imread(cvtest::findDataFile("illumination/" + name, false), flags);
    EXPECT_FALSE(image.empty()) << name;
    return image;
}

Matx33d readHomography(const String& file)
{
    std::ifstream in(file.c_str());
    Matx33d h = Matx33d::eye();
    if (!in)
        return h;
    for (double& v : h.val)
        in >> v;
    EXPECT_FALSE(in.fail()) << file;
    return h;
}

Mat relit(const Mat& image, int seed)
{
    Integers integers(seed);
    Mat result(image.size(), CV_8U);
    for (int y = 0; y < image.rows; y++)
        for (int x = 0; x < image.cols; x++)
        {
            const double light = 0.6 + 0.5 * x / image.cols - 0.2 * y / image.rows;
            const double v = 255 * std::pow(light * image.at<uchar>(y, x) / 255, 1.5);
            result.at<uchar>(y, x) = saturate_cast<uchar>(v + 8 + integers.between(-2, 3));
        }
    return result;
}

std::vector<KeyPoint> scatter(Size size, int count, float smallest, float largest, int seed)
{
    Integers integers(seed);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < count; i++)
    {
        // a fourth of them on whole pixels
        const int part = i % 4 ? 4 : 1;
        const float x = integers.between(-size.width * part / 5, size.width * part * 6 / 5) / (float)part;
        const float y = integers.between(-size.height * part / 5, size.height * part * 6 / 5) / (float)part;
        const float angle = i % 5 ? (float)integers.below(360) : -1.f;
        keypoints.push_back(
                KeyPoint(x, y, integers.between((int)(smallest * 8), (int)(largest * 8)) / 8.f, angle));
    }
    return keypoints;
}

Mat_<int> randomSelection(int count, const std::vector<int>& ends, const std::vector<int>& masksOfChannels)
{
    RNG rng(count);
    std::set<std::vector<int>> quads;
    for (int i = 0; i < count; i++)
    {
        const int level = rng.uniform(1, 6), end = ends[level - 1];
        quads.insert({level, rng.uniform(0, (int)masksOfChannels.size()), rng.uniform(0, end),
                rng.uniform(0, end)});
    }
    Mat_<int> selection;
    for (const std::vector<int>& quad : quads)
    {
        const int mask = std::max(rng.uniform(0, 256) & masksOfChannels[quad[1]], 1);
        selection.push_back(Mat_<int>({quad[0], quad[1], quad[2], quad[3], mask}).reshape(1, 1));
    }
    return selection;
}

int differingBits(const Mat& a, const Mat& b)
{
    EXPECT_EQ(a.size(), b.size());
    EXPECT_EQ(a.type(), b.type());
    return a.size() == b.size() && !a.empty() ? cvRound(cvtest::norm(a, b, NORM_HAMMING)) : -1;
}

void expectSameKeyPoints(const std::vector<KeyPoint>& expected, const std::vector<KeyPoint>& actual)
{
    ASSERT_EQ(expected.size(), actual.size());
    for (size_t i = 0; i < expected.size(); i++)
    {
        EXPECT_EQ(expected[i].pt, actual[i].pt);
        EXPECT_EQ(expected[i].size, actual[i].size);
        EXPECT_EQ(expected[i].angle, actual[i].angle);
        EXPECT_EQ(expected[i].response, actual[i].response);
        EXPECT_EQ(expected[i].octave, actual[i].octave);
        EXPECT_EQ(expected[i].class_id, actual[i].class_id);
    }
}

int countCorrect(const std::vector<DMatch>& matches, const std::vector<KeyPoint>& queries,
        const std::vector<KeyPoint>& trains, const Matx33d& homography)
{
    int count = 0;
    for (const DMatch& m : matches)
    {
        const Point2d p = queries[m.queryIdx].pt, q = trains[m.trainIdx].pt;
        const Vec3d there = homography * Vec3d(p.x, p.y, 1);
        count += std::hypot(there[0] / there[2] - q.x, there[1] / there[2] - q.y) <= 3;
    }
    return count;
}

RotatedPair::RotatedPair(double degrees, double zoom) : homography(Matx33d::eye())
{
    images[0] = scene(Size(400, 400), 7);
    const Mat affine = getRotationMatrix2D(Point2f(199.5f, 199.5f), -degrees, zoom);
    affine.copyTo(Mat(homography, false).rowRange(0, 2));
    Mat rotated;
    warpAffine(images[0], rotated, affine, images[0].size(), INTER_CUBIC, cv::BORDER_REFLECT_101);
    images[1] = relit(rotated, 8);
    for (int i = 0; i < 2; i++)
        ORB::create(600)->detect(images[i], keypoints[i]);
}

uint64 hashOf(const Mat& m)
{
    uint64 hash = CV_BIG_UINT(0xcbf29ce484222325);
    for (int y = 0; y < m.rows; y++)
        for (size_t i = 0; i < m.cols * m.elemSize(); i++)
            hash = (hash ^ m.ptr(y)[i]) * CV_BIG_UINT(0x100000001b3);
    return hash;
}

int RotatedPair::correct(const std::vector<DMatch>& matches) const
{
    return countCorrect(matches, keypoints[0], keypoints[1], homography);
}

}  // namespace opencv_test

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "test_images.hpp"

#include <fstream>

namespace opencv_test {

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

int RotatedPair::correct(const std::vector<DMatch>& matches) const
{
    return countCorrect(matches, keypoints[0], keypoints[1], homography);
}

}  // namespace opencv_test

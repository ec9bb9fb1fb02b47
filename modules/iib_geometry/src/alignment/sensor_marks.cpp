// SPDX-License-Identifier: Apache-2.0
#include "sensor_marks.hpp"

#include "../precomp.hpp"
#include "opencv2/imgproc.hpp"

namespace cv::iib {
namespace {

const double STILL = .5;  // working pixels by which the image of the sensor moves at most
const double MOST_AROUND =
        .25;  // of a single pixel's height, in the four pixels beside it; a sharp star has .4
const double LEAST_SINGLE = .5;  // of the matches that agree
const double MOST_LARGER = .5;   // share of larger points that agree, over that of single pixels

//! Whether the highest or lowest pixel at a point stands alone.
bool isSinglePixel(const Mat& image, const Point2d& point)
{
    const int ring = 2;
    const Point at(cvRound(point.x), cvRound(point.y));
    const Rect inside(ring + 1, ring + 1, image.cols - 2 * ring - 2, image.rows - 2 * ring - 2);
    if (!inside.contains(at))
        return false;
    std::vector<float> around;
    for (int k = -ring; k <= ring; k++)
        for (const Point& p : {Point(k, -ring), Point(k, ring), Point(-ring, k), Point(ring, k)})
            around.push_back(image.at<float>(at + p));
    std::nth_element(around.begin(), around.begin() + around.size() / 2, around.end());
    const Mat heights = abs(image(Rect(at.x - 2, at.y - 2, 5, 5)) - around[around.size() / 2]);
    double height;
    Point top;
    minMaxLoc(heights(Rect(1, 1, 3, 3)), nullptr, &height, nullptr, &top);
    const Mat cross = (Mat_<float>(3, 3) << 0, 1, 0, 1, 0, 1, 0, 1, 0);
    return heights(Rect(top, Size(3, 3))).dot(cross) / 4 < MOST_AROUND * height;
}

}  // namespace

bool areOfTheSensor(const FittedTransform& fitted, const Evidence& evidence)
{
    const AlignedPoints agreeing = marked(evidence.points, fitted.agree);
    if (agreeing.reference.empty() ||
            !(norm(mean(Mat(agreeing.reference - agreeing.image).reshape(2))) < STILL))
        return false;
    Mat image = evidence.pair.sameView();
    if (image.empty())
        return false;
    if (image.channels() > 1)
        cvtColor(image, image, image.channels() == 4 ? COLOR_BGRA2GRAY : COLOR_BGR2GRAY);
    image.convertTo(image, CV_32F);
    double single = 0, larger = 0, allSingle = 1, allLarger = 1;
    for (int i = 0; i < agreeing.reference.rows; i++)
        (isSinglePixel(image, agreeing.reference.at<Point2d>(i)) ? single : larger)++;
    if (single < LEAST_SINGLE * (single + larger))
        return false;
    for (const KeyPoint& keypoint : evidence.points.keypoints[0])
        (isSinglePixel(image, keypoint.pt) ? allSingle : allLarger)++;
    return larger / allLarger < MOST_LARGER * single / allSingle;
}

}  // namespace cv::iib

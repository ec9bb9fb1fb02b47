// SPDX-License-Identifier: Apache-2.0
#include "opencv2/imgproc.hpp"
#include "judgement.hpp"

namespace cv::iib {
namespace {

const double STILL = .5;        // working pixels by which the image of the sensor moves at most
const int MOST_PIXELS = 9;      // of a mark that reach a quarter of its height; a star has 15
const double LEAST_MARKS = .3;  // of the matches that agree
const double MOST_LARGER = .5;  // share of larger points that agree, over that of marks

//! Whether hardly any pixel around a point is as bright or dark as the pixel there.
bool isMark(const Mat& image, const Point2d& point)
{
    const int ring = 3;
    const Point at(cvRound(point.x), cvRound(point.y));
    if (!Rect(ring, ring, image.cols - 2 * ring, image.rows - 2 * ring).contains(at))
        return false;
    std::vector<float> around;
    for (int k = -ring; k <= ring; k++)
        for (const Point& p : {Point(k, -ring), Point(k, ring), Point(-ring, k), Point(ring, k)})
            around.push_back(image.at<float>(at + p));
    const Mat heights = abs(image(Rect(at.x - 3, at.y - 3, 7, 7)) - median(around));
    double height;
    minMaxLoc(heights(Rect(2, 2, 3, 3)), nullptr, &height);
    return countNonZero(heights > height / 4) <= MOST_PIXELS;
}

}  // namespace

bool areOfTheSensor(const FittedTransform& fitted, const Evidence& evidence)
{
    const AlignedPoints agreeing = marked(evidence.points, fitted.agree);
    if (agreeing.reference.empty() ||
            !(norm(mean(Mat(Mat(agreeing.reference) - Mat(agreeing.image)))) < STILL))
        return false;
    Mat image = evidence.pair.sameView();
    if (image.empty())
        return false;
    if (image.channels() > 1)
        cvtColor(image, image, image.channels() == 4 ? COLOR_BGRA2GRAY : COLOR_BGR2GRAY);
    image.convertTo(image, CV_32F);
    double marks = 0, larger = 0, allMarks = 1, allLarger = 1;
    for (const Point2d& point : agreeing.reference)
        (isMark(image, point) ? marks : larger)++;
    if (marks < LEAST_MARKS * (marks + larger))
        return false;
    for (const KeyPoint& keypoint : evidence.points.keypoints[0])
        (isMark(image, keypoint.pt) ? allMarks : allLarger)++;
    return larger / allLarger < MOST_LARGER * marks / allMarks;
}

}  // namespace cv::iib

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
    around.reserve(8 * ring + 4);
    for (int k = -ring; k <= ring; k++)
        for (const Point& p : {Point(k, -ring), Point(k, ring), Point(-ring, k), Point(ring, k)})
            around.push_back(image.at<float>(at + p));
    const float middle = median(around);
    const auto height = [&](int x, int y) { return std::abs(image.at<float>(at.y + y, at.x + x) - middle); };
    float highest = 0;
    for (int k = 0; k < 9; k++)
        highest = std::max(highest, height(k % 3 - 1, k / 3 - 1));
    int pixels = 0;
    for (int k = 0; k < 49; k++)
        pixels += height(k % 7 - ring, k / 7 - ring) > highest / 4;
    return pixels <= MOST_PIXELS;
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
    const double count = (double)agreeing.reference.size();
    double larger = 0, allMarks = 1, allLarger = 1;
    for (const Point2d& point : agreeing.reference)
    {
        larger += !isMark(image, point);
        if (count - larger < LEAST_MARKS * count)
            return false;
    }
    for (const KeyPoint& keypoint : evidence.points.keypoints[0])
        (isMark(image, keypoint.pt) ? allMarks : allLarger)++;
    return larger / allLarger < MOST_LARGER * (count - larger) / allMarks;
}

}  // namespace cv::iib

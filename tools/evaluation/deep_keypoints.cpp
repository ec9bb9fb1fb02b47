// SPDX-License-Identifier: Apache-2.0

#include "deep_keypoints.hpp"

#include <algorithm>
#include <cmath>

#include "opencv2/imgproc.hpp"

namespace iib_tools {
namespace {

const int MULTIPLE = 32;  // networks that pool five times want it of width and height

//! What the authors do to find keypoints in their maps of scores.
struct PostProcessing
{
    int radius;                   //!< of non-maximum suppression, pixels
    int borderBefore, borderEnd;  //!< pixels left out at the top and left, and at the bottom and right
    bool refine;                  //!< to the mean position of the scores' softmax around a maximum
};
const PostProcessing SUPERPOINT = {4, 4, 4, false}, ALIKE = {2, 3, 2, true};
const int SUPPRESSIONS = 2;      // rounds in which what others suppressed comes back if those are suppressed
const float TEMPERATURE = 0.1f;  // of ALIKE's softmax

//! What the outputs hold; empty where the network does not give it.
struct Outputs
{
    cv::Mat scoreMap;       // H x W
    PostProcessing how;     // of the map of scores
    cv::Mat points;         // N x 2
    cv::Mat scores;         // N x 1
    cv::Mat descriptors;    // N x D
    cv::Mat descriptorMap;  // 1 x D x h x w
};

//! SuperPoint: softmax over 65 logits, the first 64 are the pixels of an 8 x 8 cell, row by row.
cv::Mat cellScores(const cv::Mat& logits)
{
    const int h = logits.size[2], w = logits.size[3];
    const float* data = logits.ptr<float>();
    cv::Mat scores(8 * h, 8 * w, CV_32F);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
        {
            float largest = data[y * w + x], sum = 0;
            for (int c = 1; c < 65; c++)
                largest = std::max(largest, data[(c * h + y) * w + x]);
            for (int c = 0; c < 65; c++)
                sum += std::exp(data[(c * h + y) * w + x] - largest);
            for (int c = 0; c < 64; c++)
                scores.at<float>(8 * y + c / 8, 8 * x + c % 8) =
                        std::exp(data[(c * h + y) * w + x] - largest) / sum;
        }
    return scores;
}

Outputs sortOutputs(const std::vector<cv::Mat>& mats, cv::Size size)
{
    Outputs out;
    out.how = ALIKE;
    std::vector<cv::Mat> lists;
    for (const cv::Mat& m : mats)
    {
        std::vector<int> shape(m.size.p, m.size.p + m.dims);
        if (shape.size() == 4 && shape[1] == 65)
        {
            out.scoreMap = cellScores(m);
            out.how = SUPERPOINT;
        }
        else if (shape.size() >= 3 && int(m.total()) == size.area() && shape.back() == size.width)
            out.scoreMap = m.reshape(1, size.height);
        else if (shape.size() == 4)
            out.descriptorMap = m;
        else if (shape.size() <= 3 && m.total() > 0)
            lists.push_back(shape.size() == 3 ? m.reshape(1, shape[1]) : m);
    }
    for (const cv::Mat& list : lists)
        if (list.cols == 2)
            out.points = list;
    for (const cv::Mat& list : lists)
        if (int(list.total()) == out.points.rows)
            out.scores = list.reshape(1, out.points.rows);
        else if (list.cols > 2 && list.rows == out.points.rows)
            out.descriptors = list;
    return out;
}

cv::Mat highestAround(const cv::Mat& map, int radius)
{
    cv::Mat highest;
    cv::dilate(map, highest, cv::Mat::ones(2 * radius + 1, 2 * radius + 1, CV_8U));
    return highest;
}

//! 255 where a score is the highest around, or the highest of those that no such maximum suppresses.
cv::Mat maximaMask(const cv::Mat& scores, int radius)
{
    cv::Mat found = scores == highestAround(scores, radius);
    for (int round = 0; round < SUPPRESSIONS; round++)
    {
        const cv::Mat suppressed = highestAround(found, radius);
        cv::Mat rest = scores.clone();
        rest.setTo(0, suppressed);
        found |= (rest == highestAround(rest, radius)) & ~suppressed;
    }
    return found;
}

//! The mean of the pixels around, weighted by their scores' softmax.
cv::Point2f refined(const cv::Mat& scores, int x, int y, int radius)
{
    float sum = 0, sumX = 0, sumY = 0;
    for (int dy = -radius; dy <= radius; dy++)
        for (int dx = -radius; dx <= radius; dx++)
        {
            const float weight =
                    std::exp((scores.at<float>(y + dy, x + dx) - scores.at<float>(y, x)) / TEMPERATURE);
            sum += weight;
            sumX += weight * float(dx);
            sumY += weight * float(dy);
        }
    return cv::Point2f(float(x) + sumX / sum, float(y) + sumY / sum);
}

std::vector<cv::KeyPoint> maxima(const cv::Mat& scores, const PostProcessing& how)
{
    const cv::Mat mask = maximaMask(scores, how.radius);
    std::vector<cv::KeyPoint> found;
    for (int y = how.borderBefore; y < scores.rows - how.borderEnd; y++)
        for (int x = how.borderBefore; x < scores.cols - how.borderEnd; x++)
            if (mask.at<uchar>(y, x) && scores.at<float>(y, x) > 0)
            {
                const cv::Point2f at =
                        how.refine ? refined(scores, x, y, how.radius) : cv::Point2f(float(x), float(y));
                found.push_back(cv::KeyPoint(at, 1, -1, scores.at<float>(y, x)));
            }
    return found;
}

//! Keypoints of a list; class_id is the row.
std::vector<cv::KeyPoint> listed(const Outputs& out, cv::Size size)
{
    double low = 0, high = 0;
    cv::minMaxLoc(out.points, &low, &high);
    const bool relative = low >= -1 && high <= 1;
    std::vector<cv::KeyPoint> found;
    for (int i = 0; i < out.points.rows; i++)
    {
        float x = out.points.at<float>(i, 0), y = out.points.at<float>(i, 1);
        if (relative)
        {
            x = (x + 1) / 2 * float(size.width - 1);
            y = (y + 1) / 2 * float(size.height - 1);
        }
        found.push_back(cv::KeyPoint(x, y, 1, -1, out.scores.empty() ? 1.f : out.scores.at<float>(i), 0, i));
    }
    return found;
}

/** Bilinear sample of a descriptor map. The authors of SuperPoint put its corners' centres on the centres of the
image's first and last cells, but for half a pixel at the end; a map of the image's size is sampled at the points. */
cv::Mat sampleMap(const cv::Mat& map, const std::vector<cv::KeyPoint>& keypoints, cv::Size size)
{
    const int depth = map.size[1], h = map.size[2], w = map.size[3];
    const auto place = [](float at, int cells, int pixels) {
        const float cell = float(pixels) / float(cells);
        if (cells == pixels)
            return at;
        return (at - cell / 2 + 0.5f) / (float(pixels) - cell / 2 - 0.5f) * float(cells - 1);
    };
    cv::Mat mapX(1, int(keypoints.size()), CV_32F), mapY(1, int(keypoints.size()), CV_32F);
    for (int i = 0; i < mapX.cols; i++)
    {
        mapX.at<float>(i) = place(keypoints[i].pt.x, w, size.width);
        mapY.at<float>(i) = place(keypoints[i].pt.y, h, size.height);
    }
    cv::Mat descriptors(mapX.cols, depth, CV_32F);
    for (int c = 0; c < depth; c++)
    {
        cv::Mat sampled;
        cv::remap(cv::Mat(h, w, CV_32F, const_cast<float*>(map.ptr<float>(0, c))), sampled, mapX, mapY,
                cv::INTER_LINEAR, cv::BORDER_REPLICATE);
        cv::Mat(sampled.t()).copyTo(descriptors.col(c));
    }
    return descriptors;
}

}  // namespace

DeepDetector::DeepDetector(const std::string& file) : channels_(0), hasDescriptors_(false)
{
    net_ = cv::dnn::readNetFromONNX(file);
    const cv::Mat probe(8 * MULTIPLE, 8 * MULTIPLE, CV_8UC1, cv::Scalar(128));
    for (int channels : {1, 3})
        try
        {
            channels_ = channels;
            const Outputs out = sortOutputs(forward(probe), probe.size());
            hasDescriptors_ = !out.descriptors.empty() || !out.descriptorMap.empty();
            if (!out.scoreMap.empty() || !out.points.empty())
                return;
        }
        catch (const cv::Exception&)  // an input of the other number of channels
        {
        }
    CV_Error(cv::Error::StsBadArg, file + ": no keypoint network for grey or colour images of any size");
}

std::vector<cv::Mat> DeepDetector::forward(const cv::Mat& padded)
{
    cv::Mat input = padded;
    if (channels_ == 3)
        cv::cvtColor(padded, input, cv::COLOR_GRAY2BGR);
    net_.setInput(cv::dnn::blobFromImage(input, 1. / 255));
    std::vector<cv::Mat> outputs, copies;
    net_.forward(outputs, net_.getUnconnectedOutLayersNames());
    for (const cv::Mat& output : outputs)
        copies.push_back(output.clone());
    return copies;
}

DeepKeypoints DeepDetector::detect(const cv::Mat& image, int count)
{
    cv::Mat padded;
    cv::copyMakeBorder(image, padded, 0, cv::alignSize(image.rows, MULTIPLE) - image.rows, 0,
            cv::alignSize(image.cols, MULTIPLE) - image.cols, cv::BORDER_REPLICATE);
    std::vector<cv::Mat> mats;
    {
        std::lock_guard<std::mutex> lock(mutex_);
        mats = forward(padded);
    }
    const Outputs out = sortOutputs(mats, padded.size());
    DeepKeypoints result;
    // The padding is no part of the image, nor of its border.
    const cv::Rect inside(cv::Point(), image.size());
    const std::vector<cv::KeyPoint> found =
            out.points.empty() ? maxima(out.scoreMap(inside), out.how) : listed(out, padded.size());
    for (const cv::KeyPoint& k : found)
        if (k.pt.x >= 0 && k.pt.y >= 0 && k.pt.x <= float(image.cols - 1) && k.pt.y <= float(image.rows - 1))
            result.keypoints.push_back(k);
    std::stable_sort(result.keypoints.begin(), result.keypoints.end(),
            [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.response > b.response; });
    result.keypoints.resize(std::min(result.keypoints.size(), size_t(count)));
    if (result.keypoints.empty())
        return result;

    if (!out.descriptorMap.empty())
        result.descriptors = sampleMap(out.descriptorMap, result.keypoints, padded.size());
    else if (!out.descriptors.empty())
        for (const cv::KeyPoint& k : result.keypoints)
            result.descriptors.push_back(out.descriptors.row(k.class_id));
    for (int i = 0; i < result.descriptors.rows; i++)
        cv::normalize(result.descriptors.row(i), result.descriptors.row(i));
    return result;
}

}  // namespace iib_tools

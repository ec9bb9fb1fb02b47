// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "deep_keypoints.hpp"

#include <algorithm>
#include <cmath>

#include "opencv2/imgproc.hpp"

namespace iib_tools {
namespace {

const int MULTIPLE = 32;   // networks that pool five times want it of width and height
const int SEPARATION = 4;  // pixels between maxima of a score map

//! What the outputs hold; empty where the network does not give it.
struct Outputs
{
    cv::Mat scoreMap;       // H x W
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
    std::vector<cv::Mat> lists;
    for (const cv::Mat& m : mats)
    {
        std::vector<int> shape(m.size.p, m.size.p + m.dims);
        if (shape.size() == 4 && shape[1] == 65)
            out.scoreMap = cellScores(m);
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

//! Local maxima of a score map.
std::vector<cv::KeyPoint> maxima(const cv::Mat& scores)
{
    cv::Mat highest;
    const int side = 2 * SEPARATION + 1;
    cv::dilate(scores, highest, cv::Mat::ones(side, side, CV_8U));
    std::vector<cv::KeyPoint> found;
    for (int y = 0; y < scores.rows; y++)
        for (int x = 0; x < scores.cols; x++)
        {
            const float s = scores.at<float>(y, x);
            if (s > 0 && s == highest.at<float>(y, x))
                found.push_back(cv::KeyPoint(float(x), float(y), 1, -1, s));
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

//! Bilinear sample of a descriptor map, whose cells' centres are spread evenly over the image.
cv::Mat sampleMap(const cv::Mat& map, const std::vector<cv::KeyPoint>& keypoints, cv::Size size)
{
    const int depth = map.size[1], h = map.size[2], w = map.size[3];
    cv::Mat mapX(1, int(keypoints.size()), CV_32F), mapY(1, int(keypoints.size()), CV_32F);
    for (int i = 0; i < mapX.cols; i++)
    {
        mapX.at<float>(i) = (keypoints[i].pt.x + 0.5f) * float(w) / float(size.width) - 0.5f;
        mapY.at<float>(i) = (keypoints[i].pt.y + 0.5f) * float(h) / float(size.height) - 0.5f;
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
    for (const cv::KeyPoint& k : out.points.empty() ? maxima(out.scoreMap) : listed(out, padded.size()))
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

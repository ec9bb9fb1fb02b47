// SPDX-License-Identifier: Apache-2.0

#include "line_features.hpp"

#include "opencv2/imgproc.hpp"

#ifdef IIB_HAVE_LINE_DESCRIPTOR
#include "opencv2/line_descriptor.hpp"
#endif

namespace iib_localization {
namespace {

constexpr int CODE_BYTES = 32;

LineFeatures noLines()
{
    LineFeatures features;
    features.codes.create(0, CODE_BYTES, CV_8U);
    return features;
}

}  // namespace

#ifdef IIB_HAVE_LINE_DESCRIPTOR
namespace {

// LSD works on the image scaled by 0.8 and divides coordinates by it, as if the middle of the first pixel stayed where it
// was; cv::resize leaves the image's corner where it was.
constexpr float LSD_SCALE = 0.8f;
constexpr float LSD_OFFSET = 0.5f / LSD_SCALE - 0.5f;
constexpr float MIN_LENGTH = 20;  // pixels

cv::line_descriptor::KeyLine keyLine(const cv::Vec4f& s, int index)
{
    cv::line_descriptor::KeyLine line;
    line.startPointX = line.sPointInOctaveX = s[0];
    line.startPointY = line.sPointInOctaveY = s[1];
    line.endPointX = line.ePointInOctaveX = s[2];
    line.endPointY = line.ePointInOctaveY = s[3];
    line.pt = {(s[0] + s[2]) / 2, (s[1] + s[3]) / 2};
    line.angle = std::atan2(s[3] - s[1], s[2] - s[0]);
    line.lineLength = std::hypot(s[2] - s[0], s[3] - s[1]);
    line.numOfPixels = cvRound(line.lineLength);
    line.size = line.response = 0;  // not looked at
    line.octave = 0;
    line.class_id = index;
    return line;
}

}  // namespace

bool linesAvailable() { return true; }

LineFeatures extractLines(const cv::Mat& grey)
{
    LineFeatures features = noLines();
    std::vector<cv::Vec4f> found;
    cv::createLineSegmentDetector(cv::LSD_REFINE_STD, LSD_SCALE)->detect(grey, found);
    std::vector<cv::line_descriptor::KeyLine> lines;
    for (const cv::Vec4f& raw : found)
    {
        const cv::Vec4f s = raw + cv::Vec4f::all(LSD_OFFSET);
        if (std::hypot(s[2] - s[0], s[3] - s[1]) < MIN_LENGTH)
            continue;
        lines.push_back(keyLine(s, int(lines.size())));
        features.segments.push_back({{s[0], s[1]}, {s[2], s[3]}});
    }
    if (!lines.empty())
        cv::line_descriptor::BinaryDescriptor::createBinaryDescriptor()->compute(grey, lines, features.codes);
    return features;
}
#else
bool linesAvailable() { return false; }

LineFeatures extractLines(const cv::Mat&) { return noLines(); }
#endif

std::vector<Segment> undistorted(const std::vector<Segment>& segments, const Camera& camera)
{
    std::vector<cv::Point2f> ends;
    for (const Segment& s : segments)
        for (const Eigen::Vector2d& p : {s.begin, s.end})
            ends.emplace_back(float(p.x()), float(p.y()));
    const std::vector<Eigen::Vector2d> straight = camera.undistorted(ends);
    std::vector<Segment> result;
    for (size_t i = 0; i < segments.size(); i++)
        result.push_back({straight[2 * i], straight[2 * i + 1]});
    return result;
}

}  // namespace iib_localization

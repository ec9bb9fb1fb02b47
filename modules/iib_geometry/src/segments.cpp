// SPDX-License-Identifier: Apache-2.0

#include "lines.hpp"

#include "opencv2/core/hal/hal.hpp"
#ifdef IIB_LINE_DESCRIPTOR
#include "opencv2/imgproc.hpp"
#include "opencv2/line_descriptor.hpp"
#endif

namespace iib_localization {

#ifdef IIB_LINE_DESCRIPTOR
namespace {

// LSD looks at the image scaled by 0.8 and divides coordinates by it, as if the middle of the first pixel stayed where it
// was; cv::resize keeps the image's corner.
constexpr float LSD_SCALE = .8f, LSD_OFFSET = .5f / LSD_SCALE - .5f;
constexpr float MIN_LENGTH = 20;  // pixels

}  // namespace

void needLines() {}

Segments findSegments(const Picture& picture)
{
    Segments segments;
    if (picture.pixels.empty())
        return segments;
    std::vector<cv::Vec4f> found;
    std::vector<cv::line_descriptor::KeyLine> lines;
    cv::createLineSegmentDetector(cv::LSD_REFINE_STD, LSD_SCALE)->detect(picture.pixels, found);
    for (const cv::Vec4f& raw : found)
    {
        const cv::Vec4f s = raw + cv::Vec4f::all(LSD_OFFSET);
        cv::line_descriptor::KeyLine line;
        line.lineLength = std::hypot(s[2] - s[0], s[3] - s[1]);
        if (line.lineLength < MIN_LENGTH)
            continue;
        line.startPointX = line.sPointInOctaveX = s[0];
        line.startPointY = line.sPointInOctaveY = s[1];
        line.endPointX = line.ePointInOctaveX = s[2];
        line.endPointY = line.ePointInOctaveY = s[3];
        line.pt = {(s[0] + s[2]) / 2, (s[1] + s[3]) / 2};
        line.angle = std::atan2(s[3] - s[1], s[2] - s[0]);
        line.numOfPixels = cvRound(line.lineLength);
        line.size = line.response = 0;  // not looked at
        line.octave = 0;
        line.class_id = int(lines.size());
        lines.push_back(line);
        const auto pixel = [&](float x, float y) {
            return cv::Point2d((x + .5) / picture.scale - .5, (y + .5) / picture.scale - .5);
        };
        segments.places.push_back({pixel(s[0], s[1]), pixel(s[2], s[3])});
    }
    if (!lines.empty())
        cv::line_descriptor::BinaryDescriptor::createBinaryDescriptor()->compute(
                picture.pixels, lines, segments.codes);
    CV_Assert(segments.codes.rows == int(segments.places.size()));
    return segments;
}
#else
void needLines()
{
    CV_Error(cv::Error::StsNotImplemented, "lines need OpenCV's module line_descriptor, without which this "
                                           "was built: install opencv_contrib (on Debian "
                                           "and Ubuntu: libopencv-contrib-dev) and build again");
}

Segments findSegments(const Picture&)
{
    needLines();
    return Segments();
}
#endif

int codeDistance(const cv::Mat& a, int rowA, const cv::Mat& b, int rowB)
{
    return cv::hal::normHamming(a.ptr(rowA), b.ptr(rowB), a.cols);
}

}  // namespace iib_localization

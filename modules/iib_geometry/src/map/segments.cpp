// SPDX-License-Identifier: Apache-2.0

#include "segments.hpp"

#ifdef IIB_LINE_DESCRIPTOR
#include "opencv2/line_descriptor.hpp"
#endif

namespace cv::iib {

Segments findSegments(const Picture& picture)
{
    Segments segments;
#ifdef IIB_LINE_DESCRIPTOR
    using namespace line_descriptor;
    // LSD scales the image by 0.8 about its corner, but divides coordinates as if the first pixel's centre stayed
    // fixed.
    const double shift = .5 / .8 - .5, minLength = 20;
    if (picture.pixels.empty())
        return segments;
    std::vector<KeyLine> found, lines;
    LSDDetector::createLSDDetector()->detect(picture.pixels, found, 2, 1);
    for (KeyLine& line : found)
        if (line.lineLength >= minLength)
        {
            const auto pixel = [&](float x, float y) {
                return Point2d((x + shift + .5) / picture.scale - .5, (y + shift + .5) / picture.scale - .5);
            };
            segments.places.push_back(
                    {pixel(line.startPointX, line.startPointY), pixel(line.endPointX, line.endPointY)});
            line.class_id = int(lines.size());
            lines.push_back(line);
        }
    if (!lines.empty())
        BinaryDescriptor::createBinaryDescriptor()->compute(picture.pixels, lines, segments.codes);
    CV_Assert(segments.codes.rows == int(segments.places.size()));
    return segments;
#else
    CV_UNUSED(picture);
    CV_Error(Error::StsNotImplemented,
            "this library was built without OpenCV's module line_descriptor, which lines need: install "
            "opencv_contrib (on Debian and Ubuntu: libopencv-contrib-dev) and build again");
#endif
}

}  // namespace cv::iib

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "parameters_file.hpp"

#include "../common/file_numbers.hpp"

namespace cv {
namespace iib {

void writeParameters(FileStorage& fs, const Parameters& p)
{
    fs << "format" << 1 << "scaleFactor" << p.scaleFactor << "granularity" << p.granularity << "channels"
       << p.channels << "mapping" << p.mapping << "overlap" << p.overlap << "useOrientation" << p.orientation
       << "extraChannels" << p.extraChannels << "border" << p.border;
    if (!p.selection.empty())
        fs << "selection" << std::vector<int>(p.selection.begin(), p.selection.end());
}

static Mat_<int> readSelection(const FileNode& node)
{
    if (node.empty())
        return Mat_<int>();
    if (!node.isSeq() || node.size() % 5 != 0)
        CV_Error(Error::StsParseError, "the selection is " + describeNode(node) +
                                               "; it must be a sequence of rows of 5 whole numbers");
    Mat_<int> quads((int)node.size() / 5, 5);
    int i = 0;
    for (const FileNode& number : node)
    {
        quads(i / 5, i % 5) = numberOf<int>(number, format("number %d of the selection", i));
        i++;
    }
    return quads;
}

Parameters readParameters(const FileNode& fn, const Parameters& present)
{
    const FileNode version = fn.isMap() ? fn["format"] : FileNode();
    if (version.empty())
        CV_Error(Error::StsParseError, "the node holds no IIB parameters: it is " + describeNode(fn) +
                                               ", without a format; give it the node that write() wrote");
    int format = 0;
    readNumber(fn, "format", format);
    if (format != 1)
        CV_Error(Error::StsParseError,
                cv::format("the node has format %d; this version reads IIB parameters of format 1", format));
    Parameters p = present;
    readNumber(fn, "scaleFactor", p.scaleFactor);
    readNumber(fn, "granularity", p.granularity);
    readNumber(fn, "channels", p.channels);
    readNumber(fn, "mapping", p.mapping);
    readNumber(fn, "overlap", p.overlap);
    readNumber(fn, "useOrientation", p.orientation);  // 0 and 1 once were false and true
    readNumber(fn, "extraChannels", p.extraChannels);
    readNumber(fn, "border", p.border);
    p.selection = readSelection(fn["selection"]);
    p.check();
    return p;
}

}  // namespace iib
}  // namespace cv

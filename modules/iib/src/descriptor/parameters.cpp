// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "parameters.hpp"

#include <array>
#include <set>

#include "../common/file_numbers.hpp"

namespace cv { namespace iib {

static void checkBoxes(const Parameters& p)
{
    require(p.granularity <= BOX_LEVELS, "granularity", p.granularity, "1 to 5 with MAPPING_BOXES");
    if ((p.channels & IIB::CHANNEL_ORIENTATION) || p.extraChannels != 0)
        CV_Error(Error::StsBadArg,
                "MAPPING_BOXES takes neither CHANNEL_ORIENTATION nor extra channels; set others first");
    if (p.overlap)
        CV_Error(Error::StsBadArg, "boxes always overlap; set overlap to false for MAPPING_BOXES");
}

static void checkSelection(const Parameters& p)
{
    const std::vector<int> kinds = p.channelKinds();
    const int channels = (int)kinds.size();
    int last = 1;
    std::set<std::array<int, 4>> seen;
    for (int i = 0; i < p.selection.rows; i++)
    {
        const int* quad = p.selection[i];
        const int level = quad[0], channel = quad[1], row = quad[2], col = quad[3], bits = quad[4];
        const auto refuse = [i](const String& why) {
            CV_Error(Error::StsOutOfRange, format("selection, row %d: ", i) + why);
        };
        if (level < last || level > p.granularity)
            refuse(format("level %d is not in %d..%d (levels must not descend)", level, last, p.granularity));
        if (channel < 0 || channel >= channels)
            refuse(format("channel %d is not in 0..%d", channel, channels - 1));
        const int n = placesInRow(p.mapping, level);
        if (row < 0 || row >= n || col < 0 || col >= n)
            refuse(format("cell (%d, %d) is not in 0..%d", row, col, n - 1));
        const int mask = bitsOfPlace(p.mapping, kinds[channel], level, row, col);
        if (bits <= 0 || (bits & ~mask) != 0)
            refuse(format("bit mask %d must have some of the bits of %d and no others", bits, mask));
        if (!seen.insert(std::array<int, 4>{{level, channel, row, col}}).second)
            CV_Error(Error::StsBadArg, format("selection, row %d repeats a quad", i));
        last = level;
    }
}

void Parameters::check() const
{
    require(scaleFactor > 0 && scaleFactor <= FLT_MAX, "scaleFactor", scaleFactor,
            "positive and finite (see scaleFactorFor)");
    require(granularity >= 1 && granularity <= MAX_GRANULARITY, "granularity", granularity, "1 to 6");
    require((channels & ~ALL_CHANNELS) == 0, "channels", channels, "a sum of CHANNEL_ values",
            Error::StsBadArg);
    require(mapping >= IIB::MAPPING_MEAN && mapping <= IIB::MAPPING_BOXES, "mapping", mapping,
            "one of the MAPPING_ values", Error::StsBadArg);
    require(extraChannels >= 0 && extraChannels <= MAX_EXTRA_CHANNELS, "extraChannels", extraChannels,
            "0 to 16");
    if (channelCount() == 0)
        CV_Error(Error::StsBadArg, "there are neither channels nor extraChannels to describe");
    require(border >= IIB::BORDER_CLAMP && border <= IIB::BORDER_REFLECT, "border", border,
            "one of the BORDER_ values", Error::StsBadArg);
    require(orientation >= IIB::ORIENTATION_NONE && orientation <= IIB::ORIENTATION_GRADIENT, "orientation",
            orientation, "one of the ORIENTATION_ values", Error::StsBadArg);
    if (mapping == IIB::MAPPING_BOXES)
        checkBoxes(*this);
    checkSelection(*this);
}

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

Parameters readParameters(const FileNode& node, const Parameters& present)
{
    const FileNode fn = nodeOfFormat1(node, "IIB");
    Parameters p = present;
    readNumber(fn, "scaleFactor", p.scaleFactor);
    readNumber(fn, "granularity", p.granularity);
    readNumber(fn, "channels", p.channels);
    readNumber(fn, "mapping", p.mapping);
    readNumber(fn, "overlap", p.overlap);
    readNumber(fn, "useOrientation", p.orientation);  // 0 and 1 in old files mean false and true
    readNumber(fn, "extraChannels", p.extraChannels);
    readNumber(fn, "border", p.border);
    p.selection = readSelection(fn["selection"]);
    p.check();
    return p;
}

}}  // namespace cv::iib

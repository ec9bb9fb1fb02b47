// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "parameters.hpp"

#include <array>
#include <bitset>
#include <set>

#include "../common/file_numbers.hpp"

namespace cv {
namespace iib {

static void require(bool ok, Error::Code code, const String& message)
{
    if (!ok)
        CV_Error(code, message);
}

static void checkBoxes(const Parameters& p)
{
    require(p.granularity <= BOX_LEVELS, Error::StsOutOfRange,
            format("granularity is %d; of MAPPING_BOXES it must be 1 to %d", p.granularity, BOX_LEVELS));
    require((p.channels & IIB::CHANNEL_ORIENTATION) == 0 && p.extraChannels == 0, Error::StsBadArg,
            "MAPPING_BOXES takes neither CHANNEL_ORIENTATION nor extra channels; set others first");
    require(!p.overlap, Error::StsBadArg, "boxes always overlap; set overlap to false for MAPPING_BOXES");
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
        const String where = format("selection, row %d: ", i);
        require(level >= last && level <= p.granularity, Error::StsOutOfRange,
                where + format("level %d is not in %d..%d (levels must not descend)", level, last,
                                p.granularity));
        require(channel >= 0 && channel < channels, Error::StsOutOfRange,
                where + format("channel %d is not in 0..%d", channel, channels - 1));
        const int n = placesInRow(p.mapping, level);
        require(row >= 0 && row < n && col >= 0 && col < n, Error::StsOutOfRange,
                where + format("cell (%d, %d) is not in 0..%d", row, col, n - 1));
        const int mask = bitsOfPlace(p.mapping, kinds[channel], level, row, col);
        require(bits > 0 && (bits & ~mask) == 0, Error::StsOutOfRange,
                where + format("bit mask %d must have some of the bits of %d and no others", bits, mask));
        const std::array<int, 4> place = {{level, channel, row, col}};
        require(seen.insert(place).second, Error::StsBadArg, where + "the quad was given before");
        last = level;
    }
}

void Parameters::check() const
{
    require(scaleFactor > 0 && scaleFactor <= FLT_MAX, Error::StsOutOfRange,
            format("scaleFactor is %g; it must be positive and finite (see scaleFactorFor)", scaleFactor));
    require(granularity >= 1 && granularity <= MAX_GRANULARITY, Error::StsOutOfRange,
            format("granularity is %d; it must be 1 to %d", granularity, MAX_GRANULARITY));
    require((channels & ~ALL_CHANNELS) == 0, Error::StsBadArg,
            format("channels is %d, with unknown bits; it must be a sum of CHANNEL_ values", channels));
    require(mapping >= IIB::MAPPING_MEAN && mapping <= IIB::MAPPING_BOXES, Error::StsBadArg,
            format("mapping is %d; it must be one of the MAPPING_ values", mapping));
    require(extraChannels >= 0 && extraChannels <= MAX_EXTRA_CHANNELS, Error::StsOutOfRange,
            format("extraChannels is %d; it must be 0 to %d", extraChannels, MAX_EXTRA_CHANNELS));
    require(channelCount() > 0, Error::StsBadArg, "there are neither channels nor extraChannels to describe");
    require(border >= IIB::BORDER_CLAMP && border <= IIB::BORDER_REFLECT, Error::StsBadArg,
            format("border is %d; it must be one of the BORDER_ values", border));
    require(orientation >= IIB::ORIENTATION_NONE && orientation <= IIB::ORIENTATION_GRADIENT,
            Error::StsBadArg,
            format("orientation is %d; it must be one of the ORIENTATION_ values", orientation));
    if (mapping == IIB::MAPPING_BOXES)
        checkBoxes(*this);
    checkSelection(*this);
}

//! Bits of a level that the channels before `end` make.
static int bitsBefore(const Parameters& p, int level, int end)
{
    size_t bits = 0;
    forEachPlace(p, level, [&](int channel, int, int, int mask) {
        bits += channel < end ? std::bitset<32>((unsigned)mask).count() : 0;
    });
    return (int)bits;
}

//! Before they are padded to whole bytes.
static int bitsOfLevel(const Parameters& p, int level) { return bitsBefore(p, level, p.channelCount()); }

std::vector<int> levelBytes(const Parameters& p)
{
    std::vector<int> bytes;
    for (int level = 1; level <= p.granularity; level++)
        if (const int bits = bitsOfLevel(p, level))
            bytes.push_back((bits + 7) / 8);
    return bytes;
}

int bitOffset(const Parameters& p, int level, int group)
{
    int bytes = 0;
    for (int coarser = 1; coarser < level; coarser++)
        bytes += (bitsOfLevel(p, coarser) + 7) / 8;
    return 8 * bytes + bitsBefore(p, level, GROUP_CHANNELS * group);
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

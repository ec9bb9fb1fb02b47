// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "parameters.hpp"

#include <array>
#include <set>

#include "box_plan.hpp"

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
            format("granularity is %d; of MAPPING_BOXES it must be 1 to %d", p.granularity, (int)BOX_LEVELS));
    require((p.channels & IIB::CHANNEL_ORIENTATION) == 0 && p.extraChannels == 0, Error::StsBadArg,
            "MAPPING_BOXES takes neither CHANNEL_ORIENTATION nor extra channels; set others first");
    require(!p.overlap, Error::StsBadArg, "boxes always overlap; set overlap to false for MAPPING_BOXES");
}

static void checkSelection(const Parameters& p)
{
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
        require(channel >= 0 && channel < p.channelCount(), Error::StsOutOfRange,
                where + format("channel %d is not in 0..%d", channel, p.channelCount() - 1));
        const bool boxes = p.mapping == IIB::MAPPING_BOXES;
        const int end = boxes ? BOX_GRIDS[level - 1].n - 1 : (1 << level) - 2;
        require(row >= 0 && row <= end && col >= 0 && col <= end, Error::StsOutOfRange,
                where + format("cell (%d, %d) is not in 0..%d", row, col, end));
        const int mask = boxes ? boxMask(p, level, channel, row, col) : (1 << bitsPerQuad(p.mapping)) - 1;
        require(bits > 0 && (bits & ~mask) == 0, Error::StsOutOfRange,
                where + format("bit mask %d is not in 1..%d, or not of bits that are there (%d)", bits, mask,
                                mask));
        const std::array<int, 4> place = {{level, channel, row, col}};
        require(seen.insert(place).second, Error::StsBadArg, where + "the quad was given before");
        last = level;
    }
}

int bitsPerQuad(int mapping)
{
    switch (mapping)
    {
    case IIB::MAPPING_QUARTILE:
    case IIB::MAPPING_SORT: return 8;
    case IIB::MAPPING_HAAR: return 3;
    default: return 4;
    }
}

int Parameters::channelCount() const
{
    int count = extraChannels;
    for (int c = 1; c <= ALL_CHANNELS; c <<= 1)
        count += (channels & c) != 0;
    return count;
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

}  // namespace iib
}  // namespace cv

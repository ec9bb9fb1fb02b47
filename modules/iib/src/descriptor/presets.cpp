// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"

namespace cv {
namespace iib {

namespace {

struct LearnedSelection
{
    float scale;  // of the region of support, against the scale factor that the user gives
    int granularity, channels, mapping;
    const uchar (*quads)[5];  // null: all of them
    int count;
};

#include "presets.generated.hpp"

}  // namespace

Ptr<IIBDescriptorExtractor> IIBDescriptorExtractor::createPreset(int preset, float scaleFactor)
{
    const int presets = int(sizeof(PRESETS) / sizeof(PRESETS[0]));
    if (preset < 0 || preset >= presets)
        CV_Error(Error::StsBadArg,
                format("preset is %d; it must be one of the PRESET_ values, 0 to %d", preset, presets - 1));
    const LearnedSelection& p = PRESETS[preset];
    const Ptr<IIBDescriptorExtractor> extractor =
            create(p.scale * scaleFactor, p.granularity, p.channels, p.mapping);
    if (p.quads)
    {
        Mat_<int> selection(p.count, 5);
        for (int i = 0; i < p.count; i++)
            std::copy(p.quads[i], p.quads[i] + 5, selection[i]);
        extractor->setSelection(selection);
    }
    return extractor;
}

}  // namespace iib
}  // namespace cv

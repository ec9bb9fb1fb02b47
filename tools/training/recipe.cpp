// SPDX-License-Identifier: Apache-2.0

#include "recipe.hpp"

#include <array>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "opencv2/iib/detail/places.hpp"

namespace iib_tools {
namespace {

using cv::iib::IIB;

std::set<std::string> sceneNames(const std::vector<ImagePair>& pairs)
{
    std::set<std::string> names;
    for (const ImagePair& pair : pairs)
        names.insert(pair.set + "/" + pair.sequence);
    return names;
}

//! The selection in the format of presetsHeader, as lines of a C++ string.
std::string masksOf(const IIB& preset)
{
    std::map<std::array<int, 4>, int> masks;
    const cv::Mat_<int> quads = preset.getSelection();
    for (int i = 0; i < quads.rows; i++)
        masks[{{quads(i, 0), quads(i, 2), quads(i, 3), quads(i, 1)}}] = quads(i, 4);
    std::string digits, text;
    for (int level = 1; level <= preset.getGranularity(); level++)
    {
        const int n = cv::iib::placesInRow(preset.getMapping(), level),
                  channels = countBits(preset.getChannels());
        for (int i = 0; i < n * n * channels; i++)
            digits += "0123456789abcdefghijklmnopqrstuv"[masks[{
                    {level, i / channels / n, i / channels % n, i % channels}}]];
    }
    for (const char* run : {"z0000000000000000", "y00000000", "x0000", "w00"})
        for (size_t at; (at = digits.find(run + 1)) != std::string::npos;)
            digits.replace(at, std::strlen(run + 1), 1, *run);
    for (size_t i = 0; i < digits.size(); i += 96)
        text += "\n    \"" + digits.substr(i, 96) + "\"";
    return text;
}

}  // namespace

cv::Ptr<IIB> train(const Recipe& recipe, const TrainingSet& images, uint64 seed, const Progress& progress)
{
    if (recipe.bits == 0)
        return IIB::create(
                recipe.pool.scale, recipe.pool.granularity, recipe.pool.channels, recipe.pool.mapping);
    const CandidatePool pool = makePool(recipe.pool);
    const std::vector<DescribedPair> described = describeForTraining(
            images, pool.extractor, recipe.pairsPerScene, recipe.detected, recipe.warps, seed, progress);
    const auto select = recipe.adaboost ? selectByAdaBoost : selectGreedily;
    return selectedExtractor(pool, select(pool, described, recipe.bits, seed, progress));
}

std::string presetsHeader(const std::vector<NamedExtractor>& presets, const std::string& command,
        const TrainingSet& images, uint64 seed)
{
    std::ostringstream out;
    out << "// This file is part of OpenCV project.\n"
           "// It is subject to the license terms in the LICENSE file found in the top-level directory\n"
           "// of this distribution and at http://opencv.org/license.html.\n\n"
           "// Generated, do not edit: "
        << command << "\n// Seed " << seed << ", trained on:\n";
    std::set<std::string> names = sceneNames(images.pairs);
    for (const WalkPair& walk : images.walks)
        names.insert(walk.scene + ", where points are detected");
    for (const std::string& name : names)
        out << "//   " << name << "\n";
    out << "// For each level, row, column and channel a digit to base 32, the bit mask; w, x, y, z for 2, "
           "4, 8, 16 of "
           "zero.\n\n";

    std::ostringstream table;
    for (const NamedExtractor& preset : presets)
    {
        const bool all = preset.extractor->getSelection().empty();
        const std::string masks = all ? "nullptr" : preset.name + "_MASKS";
        if (!all)
            out << "static const char " << masks << "[] =" << masksOf(*preset.extractor) << ";\n\n";
        table << cv::format("    {%.3ff, %d, %d, %d, %s},  // %s\n", preset.extractor->getScaleFactor(),
                preset.extractor->getGranularity(), preset.extractor->getChannels(),
                preset.extractor->getMapping(), masks.c_str(), preset.name.c_str());
    }
    out << "static const LearnedSelection PRESETS[] = {\n" << table.str() << "};\n";
    return out.str();
}

}  // namespace iib_tools

// SPDX-License-Identifier: Apache-2.0

#include "recipe.hpp"

#include <set>
#include <sstream>

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

std::string tableRows(const cv::Mat_<int>& quads)
{
    std::string text;
    for (int row = 0; row < quads.rows; row++)
        text += (row % 7 == 0 ? "\n    " : " ") + cv::format("{%d,%d,%d,%d,%d},", quads(row, 0),
                                                          quads(row, 1), quads(row, 2), quads(row, 3),
                                                          quads(row, 4));
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
    out << "// A row a quad: level, channel, row, column, bit mask.\n\n";

    std::ostringstream table;
    for (const NamedExtractor& preset : presets)
    {
        const cv::Mat_<int> quads = preset.extractor->getSelection();
        const std::string array = quads.empty() ? "nullptr" : preset.name + "_QUADS";
        if (!quads.empty())
            out << "static const uchar " << array << "[][5] = {" << tableRows(quads) << "\n};\n\n";
        table << cv::format("    {%.3ff, %d, %d, %d, %s, %d},  // %s\n", preset.extractor->getScaleFactor(),
                preset.extractor->getGranularity(), preset.extractor->getChannels(),
                preset.extractor->getMapping(), array.c_str(), quads.rows, preset.name.c_str());
    }
    out << "static const LearnedSelection PRESETS[] = {\n" << table.str() << "};\n";
    return out.str();
}

}  // namespace iib_tools

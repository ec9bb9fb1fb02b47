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

std::vector<Recipe> presetRecipes()
{
    const int gradients = IIB::CHANNEL_GRAD_X + IIB::CHANNEL_GRAD_Y + IIB::CHANNEL_SIGNED_GRAD_X +
                          IIB::CHANNEL_SIGNED_GRAD_Y;
    const int values = IIB::CHANNEL_GRAD_X + IIB::CHANNEL_GRAD_Y + IIB::CHANNEL_INTENSITY;
    // Quads were learned before BORDER_REFLECT became the default; their bits must not change.
    const int zeros = IIB::BORDER_CLAMP;
    // the default's quads without the orientation channel, which is seldom worth its time
    const PoolParameters paper = {values, IIB::MAPPING_MEAN, 4, 1.f, {1}, zeros};
    // a wider ROS helps for static cameras; at 1.25 the sums of its cells still fit 16 bits
    const PoolParameters still = {gradients, IIB::MAPPING_HAAR, 4, 1.25f, {1}, zeros};
    PoolParameters accurate = still;
    accurate.mapping = IIB::MAPPING_PAIRWISE;
    // coarse quads tolerate a moved camera, so level 2 has them at every cell; a fourth channel costs almost no time
    const PoolParameters moving = {
            values + IIB::CHANNEL_SIGNED_GRAD_Y, IIB::MAPPING_MEAN, 4, 1.125f, {1, 15, 1}, zeros};
    // boxes overlap, so that no box of a moved camera loses all of its pixels; see README.md
    const PoolParameters boxes = {values + IIB::CHANNEL_SIGNED_GRAD_X + IIB::CHANNEL_SIGNED_GRAD_Y,
            IIB::MAPPING_BOXES, 5, 1.25f, {}, IIB::BORDER_REFLECT};
    const Warps none = {};
    const auto wide = [](double share) { return Warps{share, 0.5, 22, 0.7, 1.43, 2.5, 0.1, 1.5, 5}; };
    return {
            {"S128", 128, paper, none, 12, 0, false},
            {"S256", 256, paper, none, 12, 0, false},
            {"S512", 512, paper, none, 12, 0, false},
            {"ACCURATE", 0, accurate, none, 12, 0, false},
            {"COMPACT", 512, still, none, 12, 0, false},
            {"TINY", 256, still, none, 12, 0, false},
            {"BALANCED", 512, moving, {0.85, 0.4, 20, 0.7, 1.4, 2, 0, 1, 0}, 24, 0, false},
            {"VIEWPOINT", 512, boxes, wide(0.9), 24, 0, false},
            {"UNIVERSAL", 1024, boxes, wide(0.4), 16, 0.5, false},
            {"SMALL", 256, boxes, wide(0.67), 16, 0.6, false},
    };
}

Recipe paperRecipe()
{
    return {"AdaBoost", 512, {IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, 4, 1.f, {1}, IIB::BORDER_CLAMP},
            Warps(), 12, 0, true};
}

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
    out << "// One base-32 digit, the bit mask, per level, row, column and channel; w, x, y, z are runs of "
           "2, 4, "
           "8, 16 zeros.\n\n";

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

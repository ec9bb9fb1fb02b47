// SPDX-License-Identifier: Apache-2.0

#include <fstream>
#include <iostream>
#include <limits>

#include "common/command_line.hpp"
#include "recipe.hpp"

namespace {
using namespace iib_tools;

const int FARTHEST = 4;  // largest number of frames between the pictures of a pair
const char* const ABOUT = "iib_train [OPTION...] FOLDER...\n"
                          "Learns which bits of IIB a short descriptor keeps, from folders of sequences.";
const char* const KEYS =
        "{out        | <none> | file (.yml or .json) for the selection, for IIBDescriptorExtractor::read }"
        "{like       | COMPACT | preset whose recipe is used: channels, mapping, warps and points }"
        "{adaboost   |        | choose whole quads of the default descriptor by AdaBoost, as in the paper }"
        "{bits       | 256    | bits of the selection }"
        "{seed       | 1      | seed of all random choices }"
        "{presets    | <none> | train the built-in presets instead and write this C++ header }";

Progress show(const std::string& what)
{
    return [what](int done, int all) {
        std::cerr << "\r" << what << ": " << done << " of " << all << (done == all ? "\n" : "") << std::flush;
    };
}

void writePresets(const std::string& file, const TrainingSet& images, uint64 seed)
{
    if (images.walks.empty())
        CV_Error(cv::Error::StsBadArg, "no walks in the folders; tools/synthetic/views.py renders them");
    std::vector<NamedExtractor> presets;
    for (const Recipe& recipe : presetRecipes())
        presets.push_back({recipe.name, train(recipe, images, seed, show(recipe.name))});
    std::ofstream(file) << presetsHeader(
            presets, cv::format("scripts/train.sh --presets --seed=%d WALKS/path", int(seed)), images, seed);
}

Recipe recipeOf(const std::string& preset)
{
    std::string known;
    for (const Recipe& recipe : presetRecipes())
    {
        if (recipe.name == preset)
            return recipe;
        known += " " + recipe.name;
    }
    CV_Error(cv::Error::StsBadArg, "there is no preset " + preset + "; there are" + known);
}

int run(const CommandLine& line)
{
    const int most = std::numeric_limits<int>::max();
    Recipe recipe = line.has("adaboost") ? paperRecipe() : recipeOf(line.text("like"));
    recipe.bits = line.whole("bits", 1, most);
    const uint64 seed = uint64(line.whole("seed", 0, most));
    const std::string header = line.text("presets"), out = line.text("out");
    if (line.positional().empty())
        CV_Error(cv::Error::StsBadArg, "no FOLDER of sequences (see --help)");
    if (header.empty() && out.empty())
        CV_Error(cv::Error::StsBadArg, "nothing to do: give --out or --presets");
    const TrainingSet images = {findPairs(line.positional()), findWalkPairs(line.positional(), FARTHEST)};
    if (!header.empty())
        writePresets(header, images, seed);
    else
        train(recipe, images, seed, show("training"))->save(out);
    return 0;
}

}  // namespace

int main(int argc, char** argv) { return runTool(argc, argv, ABOUT, KEYS, run); }

// SPDX-License-Identifier: Apache-2.0

#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>

#include "common/command_line.hpp"
#include "recipe.hpp"

namespace {
using namespace iib_tools;

const int FARTHEST = 4;  // frames between the pictures of a pair of a walk
const char* const ABOUT = "iib_train [OPTION...] FOLDER...\n"
                          "Learns which bits of IIB a short descriptor keeps, from folders of sequences.";
const char* const KEYS =
        "{out        | <none> | YAML file for the selection, which IIBDescriptorExtractor::read takes }"
        "{bits       | 256    | bits of the selection; 0: all quads at even positions }"
        "{channels   | 51     | sum of IIBDescriptorExtractor::Channel values }"
        "{mapping    | 5      | IIBDescriptorExtractor::Mapping; 0 MEAN, 5 HAAR }"
        "{granularity| 4      | levels }"
        "{scale      | 1      | side of the ROS in units of 64 pixels }"
        "{windows    | 1      | where quads begin, for each level, coarse first, the last for all finer "
        "ones: a sum of "
        "1 even rows and columns, 2 odd columns, 4 odd rows, 8 both odd; 15 all }"
        "{quads      |        | choose whole quads, as in the paper, instead of bits }"
        "{adaboost   |        | plain AdaBoost, as in the paper }"
        "{warp       | 0      | part of the pairs whose target is turned, scaled and tilted, 0 to 1 }"
        "{pairs      | 24     | training pairs a scene }"
        "{detected   | 0      | part of the pairs whose points are detected in each image, 0 to 1; not 0: "
        "walks, too }"
        "{seed       | 1      | seed of all random choices }"
        "{folds      | 0      | first cross-validate over that many groups of scenes }"
        "{presets    | <none> | train the built-in presets instead and write this C++ header }";

Progress show(const std::string& what)
{
    return [what](int done, int all) {
        std::cerr << "\r" << what << ": " << done << " of " << all << (done == all ? "\n" : "") << std::flush;
    };
}

void add(MeanScores& sum, const MeanScores& scores, double share)
{
    sum.map += scores.map * share;
    sum.mar += scores.mar * share;
}

void crossValidate(const Recipe& recipe, const std::vector<ImagePair>& pairs,
        const std::vector<WalkPair>& walks, int folds, uint64 seed)
{
    MeanScores plain = {0, 0}, warped = {0, 0};
    for (int fold = 0; fold < folds; fold++)
    {
        const std::vector<ImagePair> unseen = foldOf(pairs, fold, folds, true);
        const cv::Ptr<cv::iib::IIB> learned =
                train(recipe, {foldOf(pairs, fold, folds, false), walks}, seed, show("training"));
        const double share = double(unseen.size()) / double(pairs.size());
        add(plain, judge(unseen, learned, show("judging")), share);
        add(warped, judgeWarped(unseen, learned, recipe.warps, seed, show("judging warped")), share);
    }
    std::cout << "mAP " << plain.map << ", mAR " << plain.mar << " on the scenes left out; warped "
              << warped.map << ", " << warped.mar << std::endl;
}

void writePresets(const std::string& file, const TrainingSet& images, uint64 seed)
{
    if (images.walks.empty())
        CV_Error(cv::Error::StsBadArg, "no walks in the folders; scripts/helpers/synthetic.sh renders them");
    std::vector<NamedExtractor> presets;
    for (const Recipe& recipe : presetRecipes())
        presets.push_back({recipe.name, train(recipe, images, seed, show(recipe.name))});
    std::ofstream(file) << presetsHeader(
            presets, cv::format("scripts/train.sh --presets --seed=%d WALKS", int(seed)), images, seed);
}

std::vector<int> windowsOf(const std::string& list)
{
    std::vector<int> windows;
    std::istringstream in(list);
    for (std::string number; std::getline(in, number, ',');)
    {
        std::istringstream digits(number);
        int sum = 0;
        if (!(digits >> sum) || !digits.eof() || sum < 1 || sum > 15)
            CV_Error(cv::Error::StsBadArg, "--windows=" + list + ": not a list of numbers from 1 to 15");
        windows.push_back(sum);
    }
    return windows;
}

int run(const CommandLine& line)
{
    const int most = std::numeric_limits<int>::max();
    const Recipe recipe = {"selection", line.whole("bits", 0, most),
            {line.whole("channels", 1, 63), line.whole("mapping", 0, cv::iib::IIB::MAPPING_BOXES),
                    line.whole("granularity", 1, 6), float(line.number("scale", 0.01, 100)),
                    windowsOf(line.text("windows")), line.has("quads"), cv::iib::IIB::BORDER_REFLECT},
            warpsOfShare(line.number("warp", 0, 1)), line.has("adaboost"), line.whole("pairs", 1, most),
            line.number("detected", 0, 1)};
    const uint64 seed = uint64(line.whole("seed", 0, most));
    const int folds = line.whole("folds", 0, most);
    const std::string header = line.text("presets"), out = line.text("out");
    if (line.positional().empty())
        CV_Error(cv::Error::StsBadArg, "no FOLDER of sequences (--help tells more)");
    if (header.empty() && out.empty() && folds < 2)
        CV_Error(cv::Error::StsBadArg, "nothing to do: give --out, --presets or --folds of 2 and more");
    TrainingSet images;
    for (const ImagePair& pair : findPairs(line.positional()))
        if (pair.problem.empty())
            images.pairs.push_back(pair);
        else
            std::cerr << pair.name() << ": " << pair.problem << "\n";
    images.walks = findWalkPairs(line.positional(), FARTHEST);
    if (folds >= 2)
        crossValidate(recipe, images.pairs, images.walks, folds, seed);
    if (!header.empty())
        writePresets(header, images, seed);
    else if (!out.empty())
        train(recipe, images, seed, show("training"))->save(out);
    return 0;
}

}  // namespace

int main(int argc, char** argv) { return runTool(argc, argv, ABOUT, KEYS, run); }

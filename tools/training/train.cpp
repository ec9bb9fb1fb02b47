// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

#include "opencv2/core/utility.hpp"
#include "recipe.hpp"

namespace {
using namespace iib_tools;

const char* const KEYS =
        "{help h     |        | this text }"
        "{out        |        | YAML file for the selection, which IIBDescriptorExtractor::read takes }"
        "{bits       | 256    | bits of the selection }"
        "{channels   | 51     | sum of IIBDescriptorExtractor::Channel values }"
        "{mapping    | 5      | IIBDescriptorExtractor::Mapping; 0 MEAN, 5 HAAR }"
        "{granularity| 4      | levels }"
        "{scale      | 1      | side of the ROS in units of 64 pixels }"
        "{windows    | 1      | where quads begin, for each level, coarse first, the last for all finer "
        "ones: a sum of "
        "1 even rows and columns, 2 odd columns, 4 odd rows, 8 both odd; 15 all }"
        "{quads      |        | choose whole quads, as in the paper, instead of bits }"
        "{adaboost   |        | plain AdaBoost, as in the paper }"
        "{warp       | 0      | part of the pairs whose target is turned, scaled and tilted }"
        "{pairs      | 24     | training pairs a scene }"
        "{seed       | 1      | seed of all random choices }"
        "{folds      | 0      | first cross-validate over that many groups of scenes }"
        "{presets    |        | train the built-in presets instead and write this C++ header }";

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

void crossValidate(const Recipe& recipe, const std::vector<ImagePair>& pairs, int folds, uint64 seed)
{
    MeanScores plain = {0, 0}, warped = {0, 0};
    for (int fold = 0; fold < folds; fold++)
    {
        const std::vector<ImagePair> unseen = foldOf(pairs, fold, folds, true);
        const cv::Ptr<cv::iib::IIB> learned =
                train(recipe, foldOf(pairs, fold, folds, false), seed, show("training"));
        const double share = double(unseen.size()) / double(pairs.size());
        add(plain, judge(unseen, learned, show("judging")), share);
        add(warped, judgeWarped(unseen, learned, recipe.warps, seed, show("judging warped")), share);
    }
    std::cout << "mAP " << plain.map << ", mAR " << plain.mar << " on the scenes left out; warped "
              << warped.map << ", " << warped.mar << std::endl;
}

void writePresets(const std::string& file, const std::vector<ImagePair>& pairs, uint64 seed)
{
    std::vector<NamedExtractor> presets;
    for (const Recipe& recipe : presetRecipes())
        presets.push_back({recipe.name, train(recipe, pairs, seed, show(recipe.name))});
    std::ofstream(file) << presetsHeader(
            presets, cv::format("scripts/train.sh --presets --seed=%d", int(seed)), pairs, seed);
}

int run(const cv::CommandLineParser& args, const std::vector<std::string>& roots)
{
    std::vector<int> windows;
    std::istringstream list(args.get<std::string>("windows"));
    for (std::string number; std::getline(list, number, ',');)
        windows.push_back(std::atoi(number.c_str()));
    const Recipe recipe = {"selection", args.get<int>("bits"),
            {args.get<int>("channels"), args.get<int>("mapping"), args.get<int>("granularity"),
                    args.get<float>("scale"), windows, args.has("quads")},
            warpsOfShare(args.get<double>("warp")), args.has("adaboost"), args.get<int>("pairs")};
    const uint64 seed = uint64(args.get<int>("seed"));
    const int folds = args.get<int>("folds");
    const std::string header = args.get<std::string>("presets"), out = args.get<std::string>("out");
    if (!args.check() || roots.empty() || (header.empty() && out.empty() && folds < 2))
    {
        args.printErrors();
        args.printMessage();
        return 2;
    }
    std::vector<ImagePair> pairs;
    for (const ImagePair& pair : findPairs(roots))
        if (pair.problem.empty())
            pairs.push_back(pair);
        else
            std::cerr << pair.name() << ": " << pair.problem << "\n";
    if (folds >= 2)
        crossValidate(recipe, pairs, folds, seed);
    if (!header.empty())
        writePresets(header, pairs, seed);
    else if (!out.empty())
        train(recipe, pairs, seed, show("training"))->save(out);
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    std::vector<char*> options(1, argv[0]);
    std::vector<std::string> roots;
    for (int i = 1; i < argc; i++)
        if (argv[i][0] == '-')
            options.push_back(argv[i]);
        else
            roots.push_back(argv[i]);
    const cv::CommandLineParser args(int(options.size()), options.data(), KEYS);
    try
    {
        return run(args, roots);
    }
    catch (const cv::Exception& e)
    {
        std::cerr << "iib_train: " << e.err << "\n";
        return 1;
    }
}

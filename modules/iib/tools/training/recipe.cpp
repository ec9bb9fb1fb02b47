// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

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

}  // namespace

NamedExtractors train(const Recipe& recipe, const std::vector<ImagePair>& pairs, uint64 seed,
        const Progress& progress)
{
    const CandidatePool pool = makePool(recipe.pool);
    const std::vector<DescribedPair> described = describeForTraining(
            pairs, pool.extractor, recipe.pairsPerScene, recipe.warpShare, seed, progress);
    const std::vector<std::vector<int>> selections = recipe.adaBoost
            ? selectByAdaBoost(pool, described, recipe.bits, seed, progress)
            : selectGreedily(pool, described, recipe.bits, seed, progress);
    NamedExtractors result;
    for (size_t i = 0; i < selections.size(); i++)
        result[recipe.names[i]] = selectedExtractor(pool, selections[i]);
    return result;
}

MeanScores judge(const std::vector<ImagePair>& pairs, const cv::Ptr<cv::Feature2D>& extractor,
        const Progress& progress)
{
    std::vector<Counts> counts;
    for (const DescribedPair& pair : describeForTest(pairs, extractor, progress))
    {
        Counts count = {0, 0, int(pair.points.size())};
        if (!pair.points.empty())
            for (const cv::DMatch& match : mutualMatches(pair.reference, pair.target, cv::NORM_HAMMING))
            {
                count.putative++;
                count.correct += cv::norm(pair.points[match.queryIdx] - pair.points[match.trainIdx]) <= 3;
            }
        counts.push_back(count);
    }
    return meanScores(counts);
}

std::vector<ImagePair> foldOf(const std::vector<ImagePair>& pairs, int fold, int folds, bool inside)
{
    const std::set<std::string> names = sceneNames(pairs);
    std::vector<ImagePair> result;
    for (const ImagePair& pair : pairs)
    {
        const auto scene = names.find(pair.set + "/" + pair.sequence);
        if ((std::distance(names.begin(), scene) % folds == fold) == inside)
            result.push_back(pair);
    }
    return result;
}

std::string presetsHeader(const NamedExtractors& presets, const std::string& command,
        const std::vector<ImagePair>& pairs, uint64 seed)
{
    std::ostringstream out;
    out << "// This file is part of OpenCV project.\n"
           "// It is subject to the license terms in the LICENSE file found in the top-level directory\n"
           "// of this distribution and at http://opencv.org/license.html.\n\n"
           "// Generated, do not edit: "
        << command << "\n// Seed " << seed << ", trained on:\n";
    for (const std::string& name : sceneNames(pairs))
        out << "//   " << name << "\n";
    out << "// A row a quad: level, channel, row, column, bit mask.\n\n";

    std::ostringstream table;
    for (const std::string& name : presetNames())
    {
        const cv::Ptr<IIB> preset = presets.at(name);
        const cv::Mat_<int> quads = preset->getSelection();
        out << "static const uchar " << name << "_QUADS[][5] = {";
        for (int row = 0; row < quads.rows; row++)
            out << (row % 7 == 0 ? "\n    " : " ") << cv::format("{%d,%d,%d,%d,%d},", quads(row, 0),
                    quads(row, 1), quads(row, 2), quads(row, 3), quads(row, 4));
        out << "\n};\n\n";
        table << cv::format("    {%.2ff, %d, %d, %d, %s_QUADS, %d},\n", preset->getScaleFactor(),
                preset->getGranularity(), preset->getChannels(), preset->getMapping(),
                name.c_str(), quads.rows);
    }
    out << "static const LearnedSelection PRESETS[] = {\n" << table.str() << "};\n";
    return out.str();
}

}  // namespace iib_tools

// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "experiments.hpp"
#include "results.hpp"
#include "seeded.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

bool hasExtras(const Configuration& configuration, const ImagePair& pair)
{
    for (const std::string& wanted : configuration.extraNames)
        if (wanted != TEXTURE &&
                std::find(pair.extraNames.begin(), pair.extraNames.end(), wanted) == pair.extraNames.end())
            return false;
    return true;
}

void evaluatePair(const Options& options, const ImagePair& pair,
        const std::vector<Configuration>& configurations, ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    SeedSource source(loaded.reference, options.points);
    for (const Configuration& c : configurations)
    {
        const SeedPoints seeds = source.seeds(c, loaded.target.size(), loaded.homography);
        table.append(withCounts({pair.set, pair.sequence, pair.target, c.name, pair.kind,
                                        std::to_string(descriptorBytes(*c.create()))},
                matchSeeds(c, loaded, seeds, options.tolerance)));
    }
}

}  // namespace

std::vector<std::string> fixedPointsColumns()
{
    return {"set", "sequence", "target", "configuration", "kind", "bytes", "correct", "putative",
            "correspondences", "precision", "recall"};
}

int fixedPoints(const Options& options, const std::vector<ImagePair>& pairs)
{
    std::vector<Configuration> all = iibConfigurations();
    for (const std::string& file : options.saved)
        all.push_back(savedConfiguration(file));
    for (const Configuration& baseline : baselineConfigurations())
        all.push_back(baseline);

    ResultTable table(options.out + "/fixed_points.csv", fixedPointsColumns(), 4);
    std::vector<Task> tasks;
    for (const ImagePair& pair : pairs)
    {
        std::vector<Configuration> missing;
        for (const Configuration& c : all)
            if (hasExtras(c, pair) && !table.has({pair.set, pair.sequence, pair.target, c.name}))
                missing.push_back(c);
        if (!missing.empty())
            tasks.push_back({pair.name(),
                    [&options, &table, pair, missing] { evaluatePair(options, pair, missing, table); }});
    }
    const int skipped = runTasks("fixed points", tasks);
    table.finish();
    return skipped;
}

}  // namespace iib_tools

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

}  // namespace

int fixedPoints(const Options& options, const std::vector<ImagePair>& pairs)
{
    std::vector<Configuration> all = iibConfigurations();
    for (const std::string& file : options.saved)
        all.push_back(savedConfiguration(file));
    for (const Configuration& baseline : baselineConfigurations())
        all.push_back(baseline);

    ResultTable table(options.out + "/fixed_points.csv", seededColumns(), 5);
    std::vector<Task> tasks;
    for (const ImagePair& pair : pairs)
    {
        const Fields key = {pair.set, pair.sequence, pair.target, pair.kind};
        std::vector<Configuration> missing;
        for (const Configuration& c : all)
            if (hasExtras(c, pair) && !table.has({key[0], key[1], key[2], key[3], c.name}))
                missing.push_back(c);
        if (!missing.empty())
            tasks.push_back({pair.name(), [&options, &table, pair, missing, key] {
                                 matchSeeds(options, loadPair(pair), missing, key, table);
                             }});
    }
    const int skipped = runTasks("fixed points", tasks);
    table.finish();
    return skipped;
}

}  // namespace iib_tools

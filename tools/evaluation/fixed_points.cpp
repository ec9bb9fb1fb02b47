// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <iterator>

#include "experiments.hpp"
#include "seeded.hpp"

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
        std::vector<Configuration> possible;
        std::copy_if(all.begin(), all.end(), std::back_inserter(possible),
                [&](const Configuration& c) { return hasExtras(c, pair); });
        addSeededTask(
                options, {pair.set, pair.sequence, pair.target, pair.kind}, possible,
                [pair] { return loadPair(pair); }, table, tasks);
    }
    return runTasks("fixed points", tasks, &table);
}

}  // namespace iib_tools

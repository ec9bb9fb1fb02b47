// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#include "common/dataset.hpp"
#include "detectors.hpp"
#include "experiments.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "results.hpp"

namespace iib_tools {
namespace {

struct Named
{
    const char* name;
    ExperimentFunction* run;
};

const Named EXPERIMENTS[] = {{"fixed_points", fixedPoints}, {"detected_points", detectedPoints},
        {"matching", matching}, {"robustness", robustness}, {"comparison", comparison},
        // By evaluate.py, which takes the same options.
        {"estimators", nullptr}, {"controls", nullptr}, {"alignment", nullptr}, {"uncertainty", nullptr},
        {"views", nullptr}};

//! Results of other settings must not be mixed with these.
void checkSettings(const Options& options)
{
    const std::string file = options.out + "/settings.txt",
                      settings = "points " + std::to_string(options.points) + "\ntolerance " +
                                 std::to_string(options.tolerance) + "\nopencv " CV_VERSION "\n";
    std::ostringstream known;
    known << std::ifstream(file).rdbuf();
    if (known.str().empty())
        std::ofstream(file) << settings;
    else if (known.str().compare(0, settings.size(), settings) != 0)
        CV_Error(cv::Error::StsBadArg, file + " has other settings: choose another output folder");
}

//! The pairs whose files can be read; reports the others, one line each.
std::vector<ImagePair> readablePairs(const std::vector<ImagePair>& pairs)
{
    std::vector<char> good(pairs.size(), false);
    std::vector<Task> tasks;
    for (size_t i = 0; i < pairs.size(); i++)
        tasks.push_back({pairs[i].name(), [&, i] {
                             loadPair(pairs[i]);
                             good[i] = true;
                         }});
    runTasks("reading", tasks);
    std::vector<ImagePair> readable;
    for (size_t i = 0; i < pairs.size(); i++)
        if (good[i])
            readable.push_back(pairs[i]);
    return readable;
}

}  // namespace

int evaluate(const Options& options)
{
    for (const std::string& name : options.experiments)
        if (std::none_of(std::begin(EXPERIMENTS), std::end(EXPERIMENTS),
                    [&](const Named& e) { return name == e.name; }))
            CV_Error(cv::Error::StsBadArg, "unknown experiment " + name);
    const std::vector<ImagePair> pairs = findPairs(options.roots);
    if (pairs.empty())
        CV_Error(cv::Error::StsObjectNotFound,
                "no image sequences found; the README of tools/evaluation has the layouts");
    cv::utils::fs::createDirectories(options.out);
    checkSettings(options);

    const std::vector<ImagePair> readable = readablePairs(pairs);
    if (readable.empty())
        CV_Error(cv::Error::StsObjectNotFound,
                "none of the " + std::to_string(pairs.size()) + " image pairs can be read");
    int skipped = int(pairs.size() - readable.size());
    for (const Named& e : EXPERIMENTS)
        if (e.run && (options.experiments.empty() ||
                             std::find(options.experiments.begin(), options.experiments.end(), e.name) !=
                                     options.experiments.end()))
            skipped += e.run(options, readable);
    std::cerr << "evaluated " << readable.size() << " of " << pairs.size() << " image pairs, skipped "
              << skipped << " pieces of work" << std::endl;
    return skipped;
}

}  // namespace iib_tools

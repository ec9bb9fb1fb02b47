// SPDX-License-Identifier: Apache-2.0

// What the library's calls cost beside those of OpenCV, in one run: writes JSON, of which figures.py makes tables.

#include "benchmark.hpp"

#include "common/command_line.hpp"

using namespace cv;

namespace iib_tools {
namespace {

/** Milliseconds of each task, least of all rounds. The rounds go through all tasks, so that a slow moment of the machine
meets them alike. */
std::vector<double> measure(const std::vector<Timed>& tasks, int rounds)
{
    std::vector<double> least(tasks.size(), DBL_MAX);
    for (int round = 0; round < rounds; round++)
        for (size_t i = 0; i < tasks.size(); i++)
        {
            if (round % tasks[i].every != 0)
                continue;
            setNumThreads(tasks[i].threads);
            if (tasks[i].every == 1)
                tasks[i].run();  // not timed: threads are started and have memory, as in a long run
            TickMeter meter;
            meter.start();
            tasks[i].run();
            meter.stop();
            least[i] = std::min(least[i], meter.getTimeMilli());
        }
    return least;
}

int run(const CommandLine& line)
{
    if (!line.positional().empty())
        CV_Error(Error::StsBadArg, "no argument but options (--help lists them)");
    const int rounds = line.whole("rounds", 1, 1000000);
    const String file = line.text("json");
    FileStorage fs(file, FileStorage::WRITE);
    if (!fs.isOpened())
        CV_Error(Error::StsError, "cannot write " + file);
    fs << "opencv" << CV_VERSION << "cpu" << getCPUFeaturesLine() << "rows"
       << "[";
    for (const auto make : {describingTasks, chainTasks, pixelTasks, matchingTasks, frameTasks})
    {
        const std::vector<Timed> tasks = make();
        const std::vector<double> milliseconds = measure(tasks, rounds);
        for (size_t i = 0; i < tasks.size(); i++)
            fs << "{"
               << "what" << tasks[i].what << "name" << tasks[i].name << "size" << tasks[i].size << "threads"
               << tasks[i].threads << "milliseconds" << milliseconds[i] << "}";
    }
    fs << "]";
    return 0;
}

}  // namespace
}  // namespace iib_tools

int main(int argc, char** argv)
{
    return iib_tools::runTool(argc, argv,
            "What describing and matching cost beside ORB and BFMatcher: iib_benchmark [options]",
            "{rounds |100|repetitions, of which the fastest counts}"
            "{json   |iib_benchmark.json|file to write}",
            iib_tools::run);
}

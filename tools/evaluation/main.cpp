// SPDX-License-Identifier: Apache-2.0

#include "common/command_line.hpp"
#include "experiments.hpp"
#include "opencv2/core/utils/logger.hpp"

namespace {
using namespace iib_tools;

const char ABOUT[] = "The paper's experiments, and more, on image sequences: iib_evaluation --out FOLDER "
                     "[options] DATA...\n"
                     "DATA: folders of image sequences (layouts: README.md beside the source)";

const char KEYS[] =
        "{out         |<none>|folder of the results; a run that was interrupted goes on there}"
        "{only        |<none>|fixed_points, detected_points, matching, robustness or comparison; by "
        "evaluate.py: estimators, controls, alignment, uncertainty or views; may be repeated}"
        "{compare     |<none>|image; given twice for each pair of which the matches of IIB and others are "
        "listed}"
        "{points      |1000  |keypoints an image}"
        "{tolerance   |3     |of a correct match, in pixels}"
        "{descriptor  |<none>|an extractor saved by IIBDescriptorExtractor::save, to compare; may be "
        "repeated}"
        "{detectors   |<none>|one of OpenCV's for detected points, instead of all; may be repeated}"
        "{keypoints   |<none>|folder with the keypoints of another detector, of the folder's name; may be "
        "repeated}";

int run(const CommandLine& line)
{
    Options options;
    options.out = line.text("out");
    options.roots = line.positional();
    if (options.out.empty() || options.roots.empty())
        CV_Error(cv::Error::StsBadArg, "--out FOLDER and DATA are needed (see --help)");
    options.experiments = line.all("only");
    options.points = line.whole("points", 1, 1000000);
    options.tolerance = line.number("tolerance", 0, 1e3);
    options.saved = line.all("descriptor");
    options.detectors = line.all("detectors");
    options.keypoints = line.all("keypoints");
    options.compare = line.all("compare");
    if (options.compare.size() % 2 != 0)
        CV_Error(cv::Error::StsBadArg, "--compare is given twice for each pair of images");
    evaluate(options);
    return 0;
}

//! Keeps OpenCV from writing exceptions to stderr; they are reported in one line here.
int quiet(int, const char*, const char*, const char*, int, void*) { return 0; }

}  // namespace

int main(int argc, char** argv)
{
    cv::redirectError(quiet);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    return runTool(argc, argv, ABOUT, KEYS, run);
}

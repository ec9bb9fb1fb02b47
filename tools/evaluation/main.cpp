// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <cstdlib>
#include <iostream>

#include "experiments.hpp"
#include "opencv2/core/utils/logger.hpp"

namespace {

const char* const USAGE =
        "usage: iib_evaluation --out FOLDER [options] DATA...\n"
        "  DATA               folder of image sequences, or a list file (layouts: README.md beside the "
        "source)\n"
        "  --out FOLDER       for the results; a run that was interrupted goes on there\n"
        "  --only NAME        fixed_points, detected_points, matching, robustness, cost or pictures; may be "
        "repeated\n"
        "  --points N         keypoints an image, 1000\n"
        "  --tolerance PX     of a correct match, 3\n"
        "  --threads N        all processors\n"
        "  --no-pictures      no pictures of the worst and best pairs\n"
        "  --descriptor FILE  an extractor saved by IIBDescriptorExtractor::save, to compare; may be "
        "repeated\n"
        "  --keypoints FOLDER keypoints <set>/<sequence>/<image>.csv of a detector: x,y,size,angle,response\n"
        "  --network FILE     ONNX network of a keypoint detector, such as SuperPoint or ALIKE\n";

//! A number within limits; exits with one line otherwise.
double number(const std::string& option, const std::string& value, double low, double high)
{
    char* end = nullptr;
    const double n = std::strtod(value.c_str(), &end);
    if (value.empty() || *end != '\0' || !(n >= low && n <= high))
    {
        std::cerr << option << " " << value << ": not a number from " << low << " to " << high << std::endl;
        std::exit(2);
    }
    return n;
}

iib_tools::Options parse(int argc, char** argv)
{
    iib_tools::Options options;
    for (int i = 1; i < argc; i++)
    {
        const std::string option = argv[i];
        if (option == "--help")
        {
            std::cout << USAGE;
            std::exit(0);
        }
        if (option == "--no-pictures")
        {
            options.worst = 0;
            continue;
        }
        if (option.compare(0, 2, "--") != 0)
        {
            options.roots.push_back(option);
            continue;
        }
        const std::string value = ++i < argc ? argv[i] : "";
        if (option == "--out")
            options.out = value;
        else if (option == "--only")
            options.experiments.push_back(value);
        else if (option == "--points")
            options.points = int(number(option, value, 1, 1e6));
        else if (option == "--tolerance")
            options.tolerance = number(option, value, 0, 1e3);
        else if (option == "--threads")
            cv::setNumThreads(int(number(option, value, 1, 1024)));
        else if (option == "--descriptor")
            options.saved.push_back(value);
        else if (option == "--keypoints")
            options.keypoints = value;
        else if (option == "--network")
            options.network = value;
        else
        {
            std::cerr << "unknown option " << option << "; --help tells them" << std::endl;
            std::exit(2);
        }
    }
    if (options.out.empty() || options.roots.empty())
    {
        std::cerr << USAGE;
        std::exit(2);
    }
    return options;
}

//! OpenCV writes every exception, and what it cannot read, to stderr; here they are told once, in one line.
int quiet(int, const char*, const char*, const char*, int, void*) { return 0; }

}  // namespace

int main(int argc, char** argv)
{
    cv::redirectError(quiet);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    try
    {
        iib_tools::evaluate(parse(argc, argv));
    }
    catch (const cv::Exception& e)
    {
        std::cerr << e.err << std::endl;
        return 2;
    }
    return 0;
}

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DEMO_OPTIONS_HPP
#define OPENCV_IIB_DEMO_OPTIONS_HPP

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"

#include <algorithm>
#include <fstream>
#include <stdexcept>
#include <string>

//! What the user can put right: one line, exit code 2.
struct UserError : std::runtime_error
{
    explicit UserError(const std::string& what) : std::runtime_error(what) {}
};

// One line an option, since scripts/demo.sh reads them too. A list of words in [] is all that the option takes.
// clang-format off
static const char* const OPTIONS =
        "{detector    | HESSIAN      | [HESSIAN FAST AGAST ORB BRISK AKAZE KAZE SIFT GFTT MSER SimpleBlob SURF]}"
        "{preset      | UNIVERSAL    | [default S128 S256 S512 ACCURATE COMPACT TINY BALANCED VIEWPOINT UNIVERSAL SMALL] of IIB}"
        "{normalize   | no           | find the points on the locally normalized image, as HESSIAN does by itself, [no yes]}"
        "{granularity | 4            | levels of IIB's default, [1 2 3 4 5 6]}"
        "{orientation | none         | IIB's regions: [none keypoint gradient], upright or rotated by such an angle}"
        "{homography  | <none>       | file of 3x3 numbers from A to B, to judge by; without it MAGSAC estimates one}"
        "{out         | iib_demo.png | the picture}";
// clang-format on

struct Options
{
    std::string images[2];
    std::string detector, preset, orientation;  // spelled as in OPTIONS
    bool normalize = false;
    int granularity = 4;
    std::string homography;  // empty: none is given
    std::string out;
};

inline std::string lowerCase(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](char c) { return (char)std::tolower(c); });
    return text;
}

//! The line of OPTIONS for an option, "name | default | help"; empty if there is none.
inline std::string optionLine(const std::string& name)
{
    const std::string all = OPTIONS;
    const size_t begin = all.find("{" + name + " ");
    return begin == std::string::npos || name.empty()
                   ? std::string()
                   : all.substr(begin + 1, all.find('}', begin) - begin - 1);
}

//! The word of the option's list that `value` spells, in any case.
inline std::string oneOf(const std::string& name, const std::string& value)
{
    const std::string line = optionLine(name);
    const size_t begin = line.find('[') + 1;
    const std::string words = line.substr(begin, line.find(']') - begin);
    std::istringstream list(words);
    for (std::string word; list >> word;)
        if (lowerCase(word) == lowerCase(value))
            return word;
    throw UserError("--" + name + " takes one of " + words + ", not " + value);
}

// A sample stands alone, as those of OpenCV do, so it cannot use tools/common/command_line.hpp, which knows more.
//! Arguments as cv::CommandLineParser wants them: `--name value` joined to `--name=value`, nothing unknown.
inline std::vector<std::string> joinValues(
        int argc, const char* const* argv, std::vector<std::string>& images)
{
    std::vector<std::string> arguments(1, argv[0]);
    for (int i = 1; i < argc; i++)
    {
        std::string argument = argv[i];
        if (argument.compare(0, 1, "-") != 0)
        {
            images.push_back(argument);
            continue;
        }
        const size_t equals = argument.find('=');
        const std::string option = argument.substr(0, equals);
        if (option != "--help" && option != "-h")
        {
            if (option.compare(0, 2, "--") != 0 || optionLine(option.substr(2)).empty())
                throw UserError("unknown option " + option + " (--help lists them)");
            if (equals == std::string::npos && ++i < argc)
                argument += std::string("=") + argv[i];
            if (argument.size() <= option.size() + 1)
                throw UserError("option " + option + " needs a value");
        }
        arguments.push_back(argument);
    }
    return arguments;
}

//! False if help was asked for and given.
inline bool parseOptions(int argc, const char* const* argv, Options& options)
{
    std::vector<std::string> images;
    const std::vector<std::string> arguments = joinValues(argc, argv, images);
    std::vector<const char*> pointers;
    for (const std::string& argument : arguments)
        pointers.push_back(argument.c_str());
    cv::CommandLineParser parser((int)pointers.size(), pointers.data(),
            std::string("{help h | | print this}{@imageA | | }{@imageB | | the other image of the scene}") +
                    OPTIONS);
    if (parser.has("help"))
    {
        parser.about(
                "Matches two images of one scene with IIB, and with ORB or the detector's own descriptor.");
        parser.printMessage();
        return false;
    }
    if (images.size() != 2)
        throw UserError(cv::format("two images are needed, not %d (--help)", (int)images.size()));
    std::copy(images.begin(), images.end(), options.images);
    options.detector = oneOf("detector", parser.get<std::string>("detector"));
    options.preset = oneOf("preset", parser.get<std::string>("preset"));
    options.orientation = oneOf("orientation", parser.get<std::string>("orientation"));
    options.normalize = oneOf("normalize", parser.get<std::string>("normalize")) == "yes";
    options.granularity = oneOf("granularity", parser.get<std::string>("granularity"))[0] - '0';
    if (options.preset != "default" && options.granularity != 4)
        throw UserError("--granularity goes with --preset=default, not with --preset=" + options.preset);
    if (parser.has("homography"))
        options.homography = parser.get<std::string>("homography");
    options.out = parser.get<std::string>("out");
    return true;
}

//! Nine numbers, row by row, between spaces, commas or line ends.
inline cv::Mat readHomography(const std::string& path)
{
    std::ifstream file(path.c_str());
    std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    for (char& c : text)
        if (c == ',' || c == ';')
            c = ' ';
    std::istringstream numbers(text);
    cv::Mat_<double> H(3, 3);
    int count = 0;
    for (double value; numbers >> value; count++)
        if (count < 9)
            H(count / 3, count % 3) = value;
    if (count != 9 || !numbers.eof() || cv::determinant(H) == 0)
        throw UserError("the homography file " + path + " is not an invertible 3x3 matrix");
    return H;
}

#endif

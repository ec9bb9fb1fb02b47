// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DEMO_OPTIONS_HPP
#define OPENCV_IIB_DEMO_OPTIONS_HPP

#include "opencv2/core.hpp"

#include <fstream>
#include <stdexcept>
#include <string>

//! What the user can put right: one line, exit code 2.
struct UserError : std::runtime_error
{
    explicit UserError(const std::string& what) : std::runtime_error(what) {}
};

static const char* const USAGE =
        "usage: iib_demo imageA imageB [options]\n"
        "  --detector NAME     FAST, AGAST, ORB (default), BRISK, AKAZE, KAZE, SIFT or GFTT\n"
        "  --granularity G     levels of IIB, 1 to 6 (default 4)\n"
        "  --homography FILE   3x3 numbers, from A to B, to judge by; else MAGSAC estimates it\n"
        "  --out FILE          the picture (default iib_demo.png)\n";

struct Options
{
    std::vector<std::string> images;
    std::string detector = "ORB";
    int granularity = 4;
    std::string homography;
    std::string out = "iib_demo.png";
};

inline int parseGranularity(const std::string& text)
{
    if (text.size() != 1 || text[0] < '1' || text[0] > '6')
        throw UserError("--granularity takes a number from 1 to 6, not " + text);
    return text[0] - '0';
}

//! False if help was asked for.
inline bool parseOptions(int argc, const char* const* argv, Options& options)
{
    for (int i = 1; i < argc; i++)
    {
        const std::string name = argv[i];
        if (name == "--help" || name == "-h")
            return false;
        if (name.compare(0, 1, "-") != 0)
        {
            options.images.push_back(name);
            continue;
        }
        if (name != "--detector" && name != "--granularity" && name != "--homography" && name != "--out")
            throw UserError("unknown option " + name + " (--help lists them)");
        if (++i == argc)
            throw UserError("option " + name + " needs a value");
        const std::string value = argv[i];
        if (name == "--detector")
            options.detector = value;
        else if (name == "--granularity")
            options.granularity = parseGranularity(value);
        else if (name == "--homography")
            options.homography = value;
        else
            options.out = value;
    }
    if (options.images.size() != 2)
        throw UserError(cv::format("two images are needed, not %d (--help)", (int)options.images.size()));
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

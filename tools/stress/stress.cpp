// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The library under stress, each result compared with one got the easy way; see ABOUT. Prints time and memory; exit
// code 1 and a line for what does not hold.

#include "stress.hpp"

#include "common/command_line.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace iib_stress {

using namespace cv;
using cv::iib::IIB;

void require(bool condition, const char* what)
{
    if (!condition)
        throw std::logic_error(what);
}

double memory(const std::string& name)
{
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.compare(0, name.size(), name) == 0)
            return std::atof(line.c_str() + name.size() + 1) / 1024;
    return 0;
}

Report::~Report()
{
    std::printf("%s: %.2f s, memory %.0f MB, at its highest %.0f MB\n", what.c_str(),
            (double)(cv::getTickCount() - start) / cv::getTickFrequency(), memory("VmRSS"), memory("VmHWM"));
    std::fflush(stdout);
}

Mat noise(Size size, int type, int seed)
{
    Mat image(size, type);
    RNG rng(seed);
    rng.fill(image, RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
    return image;
}

std::vector<KeyPoint> scatter(Size size, int count)
{
    RNG rng(1);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < count; i++)
        keypoints.push_back(KeyPoint(rng.uniform(0.f, (float)size.width),
                rng.uniform(0.f, (float)size.height), rng.uniform(8.f, 64.f), rng.uniform(0.f, 360.f)));
    return keypoints;
}

Mat describe(IIB& iib, const Mat& image, std::vector<KeyPoint> keypoints)
{
    Mat descriptors;
    const size_t count = keypoints.size();
    iib.compute(image, keypoints, descriptors);
    require(keypoints.size() == count && descriptors.rows == (int)count, "a keypoint is lost");
    return descriptors;
}

bool equal(const Mat& a, const Mat& b) { return a.size() == b.size() && norm(a, b, NORM_INF) == 0; }

}  // namespace iib_stress

namespace {
using namespace iib_stress;

const char ABOUT[] = "The library under stress: iib_stress WHAT [AMOUNT]\n"
                     "keypoints [COUNT]    many keypoints on one image\n"
                     "codes [COUNT]        many train descriptors\n"
                     "pixels [MEGAPIXELS]  large images of every type\n"
                     "threads [SECONDS]    24 threads that share one extractor and one matcher";

const struct
{
    const char* name;
    void (*run)(int);
    int amount;
} STRESSES[] = {{"keypoints", manyKeypoints, 1000000}, {"codes", manyCodes, 1000000},
        {"pixels", largeImages, 100}, {"threads", manyThreads, 120}};

//! A whole number above 0; 0 for any other word.
int amountOf(const std::string& word)
{
    const bool digits = !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
    return digits && word.size() < 10 ? std::atoi(word.c_str()) : 0;
}

int run(const iib_tools::CommandLine& line)
{
    const std::vector<std::string>& words = line.positional();
    if (words.empty() || words.size() > 2)
        CV_Error(cv::Error::StsBadArg, "WHAT and perhaps an AMOUNT are needed (--help tells more)");
    for (const auto& stress : STRESSES)
        if (words[0] == stress.name)
        {
            const int amount = words.size() == 2 ? amountOf(words[1]) : stress.amount;
            if (amount == 0)
                CV_Error(cv::Error::StsBadArg, words[1] + ": not a whole number above 0");
            try
            {
                stress.run(amount);
                return 0;
            }
            catch (const std::exception& e)
            {
                std::fprintf(stderr, "%s: %s\n", stress.name, e.what());
                return 1;
            }
        }
    CV_Error(cv::Error::StsBadArg, "there is no " + words[0] + " (--help tells what there is)");
}

}  // namespace

int main(int argc, char** argv) { return iib_tools::runTool(argc, argv, ABOUT, "", run); }

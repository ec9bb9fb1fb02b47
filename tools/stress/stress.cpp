// SPDX-License-Identifier: Apache-2.0

// The library under stress, each result compared with one got the easy way; see ABOUT. Prints time and memory; exit
// code 1 and a line for what does not hold.

#include "opencv2/iib.hpp"

#include "common/command_line.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace {

using namespace cv;
using cv::iib::HierarchicalMatcher;
using cv::iib::IIB;

void require(bool condition, const char* what)
{
    if (!condition)
        throw std::logic_error(what);
}

//! Of this process, in MB: "VmRSS" now, "VmHWM" at its highest.
double memory(const std::string& name)
{
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.compare(0, name.size(), name) == 0)
            return std::atof(line.c_str() + name.size() + 1) / 1024;
    return 0;
}

//! Prints the time and memory that what was done since it was made has taken.
struct Report
{
    const std::string what;
    const int64 start = getTickCount();

    explicit Report(const std::string& what_) : what(what_) {}
    ~Report()
    {
        std::printf("%s: %.2f s, memory %.0f MB, at its highest %.0f MB\n", what.c_str(),
                (double)(getTickCount() - start) / getTickFrequency(), memory("VmRSS"), memory("VmHWM"));
        std::fflush(stdout);
    }
};

Mat noise(Size size, int type, int seed)
{
    Mat image(size, type);
    RNG rng(seed);
    rng.fill(image, RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_8U ? 256 : 65536);
    return image;
}

//! Rotated keypoints of sizes 8 to 64.
std::vector<KeyPoint> scatter(Size size, int count)
{
    RNG rng(1);
    std::vector<KeyPoint> keypoints;
    for (int i = 0; i < count; i++)
        keypoints.push_back(KeyPoint(rng.uniform(0.f, (float)size.width),
                rng.uniform(0.f, (float)size.height), rng.uniform(8.f, 64.f), rng.uniform(0.f, 360.f)));
    return keypoints;
}

//! Descriptors of all the keypoints.
Mat describe(IIB& iib, const Mat& image, std::vector<KeyPoint> keypoints)
{
    Mat descriptors;
    const size_t count = keypoints.size();
    iib.compute(image, keypoints, descriptors);
    require(keypoints.size() == count && descriptors.rows == (int)count, "a keypoint is lost");
    return descriptors;
}

bool equal(const Mat& a, const Mat& b) { return a.size() == b.size() && norm(a, b, NORM_INF) == 0; }

void manyKeypoints(int count)
{
    const Mat image = noise(Size(1280, 720), CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), count);
    for (const bool rotated : {false, true})
    {
        const Ptr<IIB> iib = IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, rotated);
        Mat descriptors;
        {
            const Report report(format("%d keypoints on 1280 x 720%s", count, rotated ? ", rotated" : ""));
            descriptors = describe(*iib, image, keypoints);
        }
        for (int i = 0; i < 1000; i++)
        {
            const int k = (int)((int64)i * count / 1000);
            require(equal(descriptors.row(k), describe(*iib, image, std::vector<KeyPoint>(1, keypoints[k]))),
                    "a keypoint alone is described otherwise");
        }
    }
}

void largeImages(int megapixels)
{
    const Size size(12500, megapixels * 80);
    for (const int type : {CV_8UC1, CV_16UC1, CV_8UC3, CV_32FC1})
        for (const bool rotated : {false, true})
        {
            const Mat image = noise(size, type, 1);
            std::vector<KeyPoint> keypoints = scatter(size - Size(200, 200), 2000);
            keypoints.push_back(
                    KeyPoint((float)size.width / 2, (float)size.height / 2, (float)size.width, 10));
            const Ptr<IIB> iib =
                    IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, rotated);
            Mat descriptors;
            {
                const Report report(format("%d x %d, %s%s", size.width, size.height,
                        typeToString(type).c_str(), rotated ? ", rotated" : ""));
                descriptors = describe(*iib, image, keypoints);
            }
            if (type == CV_32FC1)
                continue;  // its steps depend on the whole image
            for (int k = 0; k < 2000; k += 10)
            {
                const Point corner(
                        std::max((int)keypoints[k].pt.x - 150, 0), std::max((int)keypoints[k].pt.y - 150, 0));
                const Rect around = Rect(corner, Size(300, 300)) & Rect(Point(), size);
                KeyPoint kp = keypoints[k];
                kp.pt.x -= (float)corner.x;
                kp.pt.y -= (float)corner.y;
                require(equal(descriptors.row(k),
                                describe(*iib, image(around).clone(), std::vector<KeyPoint>(1, kp))),
                        "a part of the image is described otherwise");
            }
        }
}

int distance(const uchar* a, const uchar* b, int bytes)
{
    int sum = 0;
    for (int i = 0; i < bytes; i++)
        for (int bits = a[i] ^ b[i]; bits; bits &= bits - 1)
            sum++;
    return sum;
}

void manyCodes(int count)
{
    const Mat train = noise(Size(170, count), CV_8U, 1);
    Mat queries = noise(Size(170, 20), CV_8U, 2);
    train.row(count - 1).copyTo(queries.row(7));
    const Ptr<HierarchicalMatcher> matcher = HierarchicalMatcher::create({2, 8, 32, 128});
    {
        const Report report(format("%d train descriptors added", count));
        matcher->add(train);
    }
    std::vector<DMatch> matches;
    {
        const Report report(format("%d queries against them", queries.rows));
        matcher->match(queries, matches);
    }
    require(matches[7].distance == 0 && matches[7].trainIdx == count - 1, "a copy is not found");
    for (const DMatch& m : matches)
        for (int t = 0; t < count; t++)
        {
            const int d = m.queryIdx % 5 ? (int)m.distance
                                         : distance(queries.ptr(m.queryIdx), train.ptr(t), train.cols);
            require(d > m.distance || (d == m.distance && (m.queryIdx % 5 || t >= m.trainIdx)),
                    "a nearer one is missed");
        }
}

void manyThreads(int seconds)
{
    const Mat image = noise(Size(320, 240), CV_8U, 1);
    const std::vector<KeyPoint> keypoints = scatter(image.size(), 200);
    const Ptr<IIB> iib = IIB::create(1.f, 4, IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, false, true);
    const Ptr<HierarchicalMatcher> matcher =
            HierarchicalMatcher::create(iib->levelSizes(), HierarchicalMatcher::EXACT, 0.35f, true);
    setNumThreads(1);
    const Mat expected = describe(*iib, image, keypoints);
    matcher->add(expected);
    Mat indices, distances;
    matcher->knnMatchArrays(expected, indices, distances, 3);
    setNumThreads(-1);

    std::atomic<bool> stop(false), wrong(false);
    std::atomic<int> rounds(0);
    std::vector<std::thread> threads;
    for (int i = 0; i < 24; i++)
        threads.push_back(std::thread([&] {
            while (!stop)
            {
                Mat i2, d2;
                const Mat descriptors = describe(*iib, image, keypoints);
                matcher->knnMatchArrays(descriptors, i2, d2, 3);
                if (!equal(expected, descriptors) || !equal(indices, i2) || !equal(distances, d2))
                    wrong = true;
                rounds++;
            }
        }));
    double early = 0;
    for (int s = 0; s < seconds; s++)
    {
        std::this_thread::sleep_for(std::chrono::seconds(1));
        if (s == seconds / 5)
            early = memory("VmRSS");
    }
    const double late = memory("VmRSS");
    stop = true;
    for (std::thread& thread : threads)
        thread.join();
    std::printf("24 threads, %d s: %d rounds, memory %.1f MB after a fifth, %.1f MB at the end\n", seconds,
            (int)rounds, early, late);
    require(!wrong, "a thread got another result than one alone");
    require(late < early * 1.05 + 16, "memory grows");
}

const char ABOUT[] =
        "The library under stress: iib_stress [--amount=N] WHAT\n"
        "keypoints  N keypoints on one image, 1,000,000 unless said\n"
        "codes      N train descriptors, 1,000,000 unless said\n"
        "pixels     images of every type and of N megapixels, 100 unless said\n"
        "threads    24 threads that share one extractor and one matcher, for N seconds, 120 unless said";

const struct
{
    const char* name;
    void (*run)(int);
    int amount;
} STRESSES[] = {{"keypoints", manyKeypoints, 1000000}, {"codes", manyCodes, 1000000},
        {"pixels", largeImages, 100}, {"threads", manyThreads, 120}};

int run(const iib_tools::CommandLine& line)
{
    if (line.positional().size() != 1)
        CV_Error(Error::StsBadArg, "WHAT is needed (--help tells more)");
    const std::string& what = line.positional()[0];
    for (const auto& stress : STRESSES)
        if (what == stress.name)
        {
            const int amount = line.has("amount") ? line.whole("amount", 1, 100000000) : stress.amount;
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
    CV_Error(Error::StsBadArg, "there is no " + what + " (--help tells what there is)");
}

}  // namespace

int main(int argc, char** argv)
{
    return iib_tools::runTool(argc, argv, ABOUT, "{amount|<none>|how much}", run);
}

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What a descriptor costs beside cv::ORB on the same keypoints, in one run: prints a table, writes JSON.

#include "frames.hpp"
#include "matching.hpp"
#include "scaling.hpp"
#include "scene.hpp"

#include "common/command_line.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/iib.hpp"

#include "opencv2/opencv_modules.hpp"
#if defined(IIB_WITH_CONTRIB) || (defined(HAVE_OPENCV_XFEATURES2D) &&                                        \
                                         CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407)  // with TEBLID
#define IIB_HAVE_XFEATURES2D
#include "opencv2/xfeatures2d.hpp"
#endif

#include <cstdio>
#include <functional>

using namespace cv;
using cv::iib::IIB;
using namespace iib_tools;

namespace {

const Size IMAGE_SIZE(1280, 720);
enum
{
    FEW = 1000,
    MANY = 5000
};

struct Row
{
    String name;
    std::function<void(std::vector<KeyPoint>&, Mat&)> compute;
    int threads;
    double milliseconds[2];  //!< for FEW and MANY keypoints, least of all rounds
};

Row rowOf(const String& name, const Ptr<IIB>& iib, const Mat& image,
        const std::vector<Mat>& extra = std::vector<Mat>(), int threads = 1)
{
    const Row row = {name, [=](std::vector<KeyPoint>& k, Mat& d) { iib->compute(image, extra, k, d); },
            threads, {DBL_MAX, DBL_MAX}};
    return row;
}

Row otherRow(const String& name, const Ptr<Feature2D>& feature, const Mat& image)
{
    const Row row = {name, [=](std::vector<KeyPoint>& k, Mat& d) { feature->compute(image, k, d); }, 1,
            {DBL_MAX, DBL_MAX}};
    return row;
}

//! The rivals of opencv_contrib, where it is there.
void addContrib(const Mat& image, std::vector<Row>& rows)
{
#ifdef IIB_HAVE_XFEATURES2D
    using namespace cv::xfeatures2d;
    rows.push_back(otherRow("BEBLID-256", BEBLID::create(1.f, BEBLID::SIZE_256_BITS), image));
    rows.push_back(otherRow("BEBLID-512", BEBLID::create(1.f, BEBLID::SIZE_512_BITS), image));
    rows.push_back(otherRow("TEBLID-512", TEBLID::create(1.f, TEBLID::SIZE_512_BITS), image));
    rows.push_back(otherRow("LATCH-512", LATCH::create(64, false), image));
#else
    (void)image;
    (void)rows;
#endif
}

std::vector<Row> allRows(const Mat& image)
{
    const Row baseline = otherRow("cv::ORB", ORB::create(), image);
    const std::vector<Mat> extra(2, image);
    const int all = IIB::CHANNELS_DEFAULT;
    std::vector<Row> rows = {
            baseline,
            rowOf("default", IIB::create(), image),
            rowOf("granularity 5", IIB::create(2.f, 5), image),
            rowOf("overlap", IIB::create(2.f, 4, all, IIB::MAPPING_MEAN, true), image),
            rowOf("MAX", IIB::create(2.f, 4, all, IIB::MAPPING_MAX), image),
            rowOf("QUARTILE", IIB::create(2.f, 4, all, IIB::MAPPING_QUARTILE), image),
            rowOf("SORT", IIB::create(2.f, 4, all, IIB::MAPPING_SORT), image),
            rowOf("HAAR", IIB::create(2.f, 4, all, IIB::MAPPING_HAAR), image),
            rowOf("PAIRWISE", IIB::create(2.f, 4, all, IIB::MAPPING_PAIRWISE), image),
            rowOf("PRESET_COMPACT", IIB::createPreset(IIB::PRESET_COMPACT), image),
            rowOf("PRESET_BALANCED", IIB::createPreset(IIB::PRESET_BALANCED), image),
            rowOf("PRESET_VIEWPOINT", IIB::createPreset(IIB::PRESET_VIEWPOINT), image),
            rowOf("PRESET_UNIVERSAL", IIB::createPreset(IIB::PRESET_UNIVERSAL), image),
            rowOf("PRESET_SMALL", IIB::createPreset(IIB::PRESET_SMALL), image),
            rowOf("2 extra channels", IIB::create(2.f, 4, all, IIB::MAPPING_MEAN, false, false, 2), image,
                    extra),
            rowOf("useOrientation", IIB::create(2.f, 4, all, IIB::MAPPING_MEAN, false, true), image),
            rowOf("default, 2 threads", IIB::create(), image, std::vector<Mat>(), 2),
    };
    addContrib(image, rows);
    return rows;
}

//! The rounds go through all rows, so that a slow moment of the machine meets them alike.
void measure(std::vector<Row>& rows, const std::vector<KeyPoint> keypoints[2], int rounds)
{
    Mat descriptors;
    for (int round = 0; round < rounds; round++)
        for (Row& row : rows)
            for (int i = 0; i < 2; i++)
            {
                setNumThreads(row.threads);
                std::vector<KeyPoint> k = keypoints[i];
                row.compute(
                        k, descriptors);  // not timed: threads are started and have memory, as in a long run
                TickMeter meter;
                meter.start();
                row.compute(k, descriptors);
                meter.stop();
                row.milliseconds[i] = std::min(row.milliseconds[i], meter.getTimeMilli());
            }
}

//! How much slower the run was whose figures are in a file, for example under OPENCV_CPU_DISABLE.
void printAgainst(const std::vector<Row>& rows, const Matching& matching, const String& file)
{
    const FileStorage fs(file, FileStorage::READ);
    if (!fs.isOpened())
        CV_Error(Error::StsError, "cannot read " + file);
    printf("\ntimes of %s\n%s\nover those above, %d keypoints\n\n", file.c_str(), ((String)fs["cpu"]).c_str(),
            FEW);
    for (const FileNode& other : fs["rows"])
        for (const Row& row : rows)
            if (row.name == (String)other["name"])
                printf("%-22s %8.2f\n", row.name.c_str(),
                        (double)other["milliseconds"][0] / row.milliseconds[0]);
    matching.printAgainst(fs["matching"]);
}

//! Microseconds that one more keypoint costs.
double marginal(const Row& row) { return (row.milliseconds[1] - row.milliseconds[0]) * 1000 / (MANY - FEW); }

void print(const std::vector<Row>& rows)
{
    printf("OpenCV %s, %s\n", CV_VERSION, getCPUFeaturesLine().c_str());
    printf("%d x %d grey; ms for %d keypoints, us a keypoint more; ratios to the first row\n\n",
            IMAGE_SIZE.width, IMAGE_SIZE.height, FEW);
    printf("%-22s %8s %8s %10s %8s\n", "", "ms", "ratio", "us/keypoint", "ratio");
    for (const Row& row : rows)
        printf("%-22s %8.3f %8.2f %10.3f %8.2f\n", row.name.c_str(), row.milliseconds[0],
                row.milliseconds[0] / rows[0].milliseconds[0], marginal(row),
                marginal(row) / marginal(rows[0]));
}

void write(const std::vector<Row>& rows, const Scaling& scaling, const Matching& matching,
        const Frames& frames, const String& file)
{
    FileStorage fs(file, FileStorage::WRITE);
    if (!fs.isOpened())
        CV_Error(Error::StsError, "cannot write " + file);
    fs << "opencv" << CV_VERSION << "cpu" << getCPUFeaturesLine() << "width" << IMAGE_SIZE.width << "height"
       << IMAGE_SIZE.height << "keypoints"
       << "[" << (int)FEW << (int)MANY << "]"
       << "rows"
       << "[";
    for (const Row& row : rows)
        fs << "{"
           << "name" << row.name << "threads" << row.threads << "milliseconds"
           << "[" << row.milliseconds[0] << row.milliseconds[1] << "]"
           << "}";
    fs << "]";
    scaling.write(fs);
    matching.write(fs);
    frames.write(fs);
}

int run(const CommandLine& line)
{
    if (!line.positional().empty())
        CV_Error(Error::StsBadArg, "no argument but options (--help lists them)");
    const int rounds = line.whole("rounds", 1, 1000000);
    const Mat image = cornerImage(IMAGE_SIZE);
    const std::vector<KeyPoint> keypoints[2] = {corners(image, FEW), corners(image, MANY)};
    CV_Assert(keypoints[1].size() == MANY);
    std::vector<Row> rows = allRows(image);
    measure(rows, keypoints, rounds);
    print(rows);
    const Scaling scaling = measureScaling(rounds);
    scaling.print();
    const Matching matching = measureMatching(rounds);
    matching.print();
    const Frames frames = measureFrames(rounds);
    frames.print();
    write(rows, scaling, matching, frames, line.text("json"));
    if (line.has("against"))
        printAgainst(rows, matching, line.text("against"));
    return 0;
}

}  // namespace

int main(int argc, char** argv)
{
    return runTool(argc, argv, "What a descriptor costs beside cv::ORB: iib_benchmark [options]",
            "{rounds |100|repetitions, of which the fastest counts}"
            "{json   |iib_benchmark.json|file to write}"
            "{against|<none>|file of another run, to be compared with}",
            run);
}

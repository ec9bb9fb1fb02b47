// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches two images of one scene under different light: by the recommended chain (HessianDetector, PRESET_UNIVERSAL,
// matches that are mutual and under a ratio of 0.9), and by ORB's own points and descriptor. With another --detector, IIB
// and the detector's own descriptor share its points. Prints a table and the result in one line, and writes a picture.
// scripts/demo.sh calls it.

#include "iib_demo_options.hpp"
#include "iib_demo_picture.hpp"
#include "iib_demo_pipeline.hpp"

#include "opencv2/core/utils/logger.hpp"
#include "opencv2/imgcodecs.hpp"

#include <cstdio>

static const int NONE_FOUND = 3;  // exit status

static cv::Mat readImage(const std::string& path)
{
    // as it lies in the file: EXIF data do not turn it
    cv::Mat image = cv::imread(path, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
    if (image.empty())
        throw UserError("cannot read the image " + path);
    return image;
}

static void writePicture(const std::string& path, const cv::Mat& picture)
{
    bool written = false;
    try
    {
        written = cv::imwrite(path, picture);
    }
    catch (const cv::Exception&)
    {
        // no encoder for the file name's extension
    }
    if (!written)
        throw UserError(
                "cannot write the picture " + path + " (is it a .png or .jpg in a folder that exists?)");
}

static void printTable(
        const Options& options, const std::vector<Pair>& pairs, const std::vector<Result>& results)
{
    const char* const good = options.homography.empty() ? "consistent" : "correct";
    for (const Pair& p : pairs)
        std::printf("%s: %d and %d keypoints, detected in %.1f ms\n", p.detector.c_str(),
                (int)p.keypoints[0].size(), (int)p.keypoints[1].size(), p.detectMs);
    std::printf("\ndescriptor  bytes  matches  %10s  share  describe ms  match ms  verify ms\n", good);
    for (const Result& r : results)
        std::printf("%-10s  %5d  %7d  %10s  %5s  %11.1f  %8.1f  %9.1f\n", r.name.c_str(), r.bytes,
                (int)r.matches.size(), r.judged ? cv::format("%d", r.goodCount()).c_str() : "-",
                r.judged ? cv::format("%.0f %%", 100 * r.precision()).c_str() : "-", r.describeMs, r.matchMs,
                r.verifyMs);
    if (options.homography.empty())
        std::printf("\nconsistent: within %g px of a homography that MAGSAC estimated from these matches, "
                    "one for "
                    "each descriptor;\nto count correct matches give the true one with --homography\n",
                MAX_ERROR);
    else
        std::printf(
                "\ncorrect: within %g px of the homography in %s\n", MAX_ERROR, options.homography.c_str());
}

//! The result in one line: "IIB 445 of 448 correct, ORB 1 of 41 correct".
static void printSummary(const Options& options, const std::vector<Result>& results)
{
    std::string line;
    for (size_t i = results.size(); i-- > 0;)
    {
        const Result& r = results[i];
        const int matches = (int)r.matches.size();
        line += (line.empty() ? "" : ", ") + r.name;
        if (r.judged)
            line += cv::format(" %d of %d%s", r.goodCount(), matches,
                    options.homography.empty() ? " consistent" : " correct");
        else
            line += cv::format(": no homography found in %d matches", matches);
    }
    std::printf("\n%s\npicture: %s\n", line.c_str(), options.out.c_str());
}

static Pair detectedPair(const std::string& name, const Detector& detector, const cv::Mat (&images)[2])
{
    Pair pair;
    std::copy(images, images + 2, pair.images);
    pair.detector = name;
    detect(detector, pair);
    return pair;
}

//! The exit status.
static int run(const Options& options)
{
    cv::Mat images[2];
    for (int i = 0; i < 2; i++)
        images[i] = readImage(options.images[i]);
    const cv::Mat H = options.homography.empty() ? cv::Mat() : readHomography(options.homography);

    Detector detector = createDetector(options.detector);
    if (options.normalize)
        detector.feature = cv::iib::NormalizedDetector::create(detector.feature);
    std::vector<Pair> pairs(1, detectedPair(options.detector, detector, images));
    std::vector<Result> results;
    if (options.detector == "HESSIAN")
    {
        const Detector orb = createDetector("ORB");
        pairs.push_back(detectedPair("ORB", orb, images));
        results.push_back(matchPair("ORB", orb.feature, pairs.back(), H));
    }
    else if (detector.describes)
        results.push_back(matchPair(options.detector, detector.feature, pairs[0], H));
    results.push_back(matchPair("IIB", createIIB(options), pairs[0], H));

    std::vector<cv::Mat> rows;
    for (const Result& r : results)
        rows.push_back(drawResult(pairs[0], r, !H.empty()));
    cv::Mat picture;
    cv::vconcat(rows, picture);
    writePicture(options.out, picture);
    printTable(options, pairs, results);
    printSummary(options, results);
    if (results.back().goodCount() > 0)
        return 0;
    std::fprintf(stderr,
            "iib_demo: nothing agrees; do both images show the same place? Large ones are better reduced to "
            "about 1000 pixels, and turned ones need --orientation keypoint or gradient\n");
    return NONE_FOUND;
}

int main(int argc, char** argv)
{
    // Messages here are this program's own, one line each.
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    try
    {
        Options options;
        if (parseOptions(argc, argv, options))
            return run(options);
    }
    catch (const UserError& e)
    {
        std::fprintf(stderr, "iib_demo: %s\n", e.what());
        return 2;
    }
    catch (const cv::Exception& e)
    {
        std::fprintf(stderr, "iib_demo: %s\n", e.err.c_str());
        return 1;
    }
    return 0;
}

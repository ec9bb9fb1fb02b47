// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches two images of one scene under different light: by the recommended chain (HessianDetector, PRESET_UNIVERSAL, matches
// that are mutual and under a ratio of 0.9), and by ORB. Prints a table and the result in one line, and writes a picture.
// scripts/demo.sh calls it.

#include "opencv2/calib3d.hpp"
#include "opencv2/core/utility.hpp"
#include "opencv2/core/utils/logger.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"

#include <cstdio>
#include <fstream>

using namespace cv;

// One line an option, since scripts/demo.sh reads them too.
// clang-format off
static const char* const KEYS =
        "{help h | | print this}{@imageA | | }{@imageB | | the other image of the scene}"
        "{homography | <none>       | file of 3x3 numbers from A to B, to judge by; without it MAGSAC estimates one}"
        "{out        | iib_demo.png | the picture}";
// clang-format on
static const int MAX_KEYPOINTS = 1000, MIN_CONSISTENT = 10;  // fewer agree with some homography by chance
static const double MAX_ERROR = 3;                           // pixels, in image B

struct Result
{
    String name, row;
    std::vector<KeyPoint> keypoints[2];
    std::vector<DMatch> matches;
    std::vector<char> good;  // of each match, whether the homography agrees
    int goodCount = 0;
};

//! What the user can put right: one line, exit code 2.
static void require(bool ok, const String& message)
{
    if (!ok)
        throw std::runtime_error(message);
}

static Mat readHomography(const String& path)
{
    std::ifstream file(path.c_str());
    Mat_<double> H(3, 3);
    for (double& value : H)
        file >> value;
    require(file && determinant(H) != 0, "the homography file " + path + " is not an invertible 3x3 matrix");
    return H;
}

static Result match(const String& name, Feature2D& features, const Mat (&images)[2], Mat H)
{
    Result r;
    r.name = name;
    Mat codes[2];
    TickMeter describing, matching;
    for (int i = 0; i < 2; i++)
    {
        describing.start();
        features.detectAndCompute(images[i], noArray(), r.keypoints[i], codes[i]);
        describing.stop();
        require(!r.keypoints[i].empty(), format("there is no keypoint in image %c", "AB"[i]));
    }
    matching.start();
    iib::HierarchicalMatcher::createRecommended()->match(codes[0], codes[1], r.matches);
    matching.stop();

    std::vector<Point2f> a, b, projected;
    for (const DMatch& m : r.matches)
    {
        a.push_back(r.keypoints[0][m.queryIdx].pt);
        b.push_back(r.keypoints[1][m.trainIdx].pt);
    }
    const bool given = !H.empty();
    if (!given && a.size() >= 4)
        H = findHomography(a, b, USAC_MAGSAC, MAX_ERROR);
    if (!a.empty() && !H.empty())
        perspectiveTransform(a, projected, H);
    for (size_t i = 0; i < a.size(); i++)
        r.good.push_back(!H.empty() && norm(projected[i] - b[i]) <= MAX_ERROR);
    r.goodCount = (int)std::count(r.good.begin(), r.good.end(), 1);
    if (!given && r.goodCount < MIN_CONSISTENT)
    {
        r.goodCount = 0;
        r.good.assign(a.size(), 0);
    }
    r.row = format("%-10s  %5d  %4d %4d  %7d  %10d  %22.1f  %8.1f\n", name.c_str(), codes[0].cols,
            (int)r.keypoints[0].size(), (int)r.keypoints[1].size(), (int)a.size(), r.goodCount,
            describing.getTimeMilli(), matching.getTimeMilli());
    return r;
}

//! Both images side by side under a caption, and up to 100 matches: what agrees above what does not.
static Mat draw(const Result& r, const Mat (&images)[2], const char* good)
{
    const int WIDTH = 640, CAPTION = 44, MAX_DRAWN = 100;
    const Scalar COLORS[] = {
            Scalar(40, 90, 255), Scalar(150, 220, 60)};  // distinct for colour-blind eyes too
    Mat halves[2];
    for (int i = 0; i < 2; i++)
        resize(images[i], halves[i], Size(WIDTH, images[i].rows * WIDTH / images[i].cols), 0, 0, INTER_AREA);
    Mat canvas(CAPTION + std::max(halves[0].rows, halves[1].rows), 2 * WIDTH, CV_8UC3, Scalar(32, 28, 26));
    for (int i = 0; i < 2; i++)
        halves[i].copyTo(canvas(Rect(Point(i * WIDTH, CAPTION), halves[i].size())));
    const double step = std::max(1., (double)r.matches.size() / MAX_DRAWN);
    for (int agrees = 0; agrees < 2; agrees++)
    {
        Mat lines = canvas.clone();
        for (double at = 0; at < (double)r.matches.size(); at += step)
        {
            const DMatch& m = r.matches[(size_t)at];
            if (r.good[(size_t)at] == agrees)
                line(lines, r.keypoints[0][m.queryIdx].pt * WIDTH / images[0].cols + Point2f(0, CAPTION),
                        r.keypoints[1][m.trainIdx].pt * WIDTH / images[1].cols + Point2f(WIDTH, CAPTION),
                        COLORS[agrees], 1, LINE_AA);
        }
        addWeighted(lines, 0.75, canvas, 0.25, 0, canvas);
    }
    putText(canvas, format("%s: %d of %d %s", r.name.c_str(), r.goodCount, (int)r.matches.size(), good),
            Point(14, CAPTION - 15), FONT_HERSHEY_DUPLEX, 0.68, Scalar::all(235), 1, LINE_AA);
    return canvas;
}

static int run(const CommandLineParser& parser)
{
    Mat images[2];
    for (int i = 0; i < 2; i++)
    {
        const String path = parser.get<String>(i);
        images[i] = imread(path, IMREAD_COLOR | IMREAD_IGNORE_ORIENTATION);  // as it lies in the file
        require(!images[i].empty(),
                path.empty() ? String("two images are needed (--help)") : "cannot read the image " + path);
    }
    const String file = parser.has("homography") ? parser.get<String>("homography") : String(),
                 out = parser.get<String>("out");
    const Mat H = file.empty() ? Mat() : readHomography(file);
    require(haveImageWriter(out), "cannot write the picture " + out + ": is it a .png or .jpg?");

    const char* const good = H.empty() ? "consistent" : "correct";
    const Result results[] = {
            match("IIB", *iib::IIBDescriptorExtractor::createRecommended(MAX_KEYPOINTS), images, H),
            match("ORB", *ORB::create(MAX_KEYPOINTS), images, H)};
    String summary;
    std::vector<Mat> rows;
    for (const Result& r : results)
    {
        summary += format("%s%s %d of %d %s", rows.empty() ? "" : ", ", r.name.c_str(), r.goodCount,
                (int)r.matches.size(), good);
        rows.push_back(draw(r, images, good));
    }
    Mat picture;
    vconcat(rows, picture);
    require(imwrite(out, picture), "cannot write the picture " + out + ": check its folder");
    std::printf("descriptor  bytes  keypoints  matches  %10s  detect and describe ms  match ms\n", good);
    for (const Result& r : results)
        std::printf("%s", r.row.c_str());
    std::printf("%s: within %g px of %s\n\n", good, MAX_ERROR,
            H.empty() ? "a homography that MAGSAC estimates, one for each" : file.c_str());
    std::printf("%s\npicture: %s\n", summary.c_str(), out.c_str());
    if (results[0].goodCount > 0)
        return 0;
    std::fprintf(stderr, "iib_demo: nothing agrees; do both images show the same place? Large ones are "
                         "better reduced to about 1000 pixels\n");
    return 3;
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(
            utils::logging::LOG_LEVEL_SILENT);  // messages are this program's own, one line each
    try
    {
        CommandLineParser parser(argc, argv, KEYS);
        parser.about("Matches two images of one scene with IIB, and with ORB.");
        if (parser.has("help"))
            return parser.printMessage(), 0;
        return run(parser);
    }
    catch (const cv::Exception& e)
    {
        std::fprintf(stderr, "iib_demo: %s\n", e.err.c_str());
        return 1;
    }
    catch (const std::exception& e)
    {
        std::fprintf(stderr, "iib_demo: %s\n", e.what());
        return 2;
    }
}

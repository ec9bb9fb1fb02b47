// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches two images of one place under different light by the recommended chain, by SIFT and by ORB, 1000 points each. Prints
// how many matches are right, and draws them. scripts/demo.sh calls it.

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
        "{help h | | print this}{@imageA | | }{@imageB | | the other image of the place}"
        "{homography  | <none>       | file of 3x3 numbers from A to B, to judge by; without it MAGSAC estimates one}"
        "{fundamental | <none>       | file of 3x3 numbers, to judge by instead where the camera moved: b' F a = 0}"
        "{out         | iib_demo.png | the picture}";
// clang-format on
static const int MAX_KEYPOINTS = 1000, MIN_CONSISTENT = 10;  // fewer agree with some homography by chance
static const double MAX_ERROR = 3;                           // pixels in image B

//! What the user can put right: one line, exit code 2.
static void require(bool ok, const String& message)
{
    if (!ok)
        throw std::runtime_error(message);
}

static Mat readMatrix(const String& path)
{
    std::ifstream file(path.c_str());
    Mat_<double> m(3, 3);
    for (double& value : m)
        file >> value;
    require((bool)file, "the file " + path + " has no 3x3 numbers");
    return m;
}

//! Mutual nearest neighbours under a ratio: the recommended .9 for bits, Lowe's .8 for SIFT's numbers.
static void match(const Mat (&codes)[2], std::vector<DMatch>& matches)
{
    if (codes[0].type() == CV_8U)
        return iib::HierarchicalMatcher::createRecommended()->match(codes[0], codes[1], matches);
    std::vector<std::vector<DMatch>> there, back;
    BFMatcher(NORM_L2).knnMatch(codes[0], codes[1], there, 2);
    BFMatcher(NORM_L2).knnMatch(codes[1], codes[0], back, 1);
    for (const std::vector<DMatch>& m : there)
        if (m.size() > 1 && m[0].distance < .8 * m[1].distance &&
                back[m[0].trainIdx][0].trainIdx == m[0].queryIdx)
            matches.push_back(m[0]);
}

//! Whether each pair of points agrees with the homography, or the fundamental matrix, that is given; else with MAGSAC's homography.
static std::vector<char> judge(
        const std::vector<Point2f>& a, const std::vector<Point2f>& b, Mat H, const Mat& F)
{
    std::vector<char> good(a.size(), 0);
    const bool estimated = H.empty() && F.empty();
    if (estimated && a.size() >= 4)
        H = findHomography(a, b, USAC_MAGSAC, MAX_ERROR);
    std::vector<Point2f> moved;
    std::vector<Point3f> lines;
    if (!a.empty() && !F.empty())
        computeCorrespondEpilines(a, 1, F, lines);
    else if (!a.empty() && !H.empty())
        perspectiveTransform(a, moved, H);
    for (size_t i = 0; i < std::max(moved.size(), lines.size()); i++)
        good[i] = (lines.empty() ? norm(moved[i] - b[i])
                                 : std::abs(lines[i].dot(Point3f(b[i].x, b[i].y, 1)))) <= MAX_ERROR;
    if (estimated && std::count(good.begin(), good.end(), 1) < MIN_CONSISTENT)
        good.assign(a.size(), 0);
    return good;
}

static int run(const CommandLineParser& parser)
{
    Mat images[2], rows[3];
    for (int i = 0; i < 2; i++)
    {
        const String path = parser.get<String>(i);
        images[i] = imread(path, IMREAD_COLOR | IMREAD_IGNORE_ORIENTATION);  // as it lies in the file
        require(!images[i].empty(),
                path.empty() ? String("two images are needed (--help)") : "cannot read the image " + path);
    }
    const Mat H = parser.has("homography") ? readMatrix(parser.get<String>("homography")) : Mat(),
              F = parser.has("fundamental") ? readMatrix(parser.get<String>("fundamental")) : Mat();
    const String out = parser.get<String>("out"), word = H.empty() && F.empty() ? "consistent" : "correct";
    require(H.empty() || determinant(H) != 0, "the homography has no inverse");
    require(haveImageWriter(out), "cannot write the picture " + out + ": is it a .png or .jpg?");

    const String names[] = {"IIB", "SIFT", "ORB"};
    const Ptr<Feature2D> features[] = {iib::IIBDescriptorExtractor::createRecommended(MAX_KEYPOINTS),
            SIFT::create(MAX_KEYPOINTS), ORB::create(MAX_KEYPOINTS)};
    String table, summary;
    int found = 0;
    for (int k = 0; k < 3; k++)
    {
        std::vector<KeyPoint> keypoints[2];
        Mat codes[2];
        std::vector<DMatch> matches;
        std::vector<Point2f> a, b;
        TickMeter describing, matching;
        describing.start();
        for (int i = 0; i < 2; i++)
            features[k]->detectAndCompute(images[i], noArray(), keypoints[i], codes[i]);
        describing.stop();
        require(!codes[0].empty() && !codes[1].empty(),
                "there is no keypoint of " + names[k] + " in one of the images");
        matching.start();
        match(codes, matches);
        matching.stop();
        for (const DMatch& m : matches)
        {
            a.push_back(keypoints[0][m.queryIdx].pt);
            b.push_back(keypoints[1][m.trainIdx].pt);
        }
        const std::vector<char> good = judge(a, b, H, F);
        std::vector<char> others(good.size());
        std::transform(good.begin(), good.end(), others.begin(), [](char each) { return !each; });
        const int count = (int)std::count(good.begin(), good.end(), 1);
        found = k == 0 ? count : found;
        summary += format("%s%s %d of %d %s", k ? ", " : "", names[k].c_str(), count, (int)matches.size(),
                word.c_str());
        table += format("%-4s %4d bytes, %4d and %4d keypoints in %.1f ms, matched in %.1f ms\n",
                names[k].c_str(), (int)(codes[0].cols * codes[0].elemSize()), (int)keypoints[0].size(),
                (int)keypoints[1].size(), describing.getTimeMilli(), matching.getTimeMilli());
        // Orange and green, which colour-blind eyes tell apart; what is right lies above the rest.
        Mat& row = rows[2 - k];
        const DrawMatchesFlags lines = DrawMatchesFlags::NOT_DRAW_SINGLE_POINTS;
        drawMatches(images[0], keypoints[0], images[1], keypoints[1], matches, row, Scalar(40, 90, 255),
                Scalar(), others, lines);
        drawMatches(images[0], keypoints[0], images[1], keypoints[1], matches, row, Scalar(150, 220, 60),
                Scalar(), good, lines | DrawMatchesFlags::DRAW_OVER_OUTIMG);
        resize(row, row, Size(1280, cvRound(row.rows * 1280. / row.cols)), 0, 0, INTER_AREA);
        copyMakeBorder(row, row, 44, 0, 0, 0, BORDER_CONSTANT, Scalar(32, 28, 26));
        putText(row, format("%s: %d of %d %s", names[k].c_str(), count, (int)matches.size(), word.c_str()),
                Point(14, 29), FONT_HERSHEY_DUPLEX, .68, Scalar::all(235), 1, LINE_AA);
    }
    Mat picture;
    vconcat(rows, 3, picture);
    require(imwrite(out, picture), "cannot write the picture " + out + ": check its folder");
    std::printf("%s%s: within %g pixels of %s\n\n%s\npicture: %s\n", table.c_str(), word.c_str(), MAX_ERROR,
            !F.empty()  ? "the epipolar line"
            : H.empty() ? "a homography that MAGSAC estimates, one for each"
                        : "the homography",
            summary.c_str(), out.c_str());
    if (!found)
        std::fprintf(stderr, "iib_demo: nothing agrees; do both images show the same place?\n");
    return found ? 0 : 3;
}

int main(int argc, char** argv)
{
    utils::logging::setLogLevel(
            utils::logging::LOG_LEVEL_SILENT);  // messages are this program's own, one line each
    try
    {
        CommandLineParser parser(argc, argv, KEYS);
        parser.about("Matches two images of one place with IIB, SIFT and ORB.");
        return parser.has("help") ? parser.printMessage(), 0 : run(parser);
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

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// Matches two images by the recommended chain, by SIFT and by ORB, all upright and refined, and draws the matches of IIB and SIFT.

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
static const char* const KEYS =
        "{help h | | print this}{@imageA | | }{@imageB | | the other image of the place}"
        "{homography | <none>       | file of 3x3 numbers from A to B; else MAGSAC estimates one}"
        "{depth      | <none>       | A's depth d, 16 bits, if the camera moved: b = H (a, 1 / d), H 3x4}"
        "{out        | iib_demo.png | the picture}";
static const int MAX_KEYPOINTS = 1000, MAX_ERROR = 3, MIN_CONSISTENT = 10;  // fewer agree by chance
static const double WIDTH = 1100;                                           // of the picture
static const char* const SETTINGS =
        " (1000 points per image, upright, mutual, ratio %s); green: %s, red: not";

//! Mutual nearest neighbours under a ratio: the recommended .92 for bits, Lowe's .8 for SIFT's numbers.
static std::vector<DMatch> match(const Mat& a, const Mat& b)
{
    std::vector<DMatch> matches, mutual;
    std::vector<std::vector<DMatch>> two;
    if (a.type() == CV_8U)
        iib::HierarchicalMatcher::createRecommended()->match(a, b, matches);
    else
        BFMatcher(NORM_L2, true).match(a, b, mutual);
    if (!mutual.empty())
        BFMatcher(NORM_L2).knnMatch(a, b, two, 2);
    for (const DMatch& m : mutual)
        if (two[m.queryIdx].size() == 2 && m.distance < .8 * two[m.queryIdx][1].distance)
            matches.push_back(m);
    return matches;
}

//! 1 for each pair that agrees with the truth, by A's depth if the camera moved; else with MAGSAC's homography.
static std::vector<char> judge(
        const Mat_<Point2f>& a, const Mat_<Point2f>& b, Mat truth, const Mat_<ushort>& depth)
{
    const bool estimated = truth.empty();
    if (estimated && a.rows >= 4)
        truth = findHomography(a, b, USAC_MAGSAC, MAX_ERROR);
    std::vector<char> good(a.rows, 0);
    for (int i = 0; i < a.rows && !truth.empty(); i++)
    {
        Vec3d there = Matx33d(truth.colRange(0, 3)) * Vec3d(a(i).x, a(i).y, 1);
        const Point pixel(
                std::min(cvRound(a(i).x), depth.cols - 1), std::min(cvRound(a(i).y), depth.rows - 1));
        if (!depth.empty() && depth(pixel))  // the sky has none: only the camera's turn moves it
            there += Vec3d(truth.col(3)) / double(depth(pixel));
        good[i] = norm(there / there[2] - Vec3d(b(i).x, b(i).y, 1)) <= MAX_ERROR;
    }
    return estimated && countNonZero(good) < MIN_CONSISTENT ? std::vector<char>(a.rows, 0) : good;
}

int main(int argc, char** argv)
try
{
    utils::logging::setLogLevel(utils::logging::LOG_LEVEL_SILENT);  // messages are this program's own
    const CommandLineParser parser(argc, argv, KEYS);
    if (parser.has("help"))
        return parser.printMessage(), 0;
    Mat images[2], rows[3], picture;
    for (int i = 0; i < 2; i++)
        if ((images[i] = imread(parser.get<String>(i), IMREAD_COLOR | IMREAD_IGNORE_ORIENTATION)).empty())
            CV_Error(Error::StsBadArg, "two images are needed; cannot read '" + parser.get<String>(i) + "'");
    const String known = parser.get<String>("homography"), depths = parser.get<String>("depth");  // the truth
    const Mat depth = depths.empty() ? Mat() : imread(depths, IMREAD_UNCHANGED);
    if (!depths.empty() && known.empty())
        CV_Error(Error::StsBadArg, "--depth needs --homography");
    if (!depths.empty() && (depth.type() != CV_16U || depth.size() != images[0].size()))
        CV_Error(Error::StsBadArg, depths + " is not an image of 16 bits and of A's size");
    std::ifstream file(known.c_str());
    Mat_<double> truth(known.empty() ? 0 : 3, depth.empty() ? 3 : 4);
    for (double& value : truth)
        file >> value;
    if (!known.empty() && (!file || determinant(truth.colRange(0, 3)) == 0))
        CV_Error(Error::StsBadArg,
                known + " does not hold an invertible 3 x 3 homography (3 x 4 with --depth)");
    const String out = parser.get<String>("out"), word = truth.empty() ? "consistent" : "correct";
    const String names[] = {"IIB", "SIFT", "ORB"};
    const Ptr<Feature2D> features[] = {iib::IIBDescriptorExtractor::createRecommended(MAX_KEYPOINTS),
            SIFT::create(MAX_KEYPOINTS), ORB::create(MAX_KEYPOINTS)};
    String summary;
    int found = 0;
    for (int k = 0; k < 3; k++)
    {
        std::vector<KeyPoint> keypoints[2];
        Mat codes[2], a, b;
        for (int i = 0; i < 2; i++)
        {
            features[k]->detect(images[i], keypoints[i]);
            for (KeyPoint& keypoint : keypoints[i])  // the camera is upright, and so is the recommended chain
                keypoint.angle = 0;
            features[k]->compute(images[i], keypoints[i], codes[i]);
        }
        if (codes[0].empty() || codes[1].empty())
            CV_Error(Error::StsBadArg, "there is no keypoint of " + names[k] + " in one of the images");
        const std::vector<DMatch> matches = match(codes[0], codes[1]);
        iib::refineMatches(images[0], keypoints[0], images[1], keypoints[1], matches, a, b);
        const std::vector<char> good = judge(a.reshape(2), b.reshape(2), truth, depth);
        const int right = countNonZero(good);
        found = k ? found : right;
        const String score = names[k] + format(" %d of %d ", right, (int)matches.size()) + word;
        summary += (k ? ", " : "") + score;
        // orange and green, which colour-blind people can distinguish; correct matches are drawn last
        const DrawMatchesFlags lines = DrawMatchesFlags::NOT_DRAW_SINGLE_POINTS;
        drawMatches(images[0], keypoints[0], images[1], keypoints[1], matches, rows[k], Scalar(40, 90, 255),
                Scalar(), std::vector<char>(), lines);
        drawMatches(images[0], keypoints[0], images[1], keypoints[1], matches, rows[k], Scalar(150, 220, 60),
                Scalar(), good, lines | DrawMatchesFlags::DRAW_OVER_OUTIMG);
        resize(rows[k], rows[k], Size(WIDTH, cvRound(rows[k].rows * WIDTH / rows[k].cols)), 0, 0, INTER_AREA);
        copyMakeBorder(rows[k], rows[k], 40, 0, 0, 0, BORDER_CONSTANT, Scalar(32, 28, 26));
        putText(rows[k], score + format(SETTINGS, k == 1 ? ".8" : ".92", word.c_str()), Point(14, 27),
                FONT_HERSHEY_DUPLEX, .6, Scalar::all(235), 1, LINE_AA);
    }
    vconcat(rows, 2, picture);  // of IIB and SIFT, for one screen
    if (!imwrite(out, picture))
        CV_Error(Error::StsBadArg, "cannot write the picture " + out + ": check its folder");
    std::printf("%s: within %d pixels of %s\n%s\npicture: %s\n", word.c_str(), MAX_ERROR,
            truth.empty() ? "a MAGSAC homography" : "the truth", summary.c_str(), out.c_str());
    if (!found)
        std::fprintf(stderr, "iib_demo: nothing agrees; do both images show the same place?\n");
    return found ? 0 : 3;
}
catch (const cv::Exception& e)
{
    std::fprintf(stderr, "iib_demo: %s\n", e.err.c_str());
    return 2;
}

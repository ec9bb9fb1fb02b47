// SPDX-License-Identifier: Apache-2.0

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>

#include "../detectors.hpp"
#include "../experiments.hpp"
#include "../results.hpp"
#include "../seeded.hpp"
#include "opencv2/iib.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "iib_geometry/test/test_folder.hpp"

namespace {
using namespace iib_tools;

std::string contents(const std::string& file)
{
    std::ifstream in(file);
    return std::string((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
}

//! The number after `start` in a table, -1 if there is none.
int valueAfter(const std::string& table, const std::string& start)
{
    const size_t at = table.find("\n" + start);
    return at == std::string::npos ? -1 : std::atoi(table.c_str() + at + 1 + start.size());
}

//! Two sequences of random blocks under changed illumination: a static camera with depth, and one that shifts.
class EvaluationTest : public ::testing::Test
{
protected:
    void SetUp() CV_OVERRIDE
    {
        cv::RNG rng(7);
        cv::Mat scene(240, 320, CV_8UC1, cv::Scalar(90));
        for (int i = 0; i < 900; i++)
        {
            const int y = rng.uniform(0, 240), x = rng.uniform(0, 320), height = rng.uniform(4, 26),
                      width = rng.uniform(4, 26);
            cv::rectangle(scene, cv::Rect(x, y, width, height), cv::Scalar(rng.uniform(20, 230)), -1);
        }
        folder.makeFolder("data/set/still/depth");
        folder.makeFolder("data/set/v_shift");
        cv::Mat dark, noise(scene.size(), CV_8UC1), shifted;
        const cv::Matx23d shift(1, 0, 9, 0, 1, -4);
        rng.fill(noise, cv::RNG::UNIFORM, 0, 12);
        scene.convertTo(dark, CV_8U, 0.1, 10);
        dark += noise;
        cv::Mat depth;
        cv::resize(scene, depth, scene.size());
        write("still/1.png", scene);
        write("still/2.png", dark);
        write("still/depth/1.png", depth);
        write("still/depth/2.png", depth);
        cv::warpAffine(dark, shifted, shift, dark.size());
        write("v_shift/1.png", scene);
        write("v_shift/2.png", shifted);
        folder.write("data/set/v_shift/H_1_2", "1 0 9 0 1 -4 0 0 1");

        options.roots = {folder.path("data")};
        options.out = folder.path("results");
        options.points = 200;
    }

    void write(const std::string& name, const cv::Mat& image)
    {
        ASSERT_TRUE(cv::imwrite(folder.path("data/set/" + name), image));
    }

    std::vector<Fields> fixedPointsRows() const
    {
        return readRows(options.out + "/fixed_points.csv", seededColumns());
    }

    double recallOf(const std::string& target, const std::string& configuration) const
    {
        for (const Fields& row : fixedPointsRows())
            if (row[1] == target && row[4] == configuration)
                return std::atof(row[10].c_str());
        ADD_FAILURE() << "no row of " << target << ", " << configuration;
        return -1;
    }

    TestFolder folder;
    Options options;
};

TEST_F(EvaluationTest, whole_run_and_its_repetition)
{
    if (const char* kept = std::getenv("IIB_EVALUATION_RESULTS"))  // the test of the report reads them
    {
        options.out = kept;
        cv::utils::fs::remove_all(kept);
    }
    options.compare = {folder.path("data/set/still/1.png"), folder.path("data/set/still/2.png")};
    EXPECT_EQ(0, evaluate(options));
    EXPECT_GT(recallOf("still", "IIB"), 0.9);
    EXPECT_GT(recallOf("v_shift", "IIB"), 0.9);
    EXPECT_GT(recallOf("still", "IIB"), recallOf("still", "IIB g2"));
    EXPECT_GT(recallOf("still", "IIB +depth"), 0.9);
    EXPECT_GT(recallOf("still", "IIB +texture"), 0.9);
    const std::vector<std::string> tables = {
            "fixed_points", "detected_points", "matching", "robustness", "comparison"};
    std::vector<std::string> first;
    for (const std::string& name : tables)
        first.push_back(contents(options.out + "/" + name + ".csv"));
    EXPECT_EQ(0, evaluate(options));  // a second run changes nothing
    for (size_t i = 0; i < tables.size(); i++)
        EXPECT_EQ(first[i], contents(options.out + "/" + tables[i] + ".csv")) << tables[i];
    for (const char* picture : {"1", "2"})
        EXPECT_FALSE(cv::imread(options.out + "/pictures/" + picture + ".jpg").empty()) << picture;
    for (const char* method : {"Hessian,IIB UNIVERSAL", "ORB,ORB"})
        EXPECT_NE(std::string::npos, first.back().find(method)) << method;

    options.points = 100;
    EXPECT_NE(std::string::npos, messageOf([&] { evaluate(options); }).find("settings"));
}

TEST_F(EvaluationTest, an_interrupted_run_goes_on_to_the_same_result)
{
    for (const std::string experiment : {"robustness", "fixed_points"})
    {
        options.experiments = {experiment};
        evaluate(options);
        const std::string file = options.out + "/" + experiment + ".csv", whole = contents(file);
        std::ofstream(file) << whole.substr(0, whole.size() / 2);
        evaluate(options);
        EXPECT_EQ(whole, contents(file)) << experiment;
    }
    const std::string whole = contents(options.out + "/fixed_points.csv");

    const int threads = cv::getNumThreads();
    cv::setNumThreads(1);
    options.out = folder.path("serial");
    evaluate(options);
    cv::setNumThreads(threads);
    EXPECT_EQ(whole, contents(options.out + "/fixed_points.csv"));
}

TEST_F(EvaluationTest, broken_files_are_counted_and_the_rest_goes_on)
{
    folder.write("data/set/still/3.png", "no image");
    folder.write("data/set/v_shift/3.png", "no image");
    folder.write("data/set/v_shift/H_1_3", "1 2 3");
    options.experiments = {"fixed_points"};
    EXPECT_EQ(2, evaluate(options));
    EXPECT_GT(recallOf("still", "IIB"), 0.9);
}

TEST_F(EvaluationTest, points_are_of_the_detectors_asked_for)
{
    options.experiments = {"detected_points"};
    options.detectors = {"FAST", "FAST normalized"};
    write("still/3.png", cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)));
    write("still/depth/3.png", cv::Mat(240, 320, CV_8UC1, cv::Scalar(90)));
    evaluate(options);
    const std::string whole = contents(options.out + "/detected_points.csv");
    EXPECT_GT(valueAfter(whole, "set,still,2,FAST normalized,ORB,light,32,"), 0);
    EXPECT_EQ(0, valueAfter(whole, "set,still,3,FAST,ORB,light,32,"));  // the third image shows nothing
    EXPECT_EQ(std::string::npos, whole.find(",SIFT,"));
    EXPECT_GT(valueAfter(whole, "set,still,2,FAST normalized,IIB UNIVERSAL,light,128,"), 20);
}

TEST_F(EvaluationTest, thresholds_cost_less_and_lose_matches)
{
    options.experiments = {"matching"};
    evaluate(options);
    std::map<std::string, Fields> rows;
    for (const Fields& row : readRows(options.out + "/matching.csv",
                 {"set", "sequence", "target", "matcher", "kind", "correct", "putative", "correspondences",
                         "precision", "recall", "cost", "milliseconds"}))
        if (row[1] == "still")
            rows[row[3]] = row;
    ASSERT_EQ(10u, rows.size());
    EXPECT_EQ(rows["BFMatcher"][5], rows["EXACT"][5]);
    for (const char* column : {"H-t-0.20", "H-t-0.35"})
    {
        EXPECT_LT(std::atof(rows[column][10].c_str()), std::atof(rows["H-t-0.50"][10].c_str())) << column;
        EXPECT_LE(std::atoi(rows[column][5].c_str()), std::atoi(rows["H-t-0.50"][5].c_str())) << column;
    }
    EXPECT_LE(std::atof(rows["H-t-0.50"][10].c_str()), 1);
    for (const auto& row : rows)
        EXPECT_GT(std::atof(row.second[11].c_str()), 0) << row.first;
}

TEST_F(EvaluationTest, keypoints_of_files_are_described)
{
    folder.makeFolder("network/set/still");
    std::string own, plain;
    for (int i = 0; i < 40; i++)
    {
        const cv::String point = cv::format("%d,%d,64,-1,%d", 40 + i % 8 * 30, 40 + i / 8 * 30, i);
        plain += point + "\n";
        own += point + cv::format(",%d,%d\n", i, i * i);
    }
    folder.write("network/set/still/1.csv", "x,y,size,angle,response\n" + own);
    folder.write("network/set/still/2.csv", "x,y,size,angle,response\n" + own);
    options.experiments = {"detected_points"};
    options.detectors = {"FAST"};
    options.keypoints = {folder.path("network/")};
    EXPECT_EQ(0, evaluate(options));
    const std::string file = options.out + "/detected_points.csv";
    EXPECT_EQ(40, valueAfter(contents(file), "set,still,2,network,network,light,8,"));
    EXPECT_GT(valueAfter(contents(file), "set,still,2,network,IIB,light,170,"), 30);
    // All equal descriptors are right at the smallest threshold.
    EXPECT_NE(std::string::npos, contents(file).find("network,network,light,8,40,40,40,1,1,40:40 40:40"));
    EXPECT_EQ(std::string::npos, contents(file).find("v_shift,2,network"));

    folder.write("network/set/still/1.csv", plain);
    folder.write("network/set/still/2.csv", plain);
    options.out = folder.path("plain");
    EXPECT_EQ(0, evaluate(options));
    const std::string without = contents(options.out + "/detected_points.csv");
    EXPECT_EQ(std::string::npos, without.find("network,network"));
    EXPECT_NE(std::string::npos, without.find("network,IIB,light,170,"));
}

TEST_F(EvaluationTest, invalid_options_are_refused)
{
    options.experiments = {"unknown_points"};
    EXPECT_NE(std::string::npos, messageOf([&] { evaluate(options); }).find("unknown_points"));
    options.experiments = {"detected_points"};
    options.detectors = {"SIFTER"};
    EXPECT_NE(std::string::npos,
            messageOf([&] { evaluate(options); }).find("unknown detector SIFTER; there are FAST"));
    options.experiments.clear();
    folder.makeFolder("empty");
    options.roots = {folder.path("empty")};
    EXPECT_NE(std::string::npos, messageOf([&] { evaluate(options); }).find("no image sequences"));
    folder.makeFolder("broken/set/sequence");
    for (const char* image : {"1", "2"})
        folder.write(std::string("broken/set/sequence/") + image + ".png", "no image");
    options.roots = {folder.path("broken")};
    testing::internal::CaptureStderr();
    EXPECT_EQ("none of the 1 image pairs can be read", messageOf([&] { evaluate(options); }));
    EXPECT_NE(
            std::string::npos, testing::internal::GetCapturedStderr().find("1.png: not a readable image\n"));
}

// Presets are evaluated with the parameters of createFor and createRecommended, and the ROS that they were learned for.
TEST(Detectors, presets_are_described_with_their_own_scale)
{
    cv::Mat image(200, 260, CV_8U), expected;
    cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::GaussianBlur(image, image, cv::Size(), 2);
    Options options;
    options.points = 50;
    options.detectors = {"ORB"};
    const Detector detector = detectors(options).at(0);
    std::vector<cv::KeyPoint> keypoints = detector.detect(image, "").keypoints;
    cv::iib::IIB::createPreset(cv::iib::IIB::PRESET_UNIVERSAL, detector.scaleFactor)
            ->cv::Feature2D::compute(image, keypoints, expected);
    ASSERT_GT(expected.rows, 20);
    cv::Mat found;
    for (const Described& d : describeAll(detector, image, ""))
        if (d.name == "IIB UNIVERSAL")
            found = d.descriptors;
    ASSERT_EQ(expected.size(), found.size());
    EXPECT_EQ(0, cv::norm(expected, found, cv::NORM_HAMMING));
}

TEST(Results, a_line_cut_short_is_left_out)
{
    TestFolder folder;
    folder.makeFolder("");
    folder.write("t.csv", "a,b\n1,2\n3,4");
    EXPECT_EQ(std::vector<Fields>({{"1", "2"}}), readRows(folder.path("t.csv"), {"a", "b"}));
    ResultTable table(folder.path("t.csv"), {"a", "b"}, 1);
    EXPECT_TRUE(table.has({"1"}));
    EXPECT_FALSE(table.has({"3"}));
    table.append({"0", "5"});
    EXPECT_EQ("a,b\n1,2\n0,5\n", contents(folder.path("t.csv")));
    table.finish();
    EXPECT_EQ("a,b\n0,5\n1,2\n", contents(folder.path("t.csv")));
    EXPECT_NE("", messageOf([&] { ResultTable(folder.path("t.csv"), {"a", "c"}, 1); }));
}

TEST(Tasks, a_failure_is_counted_and_the_others_run)
{
    std::vector<int> done(9, 0);
    std::vector<Task> tasks;
    for (size_t i = 0; i < done.size(); i++)
        tasks.push_back({"task", [&done, i] {
                             if (i % 4 == 1)
                                 CV_Error(cv::Error::StsError, "broken");
                             done[i] = 1;
                         }});
    EXPECT_EQ(2, runTasks("test", tasks));
    EXPECT_EQ(std::vector<int>({1, 0, 1, 1, 1, 0, 1, 1, 1}), done);
}

}  // namespace

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "experiments.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/imgcodecs.hpp"
#include "opencv2/imgproc.hpp"
#include "results.hpp"
#include "seeded.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

const int WIDTH = 640;    // of a picture, pixels
const size_t LINES = 60;  // matches drawn at most

struct Choice
{
    std::string name, rank;
    double recall;
};

//! The worst and best pairs of each set by the default's recall, from the table of fixed points.
std::vector<Choice> choose(const std::vector<Fields>& rows, int count)
{
    std::map<std::string, std::vector<Choice>> sets;
    for (const Fields& row : rows)
        if (row[3] == "IIB")
            sets[row[0]].push_back({row[0] + "/" + row[1] + "/" + row[2], "", std::atof(row[10].c_str())});
    std::vector<Choice> chosen;
    for (auto& set : sets)
    {
        std::vector<Choice>& all = set.second;
        std::stable_sort(
                all.begin(), all.end(), [](const Choice& a, const Choice& b) { return a.recall < b.recall; });
        const int n = int(all.size());
        for (int i = 0; i < n; i++)
        {
            const bool worst = i < count && i < (n + 1) / 2;
            if (!worst && i < n - count)
                continue;
            all[i].rank = worst ? "worst " + std::to_string(i + 1) : "best " + std::to_string(n - i);
            chosen.push_back(all[i]);
        }
    }
    return chosen;
}

cv::Mat draw(const LoadedPair& loaded, const SeededMatches& m)
{
    const double scale = double(WIDTH) / (loaded.reference.cols + loaded.target.cols);
    cv::Mat left, right, picture;
    cv::resize(loaded.reference, left, cv::Size(), scale, scale, cv::INTER_AREA);
    cv::resize(loaded.target, right, cv::Size(), scale, scale, cv::INTER_AREA);
    cv::Mat both(std::max(left.rows, right.rows), left.cols + right.cols, CV_8UC1, cv::Scalar(0));
    left.copyTo(both(cv::Rect(cv::Point(), left.size())));
    right.copyTo(both(cv::Rect(cv::Point(left.cols, 0), right.size())));
    cv::cvtColor(both, picture, cv::COLOR_GRAY2BGR);
    const size_t step = m.matches.size() / LINES + 1;
    for (size_t i = 0; i < m.matches.size(); i += step)
    {
        const cv::Point2f a = m.reference.keypoints[m.matches[i].queryIdx].pt * scale;
        const cv::Point2f b =
                m.target.keypoints[m.matches[i].trainIdx].pt * scale + cv::Point2f(float(left.cols), 0);
        const cv::Scalar colour = m.correct[i] ? cv::Scalar(90, 200, 40) : cv::Scalar(40, 60, 230);
        cv::line(picture, a, b, colour, 1, cv::LINE_AA);
    }
    return picture;
}

void drawPair(const Options& options, const ImagePair& pair, const Choice& choice, ResultTable& table)
{
    const Configuration iib = iibConfigurations().front();
    const LoadedPair loaded = loadPair(pair);
    SeededPair seeded;
    seeded.reference = loaded.reference;
    seeded.target = loaded.target;
    seeded.homography = loaded.homography;
    seeded.seeds =
            SeedSource(loaded.reference, options.points).seeds(iib, loaded.target.size(), loaded.homography);
    const SeededMatches m = matchSeeds(iib, seeded, options.tolerance);
    const std::string file = "pictures/" + pair.set + "_" + pair.sequence + "_" + pair.target + ".jpg";
    if (!cv::imwrite(options.out + "/" + file, draw(loaded, m), {cv::IMWRITE_JPEG_QUALITY, 75}))
        CV_Error(cv::Error::StsError, file + ": cannot be written");
    table.append({pair.set, choice.rank, pair.sequence, pair.target, std::to_string(m.counts.correct),
            std::to_string(m.counts.putative), std::to_string(m.counts.correspondences), file});
}

}  // namespace

int pictures(const Options& options, const std::vector<ImagePair>& pairs)
{
    if (options.worst == 0)
        return 0;
    cv::utils::fs::createDirectories(options.out + "/pictures");
    const std::string file = options.out + "/pictures.csv";
    std::remove(file.c_str());  // the ranks may have changed
    ResultTable table(
            file, {"set", "rank", "sequence", "target", "correct", "putative", "correspondences", "file"}, 2);
    std::map<std::string, ImagePair> byName;
    for (const ImagePair& pair : pairs)
        byName[pair.name()] = pair;

    std::vector<Task> tasks;
    for (const Choice& choice :
            choose(readRows(options.out + "/fixed_points.csv", fixedPointsColumns()), options.worst))
    {
        const auto found = byName.find(choice.name);
        if (found == byName.end())
            continue;
        const ImagePair pair = found->second;
        tasks.push_back(
                {choice.name, [&options, &table, pair, choice] { drawPair(options, pair, choice, table); }});
    }
    const int skipped = runTasks("pictures", tasks);
    table.finish();
    return skipped;
}

}  // namespace iib_tools

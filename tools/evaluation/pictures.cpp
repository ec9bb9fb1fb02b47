// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "common/metrics.hpp"
#include "detectors.hpp"
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

struct Drawn
{
    std::vector<cv::KeyPoint> reference, target;
    std::vector<cv::DMatch> matches;
    std::vector<bool> correct;
};

cv::Mat draw(const LoadedPair& loaded, const Drawn& m)
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
    std::vector<size_t> drawn;
    for (size_t i = 0; i < m.matches.size(); i += step)
        drawn.push_back(i);
    // The right ones lie above the wrong ones.
    std::stable_partition(drawn.begin(), drawn.end(), [&](size_t i) { return !m.correct[i]; });
    for (size_t i : drawn)
    {
        const cv::Point2f a = m.reference[m.matches[i].queryIdx].pt * scale;
        const cv::Point2f b = m.target[m.matches[i].trainIdx].pt * scale + cv::Point2f(float(left.cols), 0);
        const cv::Scalar colour = m.correct[i] ? cv::Scalar(90, 200, 40) : cv::Scalar(40, 60, 230);
        cv::line(picture, a, b, colour, 1, cv::LINE_AA);
    }
    return picture;
}

void writePicture(const std::string& file, const cv::Mat& picture)
{
    if (!cv::imwrite(file, picture, {cv::IMWRITE_JPEG_QUALITY, 75}))
        CV_Error(cv::Error::StsError, file + ": cannot be written");
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
    writePicture(options.out + "/" + file,
            draw(loaded, {m.reference.keypoints, m.target.keypoints, m.matches, m.correct}));
    table.append({pair.set, choice.rank, pair.sequence, pair.target, std::to_string(m.counts.correct),
            std::to_string(m.counts.putative), std::to_string(m.counts.correspondences), file});
}

//! A row for each mutual match of these descriptors at the detector's points.
void listMatches(const Options& options, const ImagePair& pair, const Detector& detector,
        const std::vector<std::string>& descriptors, ResultTable& table)
{
    const LoadedPair loaded = loadPair(pair);
    const std::vector<Described> reference = describeAll(detector,
                                         detector.detect(loaded.reference, pair, pair.referenceFile),
                                         loaded.reference),
                                 target = describeAll(detector,
                                         detector.detect(loaded.target, pair, pair.targetFile),
                                         loaded.target);
    for (size_t i = 0; i < reference.size(); i++)
    {
        const Described &r = reference[i], &t = target[i];
        if (std::find(descriptors.begin(), descriptors.end(), r.name) == descriptors.end())
            continue;
        const std::vector<cv::DMatch> matches = mutualMatches(r.descriptors, t.descriptors, r.norm);
        const std::vector<bool> correct =
                correctByLocation(matches, r.keypoints, t.keypoints, loaded.homography, options.tolerance);
        for (size_t m = 0; m < matches.size(); m++)
        {
            const cv::Point2f a = r.keypoints[matches[m].queryIdx].pt,
                              b = t.keypoints[matches[m].trainIdx].pt;
            table.append({pair.set, pair.target, detector.name, r.name, cv::format("%.1f", a.x),
                    cv::format("%.1f", a.y), cv::format("%.1f", b.x), cv::format("%.1f", b.y),
                    correct[m] ? "1" : "0"});
        }
    }
}

}  // namespace

int comparison(const Options& options, const std::vector<ImagePair>&)
{
    if (options.compare.empty())
        return 0;
    cv::utils::fs::createDirectories(options.out + "/pictures");
    const std::string file = options.out + "/comparison.csv";
    std::remove(file.c_str());
    ResultTable table(file,
            {"set", "target", "detector", "descriptor", "x", "y", "target_x", "target_y", "correct"}, 8);
    Options classic = options;
    classic.keypoints.clear();
    classic.network.clear();
    classic.detectors = {"Hessian", "ORB", "SIFT"};
    std::vector<Task> tasks;
    for (const ImagePair& pair : findPairs({options.compare}))
    {
        writePicture(
                options.out + "/pictures/reference.jpg", readImage(pair.referenceFile, cv::IMREAD_COLOR));
        writePicture(options.out + "/pictures/target.jpg", readImage(pair.targetFile, cv::IMREAD_COLOR));
        for (const Detector& detector : detectors(classic))
            tasks.push_back({pair.name() + " " + detector.name, [&options, &table, pair, detector] {
                                 listMatches(options, pair, detector,
                                         {detector.name == "Hessian" ? "IIB UNIVERSAL" : detector.name},
                                         table);
                             }});
    }
    const int skipped = runTasks("comparison", tasks);
    table.finish();
    return skipped;
}

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

// SPDX-License-Identifier: Apache-2.0

#include "view_pairs.hpp"

#include "common/dataset.hpp"
#include "described_images.hpp"
#include "opencv2/imgcodecs.hpp"
#include "tasks.hpp"

namespace iib_tools {
namespace {

//! A grey image in another light.
cv::Mat relit(const cv::Mat& image, int light)
{
    const struct
    {
        double gamma, left, right, top, bottom, noise;
    } all[] = {{2.2, 1, .25, 1, 1, 2}, {.45, 1, 1, 1, 1, 3}, {1.5, .3, .3, .4, 1.2, 4}}, l = all[light];
    cv::Mat_<float> out, noise(image.size());
    image.convertTo(out, CV_32F, 1 / 255.);
    cv::pow(out, l.gamma, out);
    cv::RNG(light + 1).fill(noise, cv::RNG::NORMAL, 0, l.noise);
    for (int y = 0; y < out.rows; y++)
        for (int x = 0; x < out.cols; x++)
            out(y, x) = float(out(y, x) * 255 * (l.left + (l.right - l.left) * x / out.cols) *
                                      (l.top + (l.bottom - l.top) * y / out.rows) +
                              noise(y, x));
    cv::Mat bytes;
    out.convertTo(bytes, CV_8U);
    return bytes;
}

}  // namespace

std::vector<LitPair> withRelit(const std::vector<ViewPair>& pairs)
{
    std::vector<LitPair> all;
    int light = 0;
    for (const ViewPair& pair : pairs)
    {
        all.push_back({pair, -1});
        if (!pair.sameLight)
            continue;
        all.push_back({pair, light++ % 3});
        all.back().views.set += " relit";
    }
    return all;
}

int runOnViews(const std::string& title, const std::vector<LitPair>& pairs,
        const std::vector<Detector>& detectors, const ViewExperiment& experiment)
{
    DescribedImages described;
    std::vector<Task> tasks;
    for (const LitPair& pair : pairs)
    {
        const ViewPair& views = pair.views;
        std::vector<Detector> missing;
        for (const Detector& d : detectors)
            if (!experiment.isDone(views, d))
                missing.push_back(d);
        const auto run = [&, missing] {
            const cv::Mat reference = readImage(views.referenceFile, cv::IMREAD_GRAYSCALE);
            cv::Mat target = readImage(views.targetFile, cv::IMREAD_GRAYSCALE);
            std::string name = views.targetFile;
            if (pair.light >= 0)
            {
                target = relit(target, pair.light);
                name += std::to_string(pair.light);
            }
            for (const Detector& detector : missing)
            {
                const DescribedImages::Result ofReference =
                                                      described.get(detector, reference, views.referenceFile),
                                              ofTarget = described.get(detector, target, name);
                for (size_t i = 0; i < ofReference->size(); i++)
                    experiment.judge(views, detector, reference, target, (*ofReference)[i], (*ofTarget)[i]);
            }
        };
        if (!missing.empty())
            tasks.push_back({views.set + "/" + views.sequence + "/" + views.target, run});
    }
    return runTasks(title, tasks);
}

}  // namespace iib_tools

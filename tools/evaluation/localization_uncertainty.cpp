// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "common/dataset.hpp"
#include "common/views.hpp"
#include "experiments.hpp"
#include "opencv2/core/utils/filesystem.hpp"
#include "opencv2/iib/localization.hpp"
#include "opencv2/imgcodecs.hpp"
#include "results.hpp"
#include "uncertainty.hpp"

namespace iib_tools {
namespace {

namespace fs = cv::utils::fs;
using cv::iib::Localizer;
using cv::iib::PosedImage;

//! A map of some views, and others that are looked for in it.
struct Search
{
    std::string set, map, light;
    ViewFolder mapped, sought;

    Fields key(const View& view) const { return {set, map, light, view.name}; }
};

/** In a folder `map`, the views of those beside it. Where there is none, each folder's own: one that is left out, every other one in a
map of the rest, and two of three. */
std::vector<Search> searchesOf(const std::string& set, const std::vector<ViewFolder>& folders)
{
    std::vector<Search> all;
    const auto mapped = std::find_if(
            folders.begin(), folders.end(), [](const ViewFolder& folder) { return folder.name == "map"; });
    for (const ViewFolder& folder : folders)
    {
        const int count = int(folder.views.size());
        if (mapped != folders.end() && &folder != &*mapped)
            all.push_back({set, "map", folder.name, *mapped, folder});
        for (int step : {2, 3, count})
            for (int part = 0; part < step && mapped == folders.end(); part++)
            {
                Search search = {set, cv::format("%s without %d of %d", folder.name.c_str(), part + 1, step),
                        "same", folder, folder};
                search.mapped.views.clear();
                search.sought.views.clear();
                for (int i = 0; i < count; i++)
                    (i % step == part ? search.sought : search.mapped).views.push_back(folder.views[i]);
                all.push_back(search);
            }
    }
    return all;
}

cv::iib::Camera cameraOf(const cv::Matx33d& m, const cv::Size& size)
{
    return {"PINHOLE", size, {m(0, 0), m(1, 1), m(0, 2) + .5, m(1, 2) + .5}};
}

//! A map in memory.
std::unique_ptr<Localizer> localizerOf(const ViewFolder& mapped, int points)
{
    std::map<std::string, std::string> files;
    std::vector<PosedImage> images;
    for (const View& view : mapped.views)
    {
        PosedImage image;
        image.name = baseName(view.file);
        image.camera = cameraOf(mapped.camera, readImage(view.file, cv::IMREAD_GRAYSCALE).size());
        image.cameraFromWorld = cv::Affine3d(view.rotation.t(), -(view.rotation.t() * view.position));
        images.push_back(image);
        files[image.name] = view.file;
    }
    const std::string model = cv::tempfile();
    fs::createDirectories(model);
    cv::iib::writeModel(model, images);
    const auto read = [&](const std::string& name) {
        return readImage(files.at(name), cv::IMREAD_GRAYSCALE);
    };
    std::unique_ptr<Localizer> localizer(new Localizer(model, read, points));
    fs::remove_all(model);
    return localizer;
}

//! Errors of an image's place and rotation; no errors where it was not found.
void judgeLocation(const cv::iib::Location& found, const View& truth, const ErrorRows& rows)
{
    std::vector<JudgedError> centre, rotation;
    if (found.found)
    {
        const cv::Matx33d toWorld = found.cameraFromWorld.rotation().t();
        centre.push_back(judged(-(toWorld * found.cameraFromWorld.translation()) - truth.position,
                found.covariance.get_minor<3, 3>(0, 0)));
        rotation.push_back(judged(
                cv::Affine3d(toWorld * truth.rotation.t()).rvec(), found.covariance.get_minor<3, 3>(3, 3)));
    }
    rows.add("centre of Localizer", centre, 3);
    rows.add("rotation of Localizer", rotation, 3);
}

}  // namespace

int localizationUncertainty(const Options& options, const std::vector<ImagePair>&)
{
    ResultTable table(options.out + "/localization_uncertainty.csv",
            ErrorRows::columns({"set", "map", "light", "query"}), 5);
    std::vector<Task> tasks;
    for (const auto& place : findViewFolders(options.roots))
        for (const Search& search : searchesOf(baseName(place.first), place.second))
        {
            const auto known = [&](const View& view) {
                Fields key = search.key(view);
                key.push_back("rotation of Localizer");
                return table.has(key);
            };
            const std::vector<View>& sought = search.sought.views;
            if (search.mapped.views.size() < 2 || std::all_of(sought.begin(), sought.end(), known))
                continue;
            const auto run = [&, search] {
                const std::unique_ptr<Localizer> localizer = localizerOf(search.mapped, options.points);
                for (const View& view : search.sought.views)
                {
                    const cv::Mat image = readImage(view.file, cv::IMREAD_GRAYSCALE);
                    judgeLocation(localizer->localize(image, cameraOf(search.sought.camera, image.size())),
                            view, ErrorRows(table, search.key(view)));
                }
            };
            tasks.push_back({search.set + "/" + search.map + "/" + search.light, run});
        }
    return runTasks("localization_uncertainty", tasks, &table);
}

}  // namespace iib_tools

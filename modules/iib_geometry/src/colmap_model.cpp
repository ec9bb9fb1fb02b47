// SPDX-License-Identifier: Apache-2.0

#include "colmap_model.hpp"

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <unordered_map>

#include "../../iib/src/common/checked_file.hpp"
#include "lens.hpp"
#include "opencv2/core/quaternion.hpp"

namespace iib_localization {
namespace {

namespace fs = std::filesystem;

//! Opens a file of a model and says what is wrong with it.
class Reader
{
public:
    Reader(const std::string& folder, const std::string& name) : name_(name)
    {
        const fs::path path = cv::iib::systemName(folder + "/" + name);
        std::error_code error;
        expect(fs::is_regular_file(path, error));  // a pipe would not end
        left_ = fs::file_size(path, error);
        stream_.open(path, std::ios::binary);
        expect(!error && stream_);
    }

    void expect(bool valid) const
    {
        if (!valid)
            CV_Error(cv::Error::StsParseError, name_ + " is missing or damaged");
    }

protected:
    const std::string name_;
    std::ifstream stream_;
    uint64_t left_ = 0;
};

//! The numbers of a file, one after another, lowest byte first as on every machine that this runs on.
class BinaryReader : public Reader
{
public:
    using Reader::Reader;

    template <typename T> T next()
    {
        T value{};
        expect(sizeof(T) <= left_ && stream_.read(reinterpret_cast<char*>(&value), sizeof(T)));
        left_ -= sizeof(T);
        return value;
    }

    //! How many things follow, each of so many bytes or more.
    uint64_t count(uint64_t bytes)
    {
        const uint64_t things = next<uint64_t>();
        expect(things <= left_ / bytes);
        return things;
    }

    void finish() const { expect(left_ == 0); }
};

//! The lines of a file but for comments.
class TextReader : public Reader
{
public:
    using Reader::Reader;

    bool next(std::istringstream& line)
    {
        std::string text;
        do
            if (!std::getline(stream_, text))
                return false;
        while (!text.empty() && text[0] == '#');
        line.clear();
        line.str(text);
        return true;
    }

    //! The next line that is not blank.
    bool nextFilled(std::istringstream& line)
    {
        while (next(line))
            if (!(line >> std::ws).eof())
                return true;
        return false;
    }

    template <typename T> T take(std::istringstream& line) const
    {
        T value{};
        expect(bool(line >> value));
        return value;
    }
};

//! A model as its files are read.
class Model
{
public:
    void addCamera(const Reader& file, uint32_t id, const Camera& camera)
    {
        file.expect(camera.size.width > 0 && camera.size.height > 0 &&
                    std::max(camera.size.width, camera.size.height) < 1 << 16);
        Lens checked(camera);
        file.expect(cameras_.emplace(id, camera).second);
    }

    //! @param pose quaternion w x y z, translation.
    PosedImage& addImage(
            const Reader& file, const double (&pose)[7], uint32_t camera, const std::string& name)
    {
        const cv::Quatd rotation(pose[0], pose[1], pose[2], pose[3]);
        const auto known = cameras_.find(camera);
        file.expect(known != cameras_.end() && !name.empty() && std::abs(rotation.norm() - 1) < 1e-2 &&
                    names_.insert(name).second);
        for (double value : pose)
            file.expect(std::isfinite(value));
        images.push_back({name, known->second, {rotation.toRotMat3x3(), cv::Vec3d(pose + 4)}, {}, {}});
        return images.back();
    }

    void addKeypoint(PosedImage& image, double x, double y, int64_t point)
    {
        image.pixels.emplace_back(x - .5, y - .5);
        image.sees.push_back(point < 0 ? -1 : points_.emplace(point, int(points_.size())).first->second);
    }

    std::vector<PosedImage> images;

private:
    std::unordered_map<uint32_t, Camera> cameras_;
    std::unordered_map<int64_t, int> points_;
    std::set<std::string> names_;
};

Model readBinary(const std::string& folder)
{
    Model model;
    BinaryReader cameras(folder, "cameras.bin"), images(folder, "images.bin");
    for (uint64_t left = cameras.count(24); left > 0; left--)
    {
        const uint32_t id = cameras.next<uint32_t>(), number = cameras.next<uint32_t>();
        const uint64_t width = cameras.next<uint64_t>(), height = cameras.next<uint64_t>();
        if (!modelName(number))
            CV_Error(cv::Error::StsError, cv::format("camera model %u is not known", number));
        cameras.expect(std::max(width, height) < 1 << 16);
        Camera camera = {modelName(number), {int(width), int(height)}, {}};
        for (size_t i = parametersOf(camera.model); i > 0; i--)
            camera.parameters.push_back(cameras.next<double>());
        model.addCamera(cameras, id, camera);
    }
    cameras.finish();
    for (uint64_t left = images.count(73); left > 0; left--)
    {
        images.next<uint32_t>();  // its id
        double pose[7];
        for (double& value : pose)
            value = images.next<double>();
        const uint32_t camera = images.next<uint32_t>();
        std::string name;
        while (const char c = images.next<char>())
            name += c;
        PosedImage& image = model.addImage(images, pose, camera, name);
        for (uint64_t keypoints = images.count(24); keypoints > 0; keypoints--)
        {
            const double x = images.next<double>(), y = images.next<double>();
            model.addKeypoint(image, x, y, images.next<int64_t>());
        }
    }
    images.finish();
    return model;
}

Model readText(const std::string& folder)
{
    Model model;
    TextReader cameras(folder, "cameras.txt"), images(folder, "images.txt");
    std::istringstream line;
    while (cameras.nextFilled(line))
    {
        const uint32_t id = cameras.take<uint32_t>(line);
        Camera camera = {cameras.take<std::string>(line), {}, {}};
        camera.size.width = cameras.take<int>(line);
        camera.size.height = cameras.take<int>(line);
        for (double value; line >> value;)
            camera.parameters.push_back(value);
        model.addCamera(cameras, id, camera);
    }
    while (images.nextFilled(line))
    {
        images.take<uint32_t>(line);  // its id
        double pose[7];
        for (double& value : pose)
            value = images.take<double>(line);
        const uint32_t camera = images.take<uint32_t>(line);
        std::string name;
        std::getline(line >> std::ws, name);  // it may have blanks
        name.erase(name.find_last_not_of(" \r") + 1);
        PosedImage& image = model.addImage(images, pose, camera, name);
        images.expect(images.next(line));
        for (double x; line >> x;)
        {
            const double y = images.take<double>(line);
            model.addKeypoint(image, x, y, images.take<int64_t>(line));
        }
        images.expect(line.eof());
    }
    return model;
}

//! Adds numbers to the end of a file, lowest byte first.
template <typename... Ts> void put(std::string& file, Ts... values)
{
    (file.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
}

}  // namespace

std::vector<PosedImage> readModel(const std::string& folder)
{
    std::error_code error;
    std::string hint;
    const auto exists = [&](const std::string& name) {
        return fs::exists(cv::iib::systemName(folder + name), error);
    };
    for (const std::string part : {"/0", "/sparse/0", "/sparse"})
        if (hint.empty() && (exists(part + "/cameras.bin") || exists(part + "/cameras.txt")))
            hint = ": did you mean " + folder + part + "?";
    try
    {
        const bool text = exists("/cameras.txt") && !exists("/cameras.bin");
        Model model = text ? readText(folder) : readBinary(folder);
        if (model.images.empty())
            CV_Error(cv::Error::StsError, "no image has a pose");
        return std::move(model.images);
    }
    catch (const cv::Exception& e)
    {
        CV_Error(cv::Error::StsError, folder + " is no COLMAP model, or a damaged one: " + e.err + hint);
    }
}

}  // namespace iib_localization

void cv::iib::writeModel(
        const std::string& folder, const std::vector<PosedImage>& images, const std::vector<Point3d>& points)
{
    using namespace iib_localization;
    std::string cameras, posed, seen;
    std::vector<std::pair<Camera, uint32_t>> known;
    std::vector<std::string> tracks(points.size());
    put(posed, uint64_t(images.size()));
    for (size_t i = 0; i < images.size(); i++)
    {
        const PosedImage& image = images[i];
        auto camera = std::find_if(
                known.begin(), known.end(), [&](const auto& k) { return same(k.first, image.camera); });
        if (camera == known.end())
        {
            Lens checked(image.camera);
            known.emplace_back(image.camera, uint32_t(known.size() + 1));
            camera = known.end() - 1;
            put(cameras, camera->second, modelNumber(image.camera.model), uint64_t(image.camera.size.width),
                    uint64_t(image.camera.size.height));
            for (double parameter : image.camera.parameters)
                put(cameras, parameter);
        }
        const Quatd q = Quatd::createFromRotMat(image.cameraFromWorld.rotation());
        const Vec3d t = image.cameraFromWorld.translation();
        put(posed, uint32_t(i + 1), q.w, q.x, q.y, q.z, t[0], t[1], t[2], camera->second);
        posed += image.name + '\0';
        put(posed, uint64_t(image.pixels.size()));
        for (size_t k = 0; k < image.pixels.size(); k++)
        {
            const int point = k < image.sees.size() ? image.sees[k] : -1;
            put(posed, image.pixels[k].x + .5, image.pixels[k].y + .5, int64_t(point < 0 ? -1 : point + 1));
            if (point >= 0)
                put(tracks.at(size_t(point)), uint32_t(i + 1), uint32_t(k));
        }
    }
    put(seen, uint64_t(points.size()));
    for (size_t i = 0; i < points.size(); i++)
    {
        put(seen, uint64_t(i + 1), points[i].x, points[i].y, points[i].z, uchar(0), uchar(0), uchar(0), -1.,
                uint64_t(tracks[i].size() / 8));
        seen += tracks[i];
    }
    std::string count;
    put(count, uint64_t(known.size()));
    cv::iib::writeText(folder + "/cameras.bin", count + cameras);
    cv::iib::writeText(folder + "/images.bin", posed);
    cv::iib::writeText(folder + "/points3D.bin", seen);
}

// SPDX-License-Identifier: Apache-2.0

#include "colmap_model.hpp"

#include <filesystem>
#include <fstream>
#include <locale>
#include <memory>
#include <set>
#include <sstream>
#include <unordered_map>

#include "opencv2/iib/detail/files.hpp"
#include "opencv2/core/quaternion.hpp"

namespace cv::iib {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t LARGEST_SIDE = (1 << 16) - 1;  // pixels, of an image
constexpr double ROUNDING = 1e-4;                 // rotations may come rounded to a few digits

/** A file of a model. Binary: little-endian numbers, as on every supported machine; a list starts with its length.
Text: one line a record and a second line for an image's keypoints; lines of comments are skipped. */
class ModelFile
{
public:
    //! @param leastBytes smallest size of a record: a camera or an image.
    ModelFile(const std::string& folder, const std::string& name, bool text, uint64_t leastBytes)
        : name_(name + (text ? ".txt" : ".bin")), text_(text)
    {
        const fs::path path = systemName(folder + "/" + name_);
        std::error_code error;
        expect(fs::is_regular_file(path, error));  // a pipe would not end
        left_ = fs::file_size(path, error);
        stream_.open(path, std::ios::binary);
        line_.imbue(std::locale::classic());
        expect(!error && stream_);
        records_ = text_ ? 0 : count(leastBytes);
    }

    void expect(bool valid) const
    {
        if (!valid)
            CV_Error(Error::StsParseError, name_ + " is missing or damaged");
    }

    template <typename T> T next()
    {
        T value{};
        if (text_)
            expect(bool(line_ >> value));
        else
        {
            expect(sizeof(T) <= left_ && stream_.read(reinterpret_cast<char*>(&value), sizeof(T)));
            left_ -= sizeof(T);
        }
        return value;
    }

    //! Moves to the next camera or image; false at the end.
    bool nextRecord()
    {
        while (text_)
            if (!nextLine())
                return false;
            else if (more())  // skips blank lines
                return true;
        expect(records_ > 0 || left_ == 0);
        return records_-- > 0;
    }

    std::string cameraModel()
    {
        std::string model;
        if (text_)
            line_ >> model;
        else
            model = modelName(next<uint32_t>());
        items_ = parametersOf(model);
        return model;
    }

    //! Reads the name of an image; its keypoints follow.
    std::string name()
    {
        std::string letters;
        if (text_)
        {
            std::getline(line_ >> std::ws, letters);  // names may contain spaces
            letters.erase(letters.find_last_not_of(" \r") + 1);
            expect(nextLine());
            return letters;
        }
        while (const char c = next<char>())
            letters += c;
        items_ = count(24);
        return letters;
    }

    //! Whether the camera has one more parameter, or the image one more keypoint.
    bool more() { return text_ ? !(line_ >> std::ws).eof() : items_-- > 0; }

private:
    //! Reads the length of a list whose elements have at least so many bytes.
    uint64_t count(uint64_t leastBytes)
    {
        const uint64_t length = next<uint64_t>();
        expect(length <= left_ / leastBytes);
        return length;
    }

    bool nextLine()
    {
        std::string text;
        do
            if (!std::getline(stream_, text))
                return false;
        while (!text.empty() && text[0] == '#');
        line_.clear();
        line_.str(text);
        return true;
    }

    const std::string name_;
    const bool text_;
    std::ifstream stream_;
    std::istringstream line_;
    uint64_t left_ = 0, records_ = 0, items_ = 0;
};

std::vector<PosedImage> readImages(const std::string& folder, bool text)
{
    std::unordered_map<uint32_t, Camera> cameras;
    ModelFile known(folder, "cameras", text, 24);
    while (known.nextRecord())
    {
        const uint32_t id = known.next<uint32_t>();
        Camera camera = {known.cameraModel(), {}, {}};
        const uint64_t width = known.next<uint64_t>(), height = known.next<uint64_t>();
        known.expect(std::min(width, height) > 0 && std::max(width, height) <= LARGEST_SIDE);
        camera.size = Size(int(width), int(height));
        while (known.more())
            camera.parameters.push_back(known.next<double>());
        Lens checked(camera);
        known.expect(cameras.emplace(id, camera).second);
    }
    std::vector<PosedImage> images;
    std::unordered_map<int64_t, int> points;
    std::set<std::string> names;
    ModelFile file(folder, "images", text, 73);
    while (file.nextRecord())
    {
        file.next<uint32_t>();  // its id
        double pose[7];         // quaternion w x y z, translation
        for (double& value : pose)
        {
            value = file.next<double>();
            file.expect(std::isfinite(value));
        }
        const Quatd rotation(pose[0], pose[1], pose[2], pose[3]);
        const auto camera = cameras.find(file.next<uint32_t>());
        const std::string name = file.name();
        file.expect(camera != cameras.end() && std::abs(rotation.norm() - 1) < 1e-2 && !name.empty() &&
                    names.insert(name).second);
        images.push_back({name, camera->second, {rotation.toRotMat3x3(), Vec3d(pose + 4)}, {}, {}});
        while (file.more())
        {
            const double x = file.next<double>(), y = file.next<double>();
            const int64_t point = file.next<int64_t>();
            images.back().pixels.emplace_back(x - .5, y - .5);
            images.back().sees.push_back(
                    point < 0 ? -1 : points.emplace(point, int(points.size())).first->second);
        }
    }
    return images;
}

//! Checks that readModel will accept the model.
void checkModel(const std::vector<PosedImage>& images, const std::vector<Point3d>& points)
{
    if (images.empty())
        CV_Error(Error::StsBadArg, "a model needs at least one image");
    std::set<std::string> names;
    for (const PosedImage& image : images)
    {
        checkName(image.name);
        const auto require = [&](bool good, const std::string& why, Error::Code code = Error::StsBadArg) {
            if (!good)
                CV_Error(code, "image " + image.name + " " + why);
        };
        require(names.insert(image.name).second, "is there twice: names must be distinct");
        const Lens checked(image.camera);
        const Size& size = image.camera.size;
        require(uint64_t(std::max(size.width, size.height)) <= LARGEST_SIDE,
                format("has a camera of %d x %d pixels: at most %d a side", size.width, size.height,
                        int(LARGEST_SIDE)));
        const Matx33d rotation = image.cameraFromWorld.rotation();
        require(checkRange(image.cameraFromWorld.matrix), "has a pose that is not finite");
        require(norm(rotation * rotation.t() - Matx33d::eye()) < ROUNDING && determinant(rotation) > 0,
                "has a pose that scales, shears or mirrors: give a rotation and a translation");
        require(image.sees.size() <= image.pixels.size(),
                format("has %d keypoints, but %d indices of their points", int(image.pixels.size()),
                        int(image.sees.size())),
                Error::StsUnmatchedSizes);
        require(image.pixels.empty() || checkRange(image.pixels), "has a keypoint that is not finite");
        for (int point : image.sees)
            if (point >= int(points.size()))
                CV_Error(Error::StsOutOfRange, format("a keypoint of image %s sees point %d of %d points",
                                                       image.name.c_str(), point, int(points.size())));
    }
    if (!points.empty() && !checkRange(points))
        CV_Error(Error::StsBadArg, "a point of the model is not finite");
}

//! Appends numbers to the content of a file, little-endian.
template <typename... Ts> void put(std::string& file, Ts... values)
{
    (file.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
}

}  // namespace

std::vector<PosedImage> readModel(const std::string& folder)
{
    std::error_code error;
    std::string hint;
    const auto exists = [&](const std::string& name) { return fs::exists(systemName(folder + name), error); };
    for (const std::string part : {"/0", "/sparse/0", "/sparse"})
        if (hint.empty() && (exists(part + "/cameras.bin") || exists(part + "/cameras.txt")))
            hint = ": did you mean " + folder + part + "?";
    try
    {
        std::vector<PosedImage> images =
                readImages(folder, exists("/cameras.txt") && !exists("/cameras.bin"));
        if (images.empty())
            CV_Error(Error::StsError, "no image has a pose");
        return images;
    }
    catch (const Exception& e)
    {
        CV_Error(Error::StsError, folder + " is not a COLMAP model, or damaged: " + e.err + hint);
    }
}

void checkName(const std::string& name)
{
    if (name.empty())
        CV_Error(Error::StsBadArg, "an image has no name: give it one");
    if (name.find('\0') != std::string::npos)
        CV_Error(Error::StsBadArg, "the name of an image, '" + std::string(name.c_str()) +
                                           "...', has a zero byte, which ends names in COLMAP's files");
}

void writeModel(
        const std::string& folder, const std::vector<PosedImage>& images, const std::vector<Point3d>& points)
{
    checkModel(images, points);
    std::string cameras, posed, seen;
    const std::vector<Camera> known = camerasOf(images);
    std::vector<std::string> tracks(points.size());
    put(cameras, uint64_t(known.size()));
    for (size_t i = 0; i < known.size(); i++)
    {
        put(cameras, uint32_t(i + 1), modelNumber(known[i].model), uint64_t(known[i].size.width),
                uint64_t(known[i].size.height));
        for (double parameter : known[i].parameters)
            put(cameras, parameter);
    }
    put(posed, uint64_t(images.size()));
    for (size_t i = 0; i < images.size(); i++)
    {
        const PosedImage& image = images[i];
        const Quatd q = Quatd::createFromRotMat(image.cameraFromWorld.rotation());
        const Vec3d t = image.cameraFromWorld.translation();
        put(posed, uint32_t(i + 1), q.w, q.x, q.y, q.z, t[0], t[1], t[2],
                uint32_t(indexOf(image.camera, known) + 1));
        posed += image.name + '\0';
        put(posed, uint64_t(image.pixels.size()));
        for (size_t k = 0; k < image.pixels.size(); k++)
        {
            const int point = k < image.sees.size() ? image.sees[k] : -1;
            put(posed, image.pixels[k].x + .5, image.pixels[k].y + .5, int64_t(point < 0 ? -1 : point + 1));
            if (point >= 0)
                put(tracks[size_t(point)], uint32_t(i + 1), uint32_t(k));
        }
    }
    put(seen, uint64_t(points.size()));
    for (size_t i = 0; i < points.size(); i++)
    {
        put(seen, uint64_t(i + 1), points[i].x, points[i].y, points[i].z, uchar(0), uchar(0), uchar(0), -1.,
                uint64_t(tracks[i].size() / 8));
        seen += tracks[i];
    }
    // Every file is written before any is replaced: files of two runs would not fit together.
    const std::pair<const char*, const std::string*> contents[] = {
            {"cameras.bin", &cameras}, {"images.bin", &posed}, {"points3D.bin", &seen}};
    std::vector<std::unique_ptr<WholeFile>> files;
    for (const auto& [name, bytes] : contents)
    {
        files.push_back(std::make_unique<WholeFile>(folder + "/" + name));
        files.back()->write(bytes->data(), bytes->size());
        files.back()->finish();
    }
    for (const auto& file : files)
        file->commit();
}

}  // namespace cv::iib

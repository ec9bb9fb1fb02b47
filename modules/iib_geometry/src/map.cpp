// SPDX-License-Identifier: Apache-2.0

#include "map.hpp"

#include <algorithm>
#include <cstring>
#include <set>

#include <fcntl.h>
#ifdef _WIN32
#include <io.h>
#include <share.h>
#include <sys/stat.h>
#else
#include <sys/file.h>
#include <unistd.h>
#endif

#include "../../iib/src/common/checked_file.hpp"

namespace iib_localization {
namespace {

namespace fs = std::filesystem;

const char* const FILE_NAME = "/map.iib";
constexpr int LINE_BYTES = 32;  // of a code of LBD
const cv::iib::FileKind KIND = {"IIB_MAP_", 2, "a map of opencv_iib"};

//! What a folder of a map holds, and one of an earlier version; the first names tell that it is one.
const std::vector<std::string> OWN = {"map.iib", "cameras.bin", "images.bin", "points3D.bin"};
const std::vector<std::string> EARLIER = {"map.json", "codes.npy", "misses.npy", "points.npy", "sees.npy",
        "views.npy", "rigs.bin", "frames.bin"};

//! Whether a file has one of these names, or that of one which a killed process has not finished.
bool isOf(const std::vector<std::string>& names, const std::string& name)
{
    const bool unfinished = fs::path(name).extension() == ".tmp";
    return std::any_of(names.begin(), names.end(), [&](const std::string& own) {
        return name == own || (unfinished && name.compare(0, own.size() + 1, own + ".") == 0);
    });
}

void writeReal(cv::iib::CheckedWriter& file, double value)
{
    uint64 bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    file.number(bits, 8);
}

double readReal(cv::iib::CheckedReader& file)
{
    const uint64 bits = file.number(8);
    double value = 0;
    std::memcpy(&value, &bits, sizeof(value));
    if (!std::isfinite(value))
        file.fail("it has a number that is none");
    return value;
}

void writeText(cv::iib::CheckedWriter& file, const std::string& text)
{
    file.number(text.size(), 4);
    file.bytes(text.data(), text.size());
}

std::string readText(cv::iib::CheckedReader& file)
{
    const unsigned size = file.word();
    file.expect(size, 1);
    std::string text(size, ' ');
    file.bytes(&text[0], text.size());
    return text;
}

void writeCamera(cv::iib::CheckedWriter& file, const Camera& camera)
{
    writeText(file, camera.model);
    file.number(uint64(camera.size.width), 4);
    file.number(uint64(camera.size.height), 4);
    for (double parameter : camera.parameters)
        writeReal(file, parameter);
}

Camera readCamera(cv::iib::CheckedReader& file)
{
    Camera camera;
    camera.model = readText(file);
    camera.size.width = int(file.word());
    camera.size.height = int(file.word());
    if (modelNumber(camera.model) < 0)
        file.fail("it has a camera of an unknown model");
    for (size_t i = parametersOf(camera.model); i > 0; i--)
        camera.parameters.push_back(readReal(file));
    try
    {
        Lens checked(camera);
    }
    catch (const cv::Exception& e)
    {
        file.fail(e.err);
    }
    return camera;
}

void writeImage(cv::iib::CheckedWriter& file, const MapImage& image, size_t camera)
{
    writeText(file, image.name);
    file.number(camera, 4);
    for (double value : cv::Matx34d(image.cameraFromWorld.matrix.get_minor<3, 4>(0, 0)).val)
        writeReal(file, value);
    file.number(image.used, 4);
    file.number(image.added, 1);
    file.number(image.sees.size(), 4);
    for (size_t k = 0; k < image.sees.size(); k++)
    {
        file.real(float(image.pixels[k].x));
        file.real(float(image.pixels[k].y));
        file.real(image.sizes[k]);
        file.number(uint64(image.sees[k]), 4);
    }
    file.bytes(image.misses.data(), image.misses.size());
    file.bytes(image.codes.data, image.codes.total());
    const cv::Mat& picture = image.picture.pixels;
    file.number(uint64(picture.rows), 4);
    file.number(uint64(picture.cols), 4);
    file.bytes(picture.data, picture.total());
}

//! What version 2 has: which points are in use, the lines, and of each image those that it sees.
void writeExtras(cv::iib::CheckedWriter& file, const Map& map)
{
    file.number(map.orbAndAkaze, 1);
    file.number(map.lines.size(), 4);
    for (const MapLine& line : map.lines)
        for (const cv::Point3d& p : {line.begin, line.end})
            for (double value : {p.x, p.y, p.z})
                writeReal(file, value);
    for (const MapImage& image : map.images)
    {
        file.list(image.lines, 4);
        file.bytes(image.lineCodes.data, image.lineCodes.total());
    }
}

void readExtras(cv::iib::CheckedReader& file, Map& map)
{
    map.orbAndAkaze = file.number(1) != 0;
    const unsigned lines = file.word();
    file.expect(lines, 48);
    for (unsigned i = 0; i < lines; i++)
    {
        double values[6];
        for (double& value : values)
            value = readReal(file);
        map.lines.push_back({{values[0], values[1], values[2]}, {values[3], values[4], values[5]}});
    }
    for (MapImage& image : map.images)
    {
        image.lines = file.list<int>(4);
        for (int number : image.lines)
            if (number < 0 || size_t(number) >= map.lines.size())
                file.fail("an image sees a line that is not there");
        file.expect(image.lines.size(), LINE_BYTES);
        image.lineCodes.create(int(image.lines.size()), LINE_BYTES, CV_8U);
        file.bytes(image.lineCodes.data, image.lineCodes.total());
    }
}

MapImage readImage(cv::iib::CheckedReader& file, const std::vector<Camera>& cameras, int bytes, size_t points)
{
    MapImage image;
    image.name = readText(file);
    const unsigned camera = file.word();
    cv::Matx34d pose;
    for (double& value : pose.val)
        value = readReal(file);
    image.used = file.word();
    image.added = file.number(1) != 0;
    const uint64 count = file.word();
    file.expect(count, uint64(bytes) + 17);
    for (uint64 k = 0; k < count; k++)
    {
        const float x = file.real(), y = file.real();
        image.pixels.emplace_back(x, y);
        image.sizes.push_back(file.real());
        image.sees.push_back(int(file.word()));
        if (!(std::abs(x) + std::abs(y) < 1 << 20 && image.sizes.back() > 0 &&
                    image.sizes.back() < 1 << 20) ||
                image.sees.back() < 0 || size_t(image.sees.back()) >= points)
            file.fail("a keypoint sees nothing");
    }
    image.misses.resize(count);
    file.bytes(image.misses.data(), count);
    image.codes.create(int(count), bytes, CV_8U);
    file.bytes(image.codes.data, image.codes.total());
    const cv::Matx33d rotation = pose.get_minor<3, 3>(0, 0);
    if (camera >= cameras.size() || cv::norm(rotation * rotation.t() - cv::Matx33d::eye()) > 1e-6)
        file.fail("an image has no camera or no pose");
    image.camera = cameras[camera];
    const unsigned rows = file.word(), cols = file.word();
    if (std::max(rows, cols) >= 1 << 16)
        file.fail("an image is too large");
    file.expect(uint64(rows) * cols, 1);
    image.picture.pixels.create(int(rows), int(cols), CV_8U);
    file.bytes(image.picture.pixels.data, image.picture.pixels.total());
    image.picture.scale = double(cols) / image.camera.size.width;
    image.cameraFromWorld = cv::Affine3d(rotation, cv::Vec3d(pose(0, 3), pose(1, 3), pose(2, 3)));
    return image;
}

}  // namespace

int lockFolder(const fs::path& folder)
{
#ifdef _WIN32  // where no folder is locked: a file beside it, which goes when it is closed
    return ::_wsopen((folder.wstring() + L".lock").c_str(), _O_CREAT | _O_RDWR | _O_TEMPORARY | _O_NOINHERIT,
            _SH_DENYRW, _S_IREAD | _S_IWRITE);
#else
    const int lock = ::open(folder.c_str(), O_RDONLY | O_CLOEXEC);
    if (lock >= 0 && ::flock(lock, LOCK_EX | LOCK_NB) == 0)
        return lock;
    if (lock >= 0)
        ::close(lock);
    return -1;
#endif
}

std::vector<cv::Point3d> Map::seenBy(const MapImage& image) const
{
    std::vector<cv::Point3d> seen;
    for (int number : image.sees)
        seen.push_back(points[size_t(number)]);
    return seen;
}

void Map::compact()
{
    std::vector<int> numbers(points.size(), -1);
    std::vector<cv::Point3d> seen;
    for (MapImage& image : images)
    {
        MapImage kept = image;
        kept.pixels.clear();
        kept.sees.clear();
        kept.sizes.clear();
        kept.misses.clear();
        kept.codes = cv::Mat(0, image.codes.cols, CV_8U);
        for (size_t k = 0; k < image.sees.size(); k++)
        {
            if (image.sees[k] < 0)
                continue;
            int& number = numbers[size_t(image.sees[k])];
            if (number < 0)
            {
                number = int(seen.size());
                seen.push_back(points[size_t(image.sees[k])]);
            }
            kept.sees.push_back(number);
            kept.pixels.push_back(image.pixels[k]);
            kept.sizes.push_back(image.sizes[k]);
            kept.misses.push_back(image.misses[k]);
            kept.codes.push_back(image.codes.row(int(k)));
        }
        image = std::move(kept);
    }
    points = std::move(seen);
}

Map readMap(const std::string& folder)
{
    std::error_code error;
    if (!fs::is_regular_file(cv::iib::systemName(folder + FILE_NAME), error))
        CV_Error(cv::Error::StsError,
                folder + (fs::exists(cv::iib::systemName(folder + "/map.json"), error)
                                         ? " is a map of an earlier version: make it again"
                                         : " is no map: it has no map.iib"));
    cv::iib::CheckedReader file(folder + FILE_NAME, KIND);
    Map map;
    map.keypoints = int(file.word());
    map.updates = file.word();
    const int bytes = int(file.word());
    const uint64 points = file.number(8);
    file.expect(points, 24);
    for (uint64 i = 0; i < points; i++)
    {
        const double x = readReal(file), y = readReal(file);
        map.points.emplace_back(x, y, readReal(file));
    }
    std::vector<Camera> cameras;
    for (unsigned left = file.word(); left > 0; left--)
        cameras.push_back(readCamera(file));
    std::set<std::string> names;
    for (unsigned left = file.word(); left > 0; left--)
    {
        map.images.push_back(readImage(file, cameras, bytes, map.points.size()));
        if (!names.insert(map.images.back().name).second)
            file.fail("two images have one name");
    }
    if (file.version() > 1)
        readExtras(file, map);
    file.seal();
    file.expectEnd();
    if (map.keypoints < 1 || map.images.empty())
        file.fail("it has no images");
    return map;
}

MapFolder::MapFolder(const std::string& folder) : folder_(folder)
{
    std::error_code error;
    const fs::path path = cv::iib::systemName(folder);
    fs::create_directories(path, error);
    bool known = false, any = false;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
    {
        const std::string name = entry->path().filename().u8string();
        any = true;
        known = known || isOf({OWN[0], EARLIER[0]}, name);
        if (!isOf(OWN, name) && !isOf(EARLIER, name))
            CV_Error(
                    cv::Error::StsError, folder + " holds " + name + " and is no map: choose another folder");
    }
    if (error)
        CV_Error(cv::Error::StsError, folder + " cannot be written: " + error.message());
    if (any && !known)
        CV_Error(cv::Error::StsError, folder + " holds a COLMAP model and is no map: choose another folder");
    lock_ = lockFolder(path);
    if (lock_ < 0)
        CV_Error(cv::Error::StsError,
                folder + " is being written by another process: wait until it has ended");
}

MapFolder::~MapFolder() { ::close(lock_); }

void MapFolder::write(const Map& map) const
{
    cv::iib::FileKind kind = KIND;
    kind.version = map.orbAndAkaze || !map.lines.empty() ? 2 : 1;  // earlier programs read what they can
    cv::iib::CheckedWriter file(folder_ + FILE_NAME, kind);
    file.number(uint64(map.keypoints), 4);
    file.number(map.updates, 4);
    file.number(uint64(map.images.empty() ? 0 : map.images[0].codes.cols), 4);
    file.number(map.points.size(), 8);
    for (const cv::Point3d& p : map.points)
        for (double value : {p.x, p.y, p.z})
            writeReal(file, value);
    const std::vector<Camera> cameras = camerasOf(map.images);
    file.number(cameras.size(), 4);
    for (const Camera& camera : cameras)
        writeCamera(file, camera);
    file.number(map.images.size(), 4);
    for (const MapImage& image : map.images)
        writeImage(file, image, indexOf(image.camera, cameras));
    if (kind.version > 1)
        writeExtras(file, map);
    file.seal();
    cv::iib::writeModel(folder_, {map.images.begin(), map.images.end()}, map.points);
    file.commit();
    std::error_code error;
    for (fs::directory_iterator entry(cv::iib::systemName(folder_), error), end; !error && entry != end;
            entry.increment(error))
        if (std::count(OWN.begin(), OWN.end(), entry->path().filename().u8string()) == 0)
            fs::remove(entry->path(), error);  // of an earlier version or a killed process
}

}  // namespace iib_localization

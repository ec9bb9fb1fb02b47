// SPDX-License-Identifier: Apache-2.0

#include "map.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <set>

#include "opencv2/iib/detail/checked_file.hpp"

namespace cv::iib {
namespace {

namespace fs = std::filesystem;

const char* const FILE_NAME = "/map.iib";
constexpr int LINE_BYTES = 32;  // of an LBD code
const FileKind KIND = {"IIB_MAP_", 2, "a map of opencv_iib"};

//! Reads or writes the parts of a map, so that the functions below list the parts only once.
class MapFile
{
public:
    explicit MapFile(CheckedReader& file) : reader_(&file) {}
    explicit MapFile(CheckedWriter& file) : writer_(&file) {}

    template <typename T> void integer(T& value, int size)
    {
        if (reader_)
            value = T(reader_->number(size));
        else
            writer_->number(uint64(value), size);
    }

    template <typename T> void single(T& value)
    {
        if (reader_)
            value = reader_->real();
        else
            writer_->real(float(value));
    }

    void real(double& value)
    {
        uint64 bits = 0;
        std::memcpy(&bits, &value, sizeof(bits));
        integer(bits, 8);
        std::memcpy(&value, &bits, sizeof(value));
        check(std::isfinite(value), "it has a NaN or infinite number");
    }

    void point(Point3d& p)
    {
        for (double* value : {&p.x, &p.y, &p.z})
            real(*value);
    }

    //! The length of a list whose elements have at least so many bytes.
    template <typename List> void length(List& list, uint64 least, int size = 4)
    {
        uint64 count = list.size();
        integer(count, size);
        if (reader_)
            reader_->expect(count, least);
        list.resize(count);
    }

    template <typename List> void bytes(List& list)
    {
        for (auto& value : list)
            integer(value, 1);
    }

    void matrix(Mat& matrix, size_t rows, size_t cols)
    {
        if (reader_)
        {
            reader_->expect(rows, cols);
            matrix.create(int(rows), int(cols), CV_8U);
            reader_->bytes(matrix.data, matrix.total());
        }
        else
            writer_->bytes(matrix.data, matrix.total());
    }

    void check(bool valid, const std::string& why) const
    {
        if (reader_ && !valid)
            reader_->fail(why);
    }

private:
    CheckedReader* const reader_ = nullptr;
    CheckedWriter* const writer_ = nullptr;
};

void archive(MapFile& file, Camera& camera)
{
    file.length(camera.model, 1);
    file.bytes(camera.model);
    file.integer(camera.size.width, 4);
    file.integer(camera.size.height, 4);
    file.check(modelNumber(camera.model) >= 0, "it has a camera of an unknown model");
    camera.parameters.resize(parametersOf(camera.model));
    for (double& parameter : camera.parameters)
        file.real(parameter);
    try
    {
        Lens checked(camera);
    }
    catch (const Exception& e)
    {
        file.check(false, e.err);
    }
}

void archive(MapFile& file, MapImage& image, const std::vector<Camera>& cameras, size_t bytes, size_t points)
{
    file.length(image.name, 1);
    file.bytes(image.name);
    size_t number = indexOf(image.camera, cameras);
    file.integer(number, 4);
    for (int i = 0; i < 12; i++)  // three rows
        file.real(image.cameraFromWorld.matrix.val[i]);
    const Matx33d rotation = image.cameraFromWorld.rotation();
    file.check(number < cameras.size() && norm(rotation * rotation.t() - Matx33d::eye()) <= 1e-6,
            "an image has no camera or no pose");
    image.camera = cameras[number];
    file.integer(image.used, 4);
    file.integer(image.added, 1);
    file.length(image.sees, uint64(bytes) + 17);
    image.pixels.resize(image.sees.size());
    image.sizes.resize(image.sees.size());
    image.misses.resize(image.sees.size());
    for (size_t k = 0; k < image.sees.size(); k++)
    {
        Point2d& pixel = image.pixels[k];
        file.single(pixel.x);
        file.single(pixel.y);
        file.single(image.sizes[k]);
        file.integer(image.sees[k], 4);
        file.check(std::abs(pixel.x) + std::abs(pixel.y) < 1 << 20 && image.sizes[k] > 0 &&
                           image.sizes[k] < 1 << 20 && image.sees[k] >= 0 && size_t(image.sees[k]) < points,
                "a keypoint is invalid");
    }
    file.bytes(image.misses);
    file.matrix(image.codes, image.sees.size(), bytes);
    Mat& picture = image.picture.pixels;
    Size size = picture.size();
    file.integer(size.height, 4);
    file.integer(size.width, 4);
    file.check(!((unsigned(size.height) | unsigned(size.width)) >> 16), "an image is too large");
    file.matrix(picture, size_t(size.height), size_t(size.width));
    const Size& whole = image.camera.size;  // only longer sides give the scale: the shorter was rounded
    image.picture.scale = double(std::max(picture.cols, picture.rows)) / std::max(whole.width, whole.height);
}

//! @param version of the file; version 2 adds the kind of points, the lines, and the lines that each image sees.
void archive(MapFile& file, Map& map, unsigned version)
{
    unsigned bytes = map.images.empty() ? 0 : unsigned(map.images[0].codes.cols);
    file.integer(map.keypoints, 4);
    file.integer(map.updates, 4);
    file.integer(bytes, 4);
    file.length(map.points, 24, 8);
    for (Point3d& point : map.points)
        file.point(point);
    std::vector<Camera> cameras = camerasOf(map.images);
    file.length(cameras, 12);
    for (Camera& camera : cameras)
        archive(file, camera);
    file.length(map.images, 121);
    file.check(map.images.empty() || bytes > 0, "its images have no codes");
    std::set<std::string> names;
    for (MapImage& image : map.images)
    {
        archive(file, image, cameras, bytes, map.points.size());
        file.check(names.insert(image.name).second, "two images have one name");
    }
    if (version < 2)
        return;
    file.integer(map.orbAndAkaze, 1);
    file.length(map.lines, 48);
    for (MapLine& line : map.lines)
    {
        file.point(line.begin);
        file.point(line.end);
    }
    for (MapImage& image : map.images)
    {
        file.length(image.lines, 4);
        for (int& number : image.lines)
        {
            file.integer(number, 4);
            file.check(number >= 0 && size_t(number) < map.lines.size(), "an image refers to a missing line");
        }
        file.matrix(image.lineCodes, image.lines.size(), LINE_BYTES);
    }
}

}  // namespace

std::vector<Point3d> Map::seenBy(const MapImage& image) const
{
    std::vector<Point3d> seen;
    for (int number : image.sees)
        seen.push_back(points[size_t(number)]);
    return seen;
}

void Map::compact()
{
    std::vector<int> numbers(points.size(), -1);
    std::vector<Point3d> seen;
    for (MapImage& image : images)
    {
        Mat codes(0, image.codes.cols, CV_8U);
        size_t kept = 0;
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
            image.sees[kept] = number;
            image.pixels[kept] = image.pixels[k];
            image.sizes[kept] = image.sizes[k];
            image.misses[kept] = image.misses[k];
            codes.push_back(image.codes.row(int(k)));
            kept++;
        }
        image.sees.resize(kept);
        image.pixels.resize(kept);
        image.sizes.resize(kept);
        image.misses.resize(kept);
        image.codes = codes;
    }
    points = std::move(seen);
}

Map readMap(const std::string& folder)
{
    std::error_code error;
    if (!fs::is_regular_file(systemName(folder + FILE_NAME), error))
        CV_Error(Error::StsError,
                folder + (fs::exists(systemName(folder + "/map.json"), error)
                                         ? " is a map of an earlier version: make it again, in another folder"
                                         : " is no map: it has no map.iib"));
    CheckedReader file(folder + FILE_NAME, KIND);
    Map map;
    MapFile parts(file);
    archive(parts, map, file.version());
    file.seal();
    file.expectEnd();
    parts.check(map.keypoints > 0 && !map.images.empty(), "it has no images");
    return map;
}

void writeMap(const std::string& folder, Map& map, const std::function<void()>& last)
{
    FileKind kind = KIND;
    kind.version = map.orbAndAkaze || !map.lines.empty() ? 2 : 1;  // earlier programs read version 1 only
    CheckedWriter file(folder + FILE_NAME, kind);
    MapFile parts(file);
    archive(parts, map, kind.version);
    file.seal();
    file.finish();  // a full disk ends here, while nothing is replaced yet
    last();
    file.commit();
}

}  // namespace cv::iib

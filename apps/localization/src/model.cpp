// SPDX-License-Identifier: Apache-2.0

#include "model.hpp"

#include <filesystem>
#include <fstream>

#include "opencv2/core/quaternion.hpp"

namespace iib_localization {
namespace {

//! The numbers of a file, one after another, lowest byte first as on every machine that this runs on.
class Reader
{
public:
    explicit Reader(const std::string& path) : path_(path), stream_(path, std::ios::binary)
    {
        std::error_code error;
        left_ = std::filesystem::file_size(path, error);
        if (!stream_ || error)
            CV_Error(cv::Error::StsError, path + " cannot be opened");
    }

    void read(void* to, size_t size)
    {
        if (size > left_ || !stream_.read(static_cast<char*>(to), std::streamsize(size)))
            fail("is cut off");
        left_ -= size;
    }

    template <typename T> T next()
    {
        T value;
        read(&value, sizeof(value));
        return value;
    }

    //! How many things follow, each of so many bytes or more.
    size_t count(size_t size)
    {
        const uint64_t n = next<uint64_t>();
        if (n > left_ / size)
            fail("is cut off");
        return size_t(n);
    }

    std::string text()
    {
        std::string result;
        while (const char c = next<char>())
            result += c;
        return result;
    }

    void skip(size_t size)
    {
        if (size > left_ || !stream_.seekg(std::streamoff(size), std::ios::cur))
            fail("is cut off");
        left_ -= size;
    }

    void finish() const
    {
        if (left_ != 0)
            fail("is longer than what it holds");
    }

    [[noreturn]] void fail(const std::string& what) const
    {
        CV_Error(cv::Error::StsParseError, path_ + " " + what);
    }

private:
    std::string path_;
    std::ifstream stream_;
    uint64_t left_ = 0;
};

std::map<int, Camera> readCameras(Reader&& file)
{
    std::map<int, Camera> cameras;
    for (size_t n = file.count(24); n > 0; n--)
    {
        Camera& camera = cameras[int(file.next<uint32_t>())];
        const CameraModel model = cameraModel(file.next<int32_t>());
        camera.model = model.name;
        camera.size.width = int(file.next<uint64_t>());
        camera.size.height = int(file.next<uint64_t>());
        camera.parameters.resize(model.parameters);
        file.read(camera.parameters.data(), model.parameters * sizeof(double));
    }
    file.finish();
    return cameras;
}

void readPoints(Reader&& file, Model& model)
{
    for (size_t n = file.count(43); n > 0; n--)
    {
        const int64_t id = file.next<int64_t>();
        double xyz[3];
        file.read(xyz, sizeof(xyz));
        model.points[id] = {xyz[0], xyz[1], xyz[2]};
        file.skip(3 + sizeof(double));  // colour and error
        file.skip(8 * file.count(8));   // where it is seen
    }
    file.finish();
}

void readImages(Reader&& file, Model& model)
{
    for (size_t n = file.count(64); n > 0; n--)
    {
        const int id = int(file.next<uint32_t>());
        double q[4], t[3];
        file.read(q, sizeof(q));
        file.read(t, sizeof(t));
        const bool known = model.cameras.count(int(file.next<uint32_t>())) != 0;
        ModelImage image;
        image.name = file.text();
        const cv::Quatd rotation(q[0], q[1], q[2], q[3]);
        if (!known || !(std::abs(rotation.norm() - 1) < 1e-2) || !std::isfinite(t[0] + t[1] + t[2]))
            file.fail("is damaged at image " + image.name);
        image.cameraFromWorld = {rotation.toRotMat3x3(), cv::Vec3d(t)};
        image.points.resize(file.count(24));
        for (int64_t& point : image.points)
        {
            file.skip(2 * sizeof(double));  // where in the image
            point = file.next<int64_t>();
            if (point != -1 && model.points.count(point) == 0)
                file.fail("has a point that points3D.bin has not, in image " + image.name);
        }
        model.images[id] = std::move(image);
    }
    file.finish();
}

}  // namespace

Model readModel(const std::string& folder)
{
    Model model;
    model.cameras = readCameras(Reader(folder + "/cameras.bin"));
    readPoints(Reader(folder + "/points3D.bin"), model);
    readImages(Reader(folder + "/images.bin"), model);
    return model;
}

}  // namespace iib_localization

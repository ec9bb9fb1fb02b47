// SPDX-License-Identifier: Apache-2.0

#include "colmap_model.hpp"

#include <filesystem>
#include <fstream>
#include <set>

#include "lens.hpp"
#include "opencv2/core/quaternion.hpp"

namespace iib_localization {
namespace {

//! By COLMAP's numbers.
const char* const MODELS[] = {"SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV",
        "OPENCV_FISHEYE", "FULL_OPENCV", "FOV", "SIMPLE_RADIAL_FISHEYE", "RADIAL_FISHEYE",
        "THIN_PRISM_FISHEYE", "RAD_TAN_THIN_PRISM_FISHEYE", "SIMPLE_DIVISION", "DIVISION", "SIMPLE_FISHEYE",
        "FISHEYE", "EUCM", "EQUIRECTANGULAR"};
constexpr size_t PARAMETERS[] = {3, 4, 4, 5, 8, 8};  // of the first ones; Lens knows no others
constexpr size_t MAX_TRACK = 30;                     // images of a point that count as seeing the same

//! The numbers of a file, one after another, lowest byte first as on every machine that this runs on.
class Reader
{
public:
    Reader(const std::string& folder, const std::string& name)
        : name_(name), stream_(folder + "/" + name, std::ios::binary)
    {
        std::error_code error;
        left_ = std::filesystem::file_size(folder + "/" + name, error);
        expect(!error);
    }

    void expect(bool valid) const
    {
        if (!valid)
            CV_Error(cv::Error::StsParseError, name_ + " is missing or damaged");
    }

    template <typename T> T next()
    {
        T value{};
        expect(sizeof(T) <= left_ && stream_.read(reinterpret_cast<char*>(&value), sizeof(T)));
        left_ -= sizeof(T);
        return value;
    }

    double number()
    {
        const double value = next<double>();
        expect(std::isfinite(value));
        return value;
    }

    //! How many things follow, each of so many bytes or more.
    uint64_t count(uint64_t bytes)
    {
        const uint64_t things = next<uint64_t>();
        expect(things <= left_ / bytes);
        return things;
    }

    void skip(uint64_t bytes)
    {
        expect(bytes <= left_ && stream_.seekg(std::streamoff(bytes), std::ios::cur));
        left_ -= bytes;
    }

    void finish() const { expect(left_ == 0); }

private:
    const std::string name_;
    std::ifstream stream_;
    uint64_t left_ = 0;
};

std::map<uint32_t, Camera> readCameras(Reader&& file)
{
    std::map<uint32_t, Camera> cameras;
    for (uint64_t left = file.count(24); left > 0; left--)
    {
        Camera& camera = cameras[file.next<uint32_t>()];
        const uint32_t model = file.next<uint32_t>();
        const uint64_t width = file.next<uint64_t>(), height = file.next<uint64_t>();
        file.expect(model < std::size(MODELS) && std::max(width, height) < 1 << 16);
        camera = {MODELS[model], {int(width), int(height)}, {}};
        for (size_t i = 0; model < std::size(PARAMETERS) && i < PARAMETERS[model]; i++)
            camera.parameters.push_back(file.number());
        Lens checked(camera);
    }
    file.finish();
    return cameras;
}

typedef std::map<uint32_t, size_t> Numbers;  // of images, by their ids in the model

std::vector<ModelImage> readImages(Reader&& file, const std::map<uint32_t, Camera>& cameras, Numbers& numbers)
{
    std::vector<ModelImage> images;
    for (uint64_t left = file.count(73); left > 0; left--)
    {
        ModelImage image;
        numbers[file.next<uint32_t>()] = images.size();
        double pose[7];  // quaternion w x y z, translation
        for (double& value : pose)
            value = file.number();
        const cv::Quatd rotation(pose[0], pose[1], pose[2], pose[3]);
        const auto camera = cameras.find(file.next<uint32_t>());
        file.expect(camera != cameras.end() && std::abs(rotation.norm() - 1) < 1e-2);
        image.cameraFromWorld = {rotation.toRotMat3x3(), cv::Vec3d(pose + 4)};
        image.camera = camera->second;
        while (const char c = file.next<char>())
            image.name += c;
        file.skip(24 * file.count(24));  // its points: x, y, id
        images.push_back(std::move(image));
    }
    file.finish();
    file.expect(!images.empty());
    return images;
}

void countShared(Reader&& file, const Numbers& numbers, std::vector<ModelImage>& images)
{
    for (uint64_t left = file.count(51); left > 0; left--)
    {
        file.skip(43);  // id, place, colour and error
        std::set<size_t> seeing;
        for (uint64_t views = file.count(8); views > 0; views--)
        {
            const auto image = numbers.find(file.next<uint32_t>());
            file.expect(image != numbers.end());
            if (seeing.size() < MAX_TRACK)
                seeing.insert(image->second);
            file.skip(4);  // which of its points
        }
        for (size_t a : seeing)
            for (size_t b : seeing)
                images[a].shared[b] += a != b;
    }
    file.finish();
}

}  // namespace

std::vector<ModelImage> readModel(const std::string& folder)
{
    try
    {
        Numbers numbers;
        const std::map<uint32_t, Camera> cameras = readCameras({folder, "cameras.bin"});
        std::vector<ModelImage> images = readImages({folder, "images.bin"}, cameras, numbers);
        countShared({folder, "points3D.bin"}, numbers, images);
        return images;
    }
    catch (const cv::Exception& e)
    {
        CV_Error(cv::Error::StsError, folder +
                                              " is no COLMAP model in binary form (colmap model_converter "
                                              "makes one of a text model), or a "
                                              "damaged one: " +
                                              e.err);
    }
}

}  // namespace iib_localization

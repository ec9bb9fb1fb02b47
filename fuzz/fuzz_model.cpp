// SPDX-License-Identifier: Apache-2.0

// readModel on any files of a COLMAP model, binary or text. Expects a cv::Exception, or images that writeModel accepts
// and that are the same when read again.

#include "byte_source.hpp"
#include "map/colmap_model.hpp"
#include "support/temporary_file.hpp"

namespace {

using namespace cv;
using namespace cv::iib;

bool finite(const std::vector<Point2d>& points)
{
    return std::all_of(points.begin(), points.end(),
            [](const Point2d& p) { return std::isfinite(p.x) && std::isfinite(p.y); });
}

//! Equality up to rounding of quaternions, and of keypoints by the shift of half a pixel.
void checkSame(const PosedImage& again, const PosedImage& image)
{
    const Affine3d &a = again.cameraFromWorld, &b = image.cameraFromWorld;
    FUZZ_CHECK(again.name == image.name && camerasOf(std::vector<PosedImage>{again, image}).size() == 1);
    FUZZ_CHECK(a.translation() == b.translation() && norm(a.rotation() - b.rotation()) < 1e-12);
    FUZZ_CHECK(again.sees == image.sees && again.pixels.size() == image.pixels.size());
    for (size_t i = 0; i < image.pixels.size(); i++)
        FUZZ_CHECK(norm(again.pixels[i] - image.pixels[i]) <= 1e-15 * (1 + norm(image.pixels[i])));
}

void check(const std::vector<PosedImage>& images)
{
    bool known = true;
    int points = 0;
    for (const PosedImage& image : images)
    {
        const Matx33d rotation = image.cameraFromWorld.rotation();
        FUZZ_CHECK(!image.name.empty() && image.camera.size.area() > 0);
        FUZZ_CHECK(norm(rotation * rotation.t() - Matx33d::eye()) < 1e-9 && determinant(rotation) > 0);
        FUZZ_CHECK(checkRange(image.cameraFromWorld.matrix) && image.sees.size() == image.pixels.size());
        known = known && finite(image.pixels) && image.name.find('\0') == std::string::npos;
        for (int point : image.sees)
            points = std::max(points, point + 1);
    }
    static const opencv_test::TemporaryFolder copy;
    const std::vector<Point3d> places(points);
    FUZZ_CHECK(refused([&] { writeModel(copy.name, images, places); }) == !known);
    if (!known)
        return;
    const std::vector<PosedImage> again = readModel(copy.name);
    FUZZ_CHECK(again.size() == images.size());
    for (size_t i = 0; i < images.size(); i++)
        checkSame(again[i], images[i]);
}

}  // namespace

FUZZ_TARGET
{
    static const opencv_test::TemporaryFolder folders[2];  // of binary and of text files
    const bool text = in.flag();
    const std::string end = text ? ".txt" : ".bin", &folder = folders[text].name;
    opencv_test::writeFile(folder + "/cameras" + end, in.bytes(in.read<ushort>()));
    opencv_test::writeFile(folder + "/images" + end, in.bytes(in.left()));
    std::vector<PosedImage> images;
    if (!refused([&] { images = readModel(folder); }))
        check(images);
}

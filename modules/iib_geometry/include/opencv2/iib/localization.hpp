// SPDX-License-Identifier: Apache-2.0

#ifndef OPENCV_IIB_LOCALIZATION_HPP
#define OPENCV_IIB_LOCALIZATION_HPP

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/affine.hpp"

namespace cv {
namespace iib {

/** @brief A camera as COLMAP describes it.

Models: SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV and OPENCV_FISHEYE. */
struct CV_EXPORTS Camera
{
    std::string model;
    Size size;
    std::vector<double> parameters;  //!< COLMAP's, in its order; the centre of the first pixel is (0.5, 0.5)

    /** @brief From `MODEL,WIDTH,HEIGHT,PARAMETERS`, separated by commas.
    @throws cv::Exception (StsBadArg) that says what is wrong, and which models there are. */
    static Camera parse(const std::string& text);
};

//! @brief What Localizer::localize finds.
struct Location
{
    bool found = false;
    std::string reason;        //!< why there is no pose
    Affine3d cameraFromWorld;  //!< x right, y down, z forward; in the map's unit
    //! Of the camera's centre (map's unit) and of a small turn about the world's axes (radians).
    Matx66d covariance;
    int matches = 0;              //!< of keypoints with points of the map
    int inliers = 0;              //!< keypoints that agree with the pose
    std::vector<Point2d> pixels;  //!< of the matches that agree; the centre of the first pixel is (0, 0)
    std::vector<Point3d> points;  //!< of the map, that are seen there
};

/** @brief Finds images in a map that Python's `opencv-iib map` made.

The codes of an image vote for the map's images, and those that look most like it are matched with it. The pose comes from
the points of the map that they see. It needs fifteen inliers and two in a hundred matches more, and a place that is
known to a tenth of the distance to its points (three standard deviations), so that images of places that are not in the
map get none. */
class CV_EXPORTS Localizer
{
public:
    /** @brief Reads a map into memory.
    @param map its folder.
    @param points keypoints that are looked for in an image; 0: as many as in the map's images.
    @throws cv::Exception for what is no map, or a damaged one. */
    explicit Localizer(const std::string& map, int points = 1000);

    /** @brief Told by one thread at a time of each step in the making of a map: how many of all are done, and what is wrong with
    a photograph, without which the map is made (else empty). */
    typedef std::function<void(size_t done, size_t all, const std::string& problem)> Report;

    /** @brief Makes a map in memory of a COLMAP model: 2000 keypoints of each photograph are described, matched with those of
    the photographs that see the same, and triangulated with the model's poses. Where Python is, `opencv-iib map` makes it
    once, for all runs.
    @param model folder of a model in binary form, in any unit; its cameras are of the models that Camera has.
    @param photographs folder that the names of the model's images are relative to.
    @param points keypoints that are looked for in an image to be localized; 0: as many as in the photographs.
    @param report if not empty: told of the progress.
    @throws cv::Exception for a model that is damaged or not that of the photographs. */
    Localizer(const std::string& model, const std::string& photographs, int points = 1000,
            const Report& report = Report());
    ~Localizer();
    Localizer(const Localizer&) = delete;
    Localizer& operator=(const Localizer&) = delete;

    //! The cameras of the map's images, each once.
    const std::vector<Camera>& cameras() const;

    /** @brief Where an image was taken. Threads may call it at once.
    @param image 8-bit, grey or BGR, of the camera's size.
    @param camera that took it.
    @param prior camera from world, such as the last image's: only the two images of the map nearest to it are compared, and
    only points within a tenth of the longer side from where the prior has them. If that gives no pose, the image is looked for
    everywhere. Null: everywhere at once.
    @throws cv::Exception for an image of another size or type, or a camera of an unknown model. */
    Location localize(InputArray image, const Camera& camera, const Affine3d* prior = nullptr) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

}  // namespace iib
}  // namespace cv

#endif

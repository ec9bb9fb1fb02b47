// SPDX-License-Identifier: Apache-2.0

#ifndef OPENCV_IIB_LOCALIZATION_HPP
#define OPENCV_IIB_LOCALIZATION_HPP

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/affine.hpp"

namespace cv { namespace iib {

//! @addtogroup iib_geometry
//! @{

/** @brief A camera as COLMAP describes it: any of its models with a field of view under 180 degrees.

Cameras, pixels and poses refer to images as their files store them, as in COLMAP. EXIF's orientation affects only how
points are described. */
struct CV_EXPORTS Camera
{
    std::string model;  //!< COLMAP's name, such as `PINHOLE`
    Size size;
    std::vector<double> parameters;  //!< in COLMAP's order; the centre of the first pixel is (0.5, 0.5)

    /** @brief Parses `MODEL,WIDTH,HEIGHT,PARAMETERS`, separated by commas.
    @throws cv::Exception (StsBadArg) that says what is wrong, and lists the models. */
    static Camera parse(const std::string& text);

    /** @brief Projects points to pixels.
    @param points in the camera's axes: x right, y down, z forward.
    @return pixels; here and below the centre of the first pixel is (0, 0). NaN for points behind the camera, and for
    points so far off its axis that the distortion model would fold them back into the image.
    @throws cv::Exception (StsBadArg) for an unknown model, or parameters that it does not have. */
    std::vector<Point2d> project(const std::vector<Point3d>& points) const;

    /** @brief Removes distortion: the same pixels of an ideal camera with matrix(), as findRelativePose and
    cv::solvePnP need.
    @return NaN for pixels at which no point before the camera is seen.
    @throws cv::Exception as project(). */
    std::vector<Point2d> undistorted(const std::vector<Point2d>& pixels) const;

    /** @brief Focal lengths and principal point; the centre of the first pixel is (0, 0), as in OpenCV.
    @throws cv::Exception as project(). */
    Matx33d matrix() const;

    /** @brief The camera of images that were resized by cv::resize.
    @param to new size, of the same aspect ratio up to whole pixels.
    @throws cv::Exception as project(), and for an empty size or another aspect ratio. */
    Camera resized(const Size& to) const;

    /** @brief The camera of images that were rotated upright, by EXIF's orientation.
    @param orientation 1, 3, 6 or 8.
    @throws cv::Exception (StsBadArg) for another orientation: no camera sees a mirrored image. */
    Camera upright(int orientation) const;
};

//! @brief An image of a COLMAP model.
struct PosedImage
{
    std::string name;  //!< file name relative to the folder of images
    Camera camera;
    Affine3d cameraFromWorld;
    std::vector<Point2d> pixels;  //!< keypoints
    std::vector<int> sees;        //!< index of the point that each keypoint sees, or -1
};

/** @brief Writes a COLMAP model in binary form: `cameras.bin`, `images.bin` and `points3D.bin`, each atomically.
@param folder existing folder.
@param images at least one, with distinct names and rigid poses.
@param points seen by the images' keypoints.
@throws cv::Exception if a file cannot be written, and before writing for an invalid model:
- names that are equal, empty or contain a zero byte;
- poses that scale or mirror, and values that are not finite;
- cameras of more than 65535 pixels a side, and indices of missing points. */
CV_EXPORTS void writeModel(const std::string& folder, const std::vector<PosedImage>& images,
        const std::vector<Point3d>& points = std::vector<Point3d>());

//! An image as its file stores it: not rotated by EXIF's orientation.
struct Photograph
{
    Mat pixels;           //!< 8-bit, grey or BGR; empty if it cannot be read
    int orientation = 1;  //!< of EXIF: 1, 3, 6 or 8; points are described upright
    Mat mask;             //!< CV_8UC1 of the same size, 0 where no keypoints are wanted, or empty

    Photograph() = default;
    //! Implicit, so that an image alone converts to a Photograph.
    Photograph(const Mat& pixels_, int orientation_ = 1, const Mat& mask_ = Mat())
        : pixels(pixels_), orientation(orientation_), mask(mask_)
    {
    }
};

/** @brief Reads an image by its name in a model, by several threads at once. An exception ends the mapping. Example:
`cv::imread(folder + "/" + name, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION)`. */
typedef std::function<Photograph(const std::string& name)> ImageReader;

/** @brief Receives the progress of making a map, from one thread at a time: the number of finished steps, of all steps,
and the problem with an image that is left out (else empty). An exception ends the mapping. */
typedef std::function<void(size_t done, size_t all, const std::string& problem)> MappingReport;

//! @brief How a map is made.
struct MapOptions
{
    MapOptions(int keypoints = 2000) : points(keypoints) {}

    int points;  //!< keypoints to detect in each image, at least 1
    //! Whether to map lines: segments (LSD), matched by LBD and triangulated. Needs line_descriptor, of opencv_contrib.
    bool lines = false;
    //! Whether to use the paper's points (ORB and AKAZE) and default bits instead of the recommended ones.
    bool orbAndAkaze = false;
    //! Longer side, at least 32 pixels, to which larger images are reduced for detection and description; 0: never.
    int maxSize = 0;
};

/** @brief Makes a map from a COLMAP model and its images.

Keypoints of each image are described, matched with covisible images, refined (refineMatches), and triangulated. The
model's poses stay fixed. The map has 150 bytes a keypoint and a grey copy of each image, at most 1024 pixels a side.
@param model folder of a model, binary or text, in any unit and at any distance from its origin. Images that share
keypoints' point numbers are covisible; the points themselves are not read. The poses say how images are rotated, so
any rotation is fine.
@param images reads the model's images. Images that cannot be read, or do not have their camera's size, are left out.
@param map folder to write: `map.iib`, and a COLMAP model of the same points. An existing map is replaced; concurrent
readers get the old map or the new one. A folder with other files is refused before work begins.
@param options how the map is made; a number converts to options with that many keypoints.
@param report receives the progress; may be empty.
@throws cv::Exception for a damaged model, a model of other images, and for lines without line_descriptor. */
CV_EXPORTS void buildMap(const std::string& model, const ImageReader& images, const std::string& map,
        const MapOptions& options = MapOptions(), const MappingReport& report = MappingReport());

//! @brief The result of Localizer::localize.
struct Location
{
    bool found = false;
    std::string reason;        //!< why there is no pose; empty if there is one
    Affine3d cameraFromWorld;  //!< x right, y down, z forward; in the map's unit
    /** Covariance of the camera's centre (map's unit) and of a small rotation about the world's axes (radians).
    Estimated from:
    - the reprojection errors of the inliers;
    - the disagreement among parts of the image;
    - the map's own error, by leave-one-out over its images; zero if no point is seen by three images.

    The first two are multiplied by 1.5 (centre) and 2 (rotation), for errors that matches share. Errors that all images of the map share, such as a
    wrong scale, are not included. */
    Matx66d covariance;
    int matches = 0;              //!< number of keypoints matched with points of the map
    int inliers = 0;              //!< number of keypoints that agree with the pose
    std::vector<Point2d> pixels;  //!< of the inliers
    std::vector<Point3d> points;  //!< of the map, seen at these pixels
};

/** @brief Finds images in a map.

The codes of an image vote for the map's images, and the most similar ones are matched with it. The pose is estimated
from these matches. Then inliers are refined against the map's images (refineMatches), and the pose with them.

A pose is accepted if all of these hold:
- it has 15 inliers plus 2 % of the matches;
- such a pose is expected in less than one of a thousand sets of random matches, as in findRelativePose;
- three standard deviations of its position are below a tenth of the scene's distance;
- without a prior, the mirror image does not agree better with the map.

An image without a pose, and without a prior, is then matched in views with the five most similar images of the map (as
matchViews, without tilts). This finds images at any rotation, and from up to four times nearer or farther. It takes 5
to 10 times as long as an upright image, and 20 to 50 times if the image is not found. */
class CV_EXPORTS Localizer
{
public:
    /** @brief Reads a map into memory.
    @param map its folder.
    @param points keypoints to detect in an image; 0: as many as in the map's images.
    @param lines whether to refine poses by lines too, of a map that was made with lines.
    @throws cv::Exception for negative points, a folder without a map, a damaged map or one with codes of another
    version, and for lines if the map or OpenCV has none. */
    explicit Localizer(const std::string& map, int points = 1000, bool lines = false);

    /** @brief Makes a map in memory.
    @param model, images, report, options as in buildMap; with options.lines, poses are refined by lines.
    @param points keypoints to detect in an image; 0: as many as in the map's images.
    @throws cv::Exception for negative points, and as buildMap. */
    Localizer(const std::string& model, const ImageReader& images, int points = 1000,
            const MappingReport& report = MappingReport(), const MapOptions& options = MapOptions());
    ~Localizer();
    Localizer(const Localizer&) = delete;
    Localizer& operator=(const Localizer&) = delete;

    //! The distinct cameras of the map's images.
    const std::vector<Camera>& cameras() const;

    /** @brief Estimates where an image was taken. Thread-safe.
    @param image 8-bit, grey or BGR, of the camera's size.
    @param camera that took the image.
    @param prior camera from world, such as the previous pose. Then only the two nearest images of the map are matched,
    and only points within a tenth of the longer side of their predicted pixels. If this fails, or prior is null, the
    whole map is searched.
    @param orientation, mask as in Photograph.
    @throws cv::Exception for an image or mask of another size or type, another orientation, and for a camera as
    Camera::project. */
    Location localize(InputArray image, const Camera& camera, const Affine3d* prior = nullptr,
            int orientation = 1, InputArray mask = noArray()) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

//! @brief A reading of an inertial measurement unit (IMU), in its axes.
struct ImuReading
{
    int64 nanoseconds;
    Vec3d rate;   //!< angular rate, rad/s
    Vec3d force;  //!< specific force, m/s^2: acceleration minus gravity
};

/** @brief Smooths the poses of a camera's images by the readings of an IMU that moves with it.

A Kalman filter runs forwards and a smoother backwards @cite RauchTungStriebel1965. The first poses initialize gravity
and the IMU's biases. An image without a pose gets one up to three seconds after an image with a pose.

Images keep their own poses:
- where the readings have a gap, or too few images have poses;
- where readings contradict images, such as by four outliers in a row;
- everywhere, if most images are contradicted, or fewer than twenty agreed before: check axes, units and clock.

Images are weighted by their covariances, reduced where poses scatter less about a smooth path: wide covariances must
not hide wrong readings. Small errors are not noticed, such as a few degrees in imuFromCamera, or any error of a camera
that hardly rotates.
@param times of the images, nanoseconds, rising.
@param images results of Localizer::localize, in a map in metres. Smoothing sets `found`, `reason` and
`cameraFromWorld`. An image with a pose keeps its covariance. One without gets that of the last pose plus the
smoother's, since images of a map share errors that readings do not show. Both are upper bounds.
@param readings in the order of their times, on the images' clock.
@param imuFromCamera the camera's pose in the IMU's axes (EuRoC's `T_BS`).
@return empty, or a sentence: readings contradict images, with the number of poses that stay; or a covariance is
invalid, such as zero, and all poses stay.
@throws cv::Exception for different numbers of times and images, times that do not rise, readings that are not finite,
and an imuFromCamera that is not rigid. */
CV_EXPORTS std::string smoothPoses(const std::vector<int64>& times, std::vector<Location>& images,
        const std::vector<ImuReading>& readings, const Affine3d& imuFromCamera = Affine3d());

/** @brief Adds images under changed illumination to a map.

The images are localized. An image is added if the map has none like it: no image at its place has more than half of its
codes among the inliers. Its points are matched with the map and with other added images, and triangulated.

The map stays bounded. Codes that eight updates in a row expected and did not find are dropped. One place keeps the
eight added images that were matched most recently. The model's own images stay. */
class CV_EXPORTS MapUpdate
{
public:
    /** @brief Reads a map, and locks the folder to write until the object is destroyed.
    @param map its folder. @param out folder of the new map, as in buildMap; empty: the old map's folder.
    @throws cv::Exception for a folder without a map, or one that another process is changing. */
    explicit MapUpdate(const std::string& map, const std::string& out = std::string());
    ~MapUpdate();
    MapUpdate(const MapUpdate&) = delete;
    MapUpdate& operator=(const MapUpdate&) = delete;

    //! The distinct cameras of the map's images.
    const std::vector<Camera>& cameras() const;

    /** @brief Localizes an image and keeps its features (about 0.6 MB) until commit(). Thread-safe.
    @param name of the image in the map, distinct within this update.
    @param image, camera, orientation, mask as in Localizer::localize; the map stores the image upright.
    @throws cv::Exception for a name that is empty, contains a zero byte or was used in this update, after commit(), and
    as Localizer::localize; the image may then be given again. */
    Location add(const std::string& name, InputArray image, const Camera& camera, int orientation = 1,
            InputArray mask = noArray());

    //! @brief The changes made by commit().
    struct Counts
    {
        int localized = 0;  //!< images localized
        int added = 0;      //!< images added to the map
        int dropped = 0;    //!< codes removed from the map
    };
    /** @brief Writes the map, once; further images need another MapUpdate.
    @throws cv::Exception if writing fails (the old map stays, and commit() may be called again), or after a commit. */
    Counts commit();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

//! @}

}}  // namespace cv::iib

#endif

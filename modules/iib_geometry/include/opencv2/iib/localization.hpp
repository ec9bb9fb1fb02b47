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

//! @addtogroup iib_geometry
//! @{

/** @brief A camera as COLMAP describes it: any of its models with a field of view under 180 degrees.

Cameras, pixels and poses are those of images as their files store them, as COLMAP has them; EXIF's orientation only tells how points are
described. */
struct CV_EXPORTS Camera
{
    std::string model;  //!< COLMAP's name of it, such as `PINHOLE`
    Size size;
    std::vector<double> parameters;  //!< COLMAP's, in its order; the centre of the first pixel is (0.5, 0.5)

    /** @brief From `MODEL,WIDTH,HEIGHT,PARAMETERS`, separated by commas.
    @throws cv::Exception (StsBadArg) that says what is wrong, and which models there are. */
    static Camera parse(const std::string& text);

    /** @brief Where points are seen.
    @param points in the camera's axes: x right, y down, z forward.
    @return pixels; here and below the centre of the first pixel is (0, 0). NaN for points that are not before the camera, and for
    those so far from its axis that the model would have them back in the image.
    @throws cv::Exception (StsBadArg) for a camera with an unknown model, or parameters that the model does not have. */
    std::vector<Point2d> project(const std::vector<Point3d>& points) const;

    /** @brief Where a camera without distortion, of the matrix that matrix() tells, would see what this one sees at pixels: what
    findRelativePose, cv::solvePnP and others that know no lens take.
    @return NaN for pixels at which no point before the camera is seen.
    @throws cv::Exception as project(). */
    std::vector<Point2d> undistorted(const std::vector<Point2d>& pixels) const;

    /** @brief Focal lengths and centre; the centre of the first pixel is (0, 0), as OpenCV has it.
    @throws cv::Exception as project(). */
    Matx33d matrix() const;

    /** @brief The camera of images that were resized as cv::resize does.
    @param to of the same shape, but for what whole pixels take.
    @throws cv::Exception as project(), and for a size of another shape or without pixels. */
    Camera resized(const Size& to) const;

    /** @brief The camera of images that were turned upright, as EXIF's orientation asks.
    @param orientation 1, 3, 6 or 8.
    @throws cv::Exception (StsBadArg) for another orientation: no camera sees a mirrored image. */
    Camera upright(int orientation) const;
};

//! @brief An image of a COLMAP model.
struct PosedImage
{
    std::string name;  //!< its file, below the folder of the images
    Camera camera;
    Affine3d cameraFromWorld;
    std::vector<Point2d> pixels;  //!< of its keypoints
    std::vector<int> sees;        //!< of each keypoint, the index of the point that it sees, or -1
};

/** @brief Writes a COLMAP model in binary form: `cameras.bin`, `images.bin` and `points3D.bin`, each whole or not at all.
@param folder that is there.
@param images one or more, with distinct names and poses of a rotation and a translation.
@param points that their keypoints see.
@throws cv::Exception for what cannot be written and, before anything is, for what no program would read: names that are equal, empty or
have a zero byte, poses that scale or mirror, numbers that are not finite, cameras of more than 65535 pixels a side, and keypoints
that see a point which is not there. */
CV_EXPORTS void writeModel(const std::string& folder, const std::vector<PosedImage>& images,
        const std::vector<Point3d>& points = std::vector<Point3d>());

//! An image as its file stores it: pixels, cameras and poses are those of the file.
struct Photograph
{
    Mat pixels;           //!< 8-bit, grey or BGR; empty for one that cannot be read
    int orientation = 1;  //!< by EXIF, 1, 3, 6 or 8: points are described upright
    Mat mask;             //!< CV_8UC1 of the same size, 0 where no points are to be found, or empty

    Photograph() = default;
    //! From an image alone too.
    Photograph(const Mat& pixels_, int orientation_ = 1, const Mat& mask_ = Mat())
        : pixels(pixels_), orientation(orientation_), mask(mask_)
    {
    }
};

/** @brief Gives an image by its name in a model, such as
`cv::imread(folder + "/" + name, cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION)`. Threads
call it at once. What it throws ends the mapping. */
typedef std::function<Photograph(const std::string& name)> ImageReader;

/** @brief Told by one thread at a time of each step in the making of a map: how many of all are done, and what is wrong with
an image, without which the map is made (else empty). What it throws ends the mapping. */
typedef std::function<void(size_t done, size_t all, const std::string& problem)> MappingReport;

//! @brief What a map is made of.
struct MapOptions
{
    MapOptions(int keypoints = 2000) : points(keypoints) {}

    int points;  //!< keypoints that are looked for in an image, 1 or more
    /** Straight edges too: segments (LSD) of two images or more that look alike (LBD) and whose planes cross. They need OpenCV's
    module line_descriptor, of opencv_contrib. */
    bool lines = false;
    //! The paper's points, ORB's and AKAZE's together with IIB's default bits, in place of IIBDescriptorExtractor::createRecommended.
    bool orbAndAkaze = false;
    //! Larger images are reduced to so many pixels of the longer side, 32 or more, to find and describe points; 0: they are not. What
    //! is kept in the map for refinement has 1024 at most in any case.
    int maxSize = 0;
};

/** @brief Makes a map of a COLMAP model and its images.

Keypoints of each image are described, matched with those of the images that see the same, refined against one of them
(refineMatches), and triangulated with the model's poses, which stay as they are. The map holds 150 bytes a keypoint, and of each
image its grey pixels, reduced to 1024 on the longer side: 0.3 MB for 640 x 480.
@param model folder of a model, binary or text, in any unit and at any distance from its origin. Its points are not read: the
images' keypoints tell which of them see the same. Photographs that were rotated by any angle are described as upright ones, by their poses.
@param images gives the model's images. Those that cannot be read or are of another size than their camera are left out.
@param map folder to write: `map.iib`, and a COLMAP model of the same points. A map that is there is replaced: who reads
meanwhile gets the old one or the new one. A folder that holds anything else is refused before work begins.
@param options what it is made of; a number stands for one of keypoints alone.
@param report if not empty: told of the progress.
@throws cv::Exception for a model that is damaged or not that of the images, and for lines without line_descriptor. */
CV_EXPORTS void buildMap(const std::string& model, const ImageReader& images, const std::string& map,
        const MapOptions& options = MapOptions(), const MappingReport& report = MappingReport());

//! @brief What Localizer::localize finds.
struct Location
{
    bool found = false;
    std::string reason;        //!< why there is no pose
    Affine3d cameraFromWorld;  //!< x right, y down, z forward; in the map's unit
    /** Of the camera's centre (map's unit) and of a small turn about the world's axes (radians). Estimated from how far the matches
    that agree are from where the pose has their points, from how much parts of the image disagree, and from the map's own error,
    poses and calibration of its images: how far from where the map has them its images come to lie, if the others alone place
    what they see. What all images of the map share, such as a scale or a shift of the model, is not in it, nor is it where no point
    is seen by three images. */
    Matx66d covariance;
    int matches = 0;              //!< of keypoints with points of the map
    int inliers = 0;              //!< keypoints that agree with the pose
    std::vector<Point2d> pixels;  //!< of the matches that agree
    std::vector<Point3d> points;  //!< of the map, that are seen there
};

/** @brief Finds images in a map.

The codes of an image vote for the map's images, and those that look most like it are matched with it. The pose comes from
the points of the map that they see; the matches that agree with it are refined against the map's images (refineMatches), and
the pose with them. A pose needs fifteen inliers and two in a hundred matches more, the significance that findRelativePose asks for, and a
position that is known to a tenth of the distance to its points (three standard deviations). So images of other places get none.

An image that has no pose after that, and no prior, is matched in views with the five images of the map that look most like it at any
rotation (as matchViews, without tilts): so images rotated by any angle and seen from up to four times nearer or farther are found. That takes 5 to
10 times as long as an upright image, and 20 times if the image is not found. */
class CV_EXPORTS Localizer
{
public:
    /** @brief Reads a map into memory.
    @param map its folder.
    @param points keypoints that are looked for in an image; 0: as many as in the map's images.
    @param lines whether poses are refined by lines too: by the distances of the ends of a line's projection from the segment
    that shows it, of a map that was made with them.
    @throws cv::Exception for less than 0 points, a folder without a map, a damaged one or one of another version's codes, and for lines
    of a map without them or without line_descriptor. */
    explicit Localizer(const std::string& map, int points = 1000, bool lines = false);

    /** @brief Makes a map in memory.
    @param model, images, report, options as buildMap takes them; with options.lines, lines refine poses.
    @param points keypoints that are looked for in an image; 0: as many as in the map's images.
    @throws cv::Exception for less than 0 points, and as buildMap. */
    Localizer(const std::string& model, const ImageReader& images, int points = 1000,
            const MappingReport& report = MappingReport(), const MapOptions& options = MapOptions());
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
    @param orientation, mask as of Photograph.
    @throws cv::Exception for an image or a mask of another size or type, another orientation, and a camera of an unknown model or with
    parameters that the model does not have. */
    Location localize(InputArray image, const Camera& camera, const Affine3d* prior = nullptr,
            int orientation = 1, InputArray mask = noArray()) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

//! @brief What an inertial measurement unit (IMU) tells, in its axes.
struct ImuReading
{
    int64 nanoseconds;
    Vec3d rate;   //!< radians a second
    Vec3d force;  //!< m/s^2: acceleration without gravity's
};

/** @brief Smooths the poses of a camera's images by the readings of an IMU that moves with it.

A Kalman filter forwards and a smoother backwards @cite RauchTungStriebel1965; gravity's direction and the IMU's biases are
found from the first poses. Images without a pose get one too, if they come after one with a pose, by three seconds at most. Where
the readings have a gap, or contradict the images (which are farther from where the readings have them than is usual, summed over
images: four surprises in a row are enough), the images' own poses stay; if most images are contradicted, or fewer than twenty had
agreed before, all do: the IMU's axes, its units, its clock or imuFromCamera are other ones. An image counts as its covariance
tells, and more where images scatter about a smooth path by less than they tell: wide covariances do not make wrong readings
likely. What is wrong by little, such as imuFromCamera by a few degrees, or hardly shows, since the camera hardly turns, is not
noticed.
@param times of the images, nanoseconds, rising.
@param images what Localizer::localize found of each, in a map in metres. Of those that get a pose `found`, `reason` and
`cameraFromWorld` are set. The covariance of an image that had a pose stays that of the image alone. One that had none gets
that of the last image with a pose before it, since what the map's images have in common no readings tell, and the smoother's on
top. Both are upper bounds.
@param readings in the order of their times, on the images' clock.
@param imuFromCamera where the camera is in the IMU's axes (EuRoC's `T_BS`).
@return a sentence if readings contradict images, with how many poses stay as they are (also of images that too few readings or poses
are around), or if an image has a covariance that is none, such as zeros, when all do; else empty.
@throws cv::Exception for other numbers of times and images, times that do not rise, readings that are not finite, and an
imuFromCamera that is not a turn and a shift. */
CV_EXPORTS std::string smoothPoses(const std::vector<int64>& times, std::vector<Location>& images,
        const std::vector<ImuReading>& readings, const Affine3d& imuFromCamera = Affine3d());

/** @brief Adds to a map what images see in their light.

The images are localized; those in a light that the map does not know (none of its images at that place has more than half of
its codes among the inliers) become a part of it: their points are matched with the map's and each other's and triangulated.
Codes that eight updates in a row looked for and did not find are dropped, and of more than eight added images at one place
the one that has not helped for longest, so that a map of a place does not grow for ever. The model's own images stay. */
class CV_EXPORTS MapUpdate
{
public:
    /** @brief Reads a map; until the object goes, no other process can change what will be written.
    @param map its folder. @param out folder of the new map, as buildMap takes it; empty: that of the old one.
    @throws cv::Exception for a folder without a map, or one that another process is changing. */
    explicit MapUpdate(const std::string& map, const std::string& out = std::string());
    ~MapUpdate();
    MapUpdate(const MapUpdate&) = delete;
    MapUpdate& operator=(const MapUpdate&) = delete;

    //! The cameras of the map's images, each once.
    const std::vector<Camera>& cameras() const;

    /** @brief Localizes an image and keeps what it sees (about 0.6 MB) until commit(). Threads may call it at once.
    @param name of the image in the map, distinct among those of this update.
    @param image, camera, orientation, mask as Localizer::localize takes them; what becomes a part of the map is upright.
    @throws cv::Exception for a name that is empty, has a zero byte or is one of this update already, after commit(), and as
    Localizer::localize; the image may be given again then. */
    Location add(const std::string& name, InputArray image, const Camera& camera, int orientation = 1,
            InputArray mask = noArray());

    //! @brief What commit() did.
    struct Counts
    {
        int localized = 0;  //!< images
        int added = 0;      //!< images, which are a part of the map now
        int dropped = 0;    //!< codes that nobody finds any more
    };
    /** @brief Writes the map, once: what comes next takes another MapUpdate.
    @throws cv::Exception if it cannot be written, when the old one stays and it may be called again, and if it was written. */
    Counts commit();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

//! @}

}  // namespace iib
}  // namespace cv

#endif

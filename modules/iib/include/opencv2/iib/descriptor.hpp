// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_HPP
#define OPENCV_IIB_DESCRIPTOR_HPP

#include "opencv2/iib/features.hpp"

namespace cv { namespace iib {

//! @addtogroup iib
//! @{

/** @brief Illumination-insensitive binary (IIB) descriptor @cite Lin2023IIB.

Each keypoint has a region of support (ROS): a square with centre KeyPoint::pt and side `scaleFactor * KeyPoint::size`, in
pixels. Level g = 1..G (the granularity) divides it into a grid of 2^g x 2^g cells, whose edges are rounded to whole
pixels. Four sibling cells make a *quad*. In each image channel, a mapping turns their four means into bits. Changed
illumination changes the means, but seldom their order among neighbours.

A ROS side under 2^G pixels is raised to 2^G, so that no cell is empty. #Border defines the treatment of a ROS that leaves the
image. If a cell has no pixel, its quad gets the bits of four equal means.

Levels come coarse first, in whole bytes: the descriptor of granularity G-1 is a prefix of the one of G, unless the side of the
ROS is raised. The module's doc/format.md defines every bit.

The descriptors are CV_8U and compared with NORM_HAMMING. The same input gives the same bits for
every instruction set, thread count and build. One object may serve several threads as long as none
changes its parameters or calls cv::setNumThreads.

**Files** store the parameters and the detector.
- Algorithm::save checks for errors and keeps the old file if the disk is full; Feature2D::write(filename) does neither.
- Algorithm::load and Feature2D::read take both kinds of file.
- On Windows save takes names in UTF-8 too, but load only those in the code page; loadFromString reads the content of any file.
- ORB, HessianDetector and NormalizedDetector are restored with their parameters.
- Other detector classes: call setDetector before read, which calls the detector's own read(). Another class in the file throws.
 */
class CV_EXPORTS_W IIBDescriptorExtractor : public Feature2D
{
public:
    //! Image channels (paper, "Choice of Image Data Channels"), to be or-ed.
    enum Channel
    {
        CHANNEL_GRAD_X = 1,          //!< |gx|, horizontal gradient magnitude, Sobel 3x3
        CHANNEL_GRAD_Y = 2,          //!< |gy|, vertical gradient magnitude
        CHANNEL_ORIENTATION = 4,     //!< gradient orientation atan2(-gy, gx), 0 to 360 degrees in 1024 steps
        CHANNEL_INTENSITY = 8,       //!< grey value
        CHANNEL_SIGNED_GRAD_X = 16,  //!< gx (not in the paper)
        CHANNEL_SIGNED_GRAD_Y = 32,  //!< gy (not in the paper)
        CHANNELS_DEFAULT = 15        //!< the paper's four
    };

    //! From the four cell means x of a quad to bits (paper, "Binary Bit Formulation").
    enum Mapping
    {
        MAPPING_MEAN,  //!< 4 bits: x_i > mean(x), equation (1)
        MAPPING_MAX,   //!< 4 bits: x_i = max(x)
        MAPPING_MIN,   //!< 4 bits: x_i = min(x)
        MAPPING_QUARTILE,  //!< 8 bits: the quarter of [min(x), max(x)] that x_i is in, equation (2); high bit first
        MAPPING_SORT,      //!< 8 bits: the rank of x_i, ties by cell index; high bit first
        MAPPING_HAAR,      //!< 3 bits: left > right, top > bottom, main diagonal > other diagonal
        MAPPING_PAIRWISE,  //!< 4 bits: x_0 > x_1, x_1 > x_3, x_3 > x_2, x_2 > x_0, around the quad
        MAPPING_BOXES  //!< boxes on overlapping grids instead of cells, see doc/format.md; granularity 1 to 5
    };

    //! Treatment of keypoints whose ROS leaves the image.
    enum Border
    {
        BORDER_CLAMP,  //!< kept; only pixels of the image count (for a rotated ROS, border pixels are repeated)
        BORDER_DROP,    //!< removed; a rotated ROS counts as rotated, for #ORIENTATION_GRADIENT by any angle
        BORDER_REFLECT  //!< kept; the channels are reflected once at the image's border (BORDER_REFLECT_101)
    };

    //! How ROS and gradients are rotated.
    enum Orientation
    {
        ORIENTATION_NONE,      //!< not at all: best for upright cameras
        ORIENTATION_KEYPOINT,  //!< by KeyPoint::angle, in degrees, clockwise in the image; negative: upright
        ORIENTATION_GRADIENT   //!< by the prevailing direction of gradients in the ROS, see setOrientation
    };

    /** @brief Creates an extractor.

    @param scaleFactor side of the ROS in units of KeyPoint::size, > 0; see scaleFactorFor.
    @param granularity number of levels G, 1 to 6; with #MAPPING_BOXES to 5.
    @param channels a sum of #Channel values; may be 0 if there are extra channels.
    @param mapping one of #Mapping.
    @param overlap slide the 2x2 window of cells by one cell instead of two: (2^g - 1)^2 quads a level.
    @param useOrientation calls setOrientation(#ORIENTATION_KEYPOINT).
    @param extraChannels number of maps for computeWithChannels, 0 to 16.
    @throws cv::Exception (StsBadArg or StsOutOfRange) for a value outside these ranges.
     */
    CV_WRAP static Ptr<IIBDescriptorExtractor> create(float scaleFactor = 2.f, int granularity = 4,
            int channels = IIBDescriptorExtractor::CHANNELS_DEFAULT,
            int mapping = IIBDescriptorExtractor::MAPPING_MEAN, bool overlap = false,
            bool useOrientation = false, int extraChannels = 0);

    //! Learned descriptors for createPreset; doc/guide.md compares them on scenes that were not used for training.
    enum Preset
    {
        PRESET_S128,       //!< 16 bytes of the default's bits (paper, "Reduction of the IIB Descriptor Size")
        PRESET_S256,       //!< 32 bytes of the default's bits
        PRESET_S512,       //!< 64 bytes of the default's bits
        PRESET_ACCURATE,   //!< 170 bytes, a ROS 1.25 times as wide, all quads
        PRESET_COMPACT,    //!< 64 bytes, a ROS 1.25 times as wide
        PRESET_TINY,       //!< 32 bytes, a ROS 1.25 times as wide
        PRESET_BALANCED,   //!< 64 bytes, for cameras that move, a ROS 1.125 times as wide
        PRESET_VIEWPOINT,  //!< 64 bytes of #MAPPING_BOXES, for cameras that move far, a ROS 1.25 times as wide
        PRESET_UNIVERSAL,  //!< 128 bytes of #MAPPING_BOXES, for light and viewpoint, a ROS 1.25 times as wide
        PRESET_SMALL       //!< 32 bytes of #MAPPING_BOXES, for light and viewpoint, a ROS 1.25 times as wide
    };

    /** @brief Creates an extractor with a learned selection.

    tools/training learned the selections, on images that are not used for the guide's figures. getScaleFactor returns
    `scaleFactor` times the preset's own factor, see #Preset.

    @param preset one of #Preset.
    @param scaleFactor as in create, see scaleFactorFor. The default is for ORB, the default detector; keypoints of other
    detectors need another factor. createFor sets detector and factor together, createRecommended chooses both.
    @throws cv::Exception (StsBadArg) for an unknown preset, (StsOutOfRange) for a scale factor that is not
    positive.
     */
    CV_WRAP static Ptr<IIBDescriptorExtractor> createPreset(int preset, float scaleFactor = 2.f);

    /** @brief Creates an extractor for a detector: sets the scale factor, and calls setDetector.

    @param detector one that scaleFactorFor knows, also within NormalizedDetector.
    @param preset one of #Preset, or -1 for the paper's default descriptor. Try #PRESET_UNIVERSAL first: it is nearly as
    robust to illumination as the default, and much more robust to viewpoint, with 128 bytes, but slower.
    @throws cv::Exception (StsBadArg) for an unknown detector or preset, (StsNullPtr) for no detector. For an unknown
    detector call create(scaleFactor) with the ROS side divided by KeyPoint::size, and setDetector.
     */
    CV_WRAP static Ptr<IIBDescriptorExtractor> createFor(const Ptr<Feature2D>& detector, int preset = -1);

    /** @brief Creates the recommended extractor for changed illumination and view: HessianDetector and #PRESET_UNIVERSAL.

    Match its descriptors with HierarchicalMatcher::createRecommended().

    @param maxFeatures number of keypoints, the strongest; 0 keeps all. 2000 give more accurate poses than 1000.
    @throws cv::Exception (StsOutOfRange) for a negative number.
     */
    CV_WRAP static Ptr<IIBDescriptorExtractor> createRecommended(int maxFeatures = 1000);

    /** @brief Scale factor for a detector's keypoints (paper, "Experiments Combined with Feature Detectors").

    @param detectorName as in OpenCV's class names, any case, with or without "Feature2D.": AKAZE 12, ORB 2,
    BRISK 4, SIFT 20, KAZE 20, SURF 4, FAST and AGAST 64/7, GFTT 64/3, MSER 2, SimpleBlob 4.
    @throws cv::Exception (StsBadArg) with the known names for any other.
     */
    CV_WRAP static float scaleFactorFor(const String& detectorName);
    /** @overload
    For NormalizedDetector, the factor of the detector inside. For AffineFeature, pass the name of its detector.
    @throws cv::Exception (StsBadArg) for an unknown detector, (StsNullPtr) for none. */
    CV_WRAP static float scaleFactorFor(const Ptr<Feature2D>& detector);
    /** @overload
    Without it, a literal would fit both overloads above. */
    static float scaleFactorFor(const char* detectorName);

    //! Bytes of each level, coarse first, without levels that have no bit. Their sum is descriptorSize().
    CV_WRAP virtual std::vector<int> levelSizes() const = 0;

    using Feature2D::compute;
    /** @brief Describes keypoints with the image and with further channels, such as depth or labels.

    @param image 8U, 16U or 32F with 1, 3 (BGR) or 4 (BGRA) channels. Float values are quantized to 65535
    steps between the image's minimum and maximum.
    @param extraChannels getExtraChannels() single-channel maps of the image's size, 8U, 16U or 32F; in C++ a single one
    needs no list. A cell's value is the mean of the map.
    @param keypoints their order is kept; only #BORDER_DROP removes any.
    @param descriptors keypoints.size() x descriptorSize(), CV_8U; empty if the image or the keypoints are. It may be the
    matrix of the image or of a map.
    @throws cv::Exception for a wrong type, size or number of maps, for pixels that are NaN or infinite, and for
    keypoints with a NaN or infinite coordinate, a size that is not positive, or, with #ORIENTATION_KEYPOINT, a NaN or
    infinite angle.
     */
    CV_WRAP_AS(computeWithChannels)
    virtual void compute(InputArray image, InputArrayOfArrays extraChannels,
            CV_OUT CV_IN_OUT std::vector<KeyPoint>& keypoints, OutputArray descriptors) = 0;

    //! Setters have the ranges of create(). If they throw, the old value stays.
    CV_WRAP virtual void setScaleFactor(float scaleFactor) = 0;
    CV_WRAP virtual float getScaleFactor() const = 0;

    //! Changes of granularity, channels, overlap, mapping or the number of extra channels remove the selection.
    CV_WRAP virtual void setGranularity(int granularity) = 0;
    CV_WRAP virtual int getGranularity() const = 0;

    CV_WRAP virtual void setChannels(int channels) = 0;
    CV_WRAP virtual int getChannels() const = 0;

    CV_WRAP virtual void setMapping(int mapping) = 0;
    CV_WRAP virtual int getMapping() const = 0;

    CV_WRAP virtual void setOverlap(bool overlap) = 0;
    CV_WRAP virtual bool getOverlap() const = 0;

    //! setOrientation(useOrientation ? #ORIENTATION_KEYPOINT : #ORIENTATION_NONE).
    CV_WRAP virtual void setUseOrientation(bool useOrientation) = 0;
    //! getOrientation() != #ORIENTATION_NONE.
    CV_WRAP virtual bool getUseOrientation() const = 0;

    /** @brief Sets how ROS and gradients are rotated: one of #Orientation, #ORIENTATION_NONE by default.

    Estimated angles change with the illumination, so rotation loses matches. For upright cameras, none is best. For
    rotated cameras, use one angle for all keypoints: matchRotated estimates it; or set KeyPoint::angle to the direction of
    gravity (from an IMU), and use #ORIENTATION_KEYPOINT.

    #ORIENTATION_GRADIENT ignores KeyPoint::angle. The angle is the peak of a smoothed histogram of gradient directions
    between 32 x 32 cells of the ROS, weighted by magnitude and by a Gaussian of half the radius. Of several keypoints with
    the same position and size (as SIFT finds them), the second gets the second highest peak, and so on. A descriptor of
    extra channels alone stays upright.

    Except with #MAPPING_BOXES, a rotated ROS is sampled at the nearest pixels of a rotated grid: 32 x 32 points if its side
    is at most 64 pixels and the granularity at most 5, else 64 x 64. So angle 0 does not give the bits of angle -1, which
    uses all pixels. Points outside the image are reflected, or with #BORDER_CLAMP take the nearest pixel of the border. A
    side of more than 16384 pixels is reduced to that. */
    CV_WRAP virtual void setOrientation(int mode) = 0;
    CV_WRAP virtual int getOrientation() const = 0;

    CV_WRAP virtual void setExtraChannels(int extraChannels) = 0;
    CV_WRAP virtual int getExtraChannels() const = 0;

    //! One of #Border; BORDER_REFLECT by default.
    CV_WRAP virtual void setBorder(int border) = 0;
    CV_WRAP virtual int getBorder() const = 0;

    //! Sets the detector of detect and detectAndCompute, ORB by default, but not the scale factor. Detectors of other
    //! libraries get 16U and 32F as 8-bit grey, stretched from the image's minimum to its maximum. Masks are CV_8UC1 of the
    //! image's size, or empty. Throws if it is null or contains this extractor.
    CV_WRAP virtual void setDetector(const Ptr<Feature2D>& detector) = 0;
    CV_WRAP virtual Ptr<Feature2D> getDetector() const = 0;

    /** @brief Restricts the descriptor to chosen quads (paper, "Reduction of the IIB Descriptor Size").

    @param quads CV_32S with 5 columns and a row for each quad, which occurs once; empty: all quads or boxes.
    - level g, 1..G, not descending;
    - channel: its place among the channels in use, extra channels last;
    - row and column of the quad's top left cell, 0..2^g - 2, also odd; with #MAPPING_BOXES those of a box, 0..n - 1;
    - mask of the mapping's bits to keep; bit 0 is the first.
    @throws cv::Exception for another type or shape, levels out of order or values out of range.
     */
    CV_WRAP virtual void setSelection(InputArray quads) = 0;
    //! The argument of setSelection; empty if there is no selection.
    CV_WRAP virtual Mat getSelection() const = 0;
};

typedef IIBDescriptorExtractor IIB;  //!< the paper's name

//! @}

}}  // namespace cv::iib

#endif

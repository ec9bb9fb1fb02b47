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

Each keypoint has a region of support (ROS): a square with centre KeyPoint::pt and side
`scaleFactor * KeyPoint::size`, in pixels. Level g = 1..G (the granularity) cuts it into a grid of
2^g x 2^g cells, whose edges are the real positions rounded to whole pixels. Four sibling cells make
a *quad*, and a mapping turns their four mean values into bits, in each image channel. Light changes
the values, but seldom the order among neighbours.

A ROS side under 2^G pixels is raised to 2^G, so that no cell is empty. #Border says what becomes of a ROS that leaves
the image. If a cell has no pixel at all, its quad gets the bits of four equal means.

Levels come coarse first, in whole bytes: the descriptor of granularity G-1 is a prefix of the one of G, unless the ROS is so
small that G raises it. The order of bits within a level, #MAPPING_BOXES and what becomes of pixels are in the module's
doc/format.md, bit by bit.

The descriptors are CV_8U and compared with NORM_HAMMING. The same input gives the same bits for
every instruction set, thread count and build. One object may serve several threads as long as none
changes its parameters. As everywhere in OpenCV, cv::setNumThreads is not to be called meanwhile.

**Files.** Algorithm::save and Feature2D::write store the parameters and the detector. save fails where the disk is
full, and leaves the old file; write(filename) is OpenCV's own, which does not check what it writes. Algorithm::load and
Feature2D::read take either kind of file, but on Windows, where save takes names in UTF-8 as well, only by names of the
code page: loadFromString takes what a file of another name holds. ORB, HessianDetector and NormalizedDetector come back with their parameters. A
detector of any other class must be set by setDetector before read: files hold its name and what its own write() tells,
which its read() gets; read throws a cv::Exception if the detector that is set is of another class.
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

    //! What becomes of a keypoint whose ROS leaves the image. Inside, all give the same bits.
    enum Border
    {
        BORDER_CLAMP,  //!< it stays; only pixels of the image count (of a rotated ROS, those of the border repeat)
        BORDER_DROP,  //!< it is removed, as Feature2D::compute documents; a rotated ROS counts as rotated, by
                      //!< #ORIENTATION_GRADIENT at any angle
        BORDER_REFLECT  //!< it stays; the channels are reflected once at the image's border (BORDER_REFLECT_101)
    };

    //! How ROS and gradients are rotated.
    enum Orientation
    {
        ORIENTATION_NONE,  //!< not at all: the best where cameras stay upright
        ORIENTATION_KEYPOINT,  //!< by KeyPoint::angle, in degrees, clockwise in the image; a negative one means upright
        ORIENTATION_GRADIENT  //!< by the direction that prevails among the gradients in the ROS, see setOrientation
    };

    /** @brief Creates an extractor.

    @param scaleFactor side of the ROS in units of KeyPoint::size, > 0; see scaleFactorFor.
    @param granularity number of levels G, 1 to 6; with #MAPPING_BOXES to 5.
    @param channels a sum of #Channel values; may be 0 if there are extra channels.
    @param mapping one of #Mapping.
    @param overlap slide the 2x2 window of cells by one cell instead of two: (2^g - 1)^2 quads a level.
    @param useOrientation whether setOrientation(#ORIENTATION_KEYPOINT) is called at once.
    @param extraChannels number of channels of the image's size that computeWithChannels is given, 0 to 16.
    @throws cv::Exception (StsBadArg or StsOutOfRange) for a value outside these ranges.
     */
    CV_WRAP static Ptr<IIBDescriptorExtractor> create(float scaleFactor = 2.f, int granularity = 4,
            int channels = IIBDescriptorExtractor::CHANNELS_DEFAULT,
            int mapping = IIBDescriptorExtractor::MAPPING_MEAN, bool overlap = false,
            bool useOrientation = false, int extraChannels = 0);

    //! Learned descriptors for createPreset; doc/guide.md has what each finds in scenes that it was not trained on.
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
        PRESET_SMALL  //!< 32 bytes of #MAPPING_BOXES, for the same where 256 bits are wanted, a ROS 1.25 times as wide
    };

    /** @brief Creates an extractor with a selection that comes with the library.

    The selections were learned by tools/training on images of still cameras, those of PRESET_BALANCED,
    PRESET_VIEWPOINT, PRESET_UNIVERSAL and PRESET_SMALL on warped ones; the last two also on rendered walks, and half of
    their points are those that HessianDetector finds in each image. No image of the guide's figures was among them. The
    ROS of some is wider than `scaleFactor` says (see #Preset); getScaleFactor tells it.

    @param preset one of #Preset.
    @param scaleFactor as in create: what a detector's keypoints need, see scaleFactorFor. The default is that of ORB,
    which detects for a new extractor: with keypoints of another detector it finds far fewer matches. createFor sets
    detector and factor together, createRecommended chooses both.
    @throws cv::Exception (StsBadArg) for an unknown preset, (StsOutOfRange) for a scale factor that is not
    positive.
     */
    CV_WRAP static Ptr<IIBDescriptorExtractor> createPreset(int preset, float scaleFactor = 2.f);

    /** @brief Creates an extractor for a detector's keypoints: with its scale factor, and itself behind detect and
    detectAndCompute.

    @param detector one that scaleFactorFor knows, also within NormalizedDetector.
    @param preset one of #Preset, or -1 for the paper's default descriptor (as create). Take #PRESET_UNIVERSAL first: it
    stands changed light nearly as well and moved cameras much better, in 128 bytes, but takes more time. At the points
    of HessianDetector it also has more right matches than #PRESET_ACCURATE where cameras stand still, at a lower
    precision.
    @throws cv::Exception (StsBadArg) for an unknown detector or preset, (StsNullPtr) for no detector. For a detector
    that is not known use create(scaleFactor), with the side of the ROS by KeyPoint::size as its factor, and
    setDetector.
     */
    CV_WRAP static Ptr<IIBDescriptorExtractor> createFor(const Ptr<Feature2D>& detector, int preset = -1);

    /** @brief Creates what to take first, where light, place or both change: HessianDetector and #PRESET_UNIVERSAL.

    detectAndCompute() finds and describes; match the codes with HierarchicalMatcher::createRecommended(). Photographs
    of many megapixels are searched at a reduced size, see HessianDetector::setWorkingSize.

    @param maxFeatures keypoints of an image, the strongest; 0 keeps all. 2000 give a little more accurate poses than
    1000.
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
    Looks into NormalizedDetector for its detector. AffineFeature does not tell its own: take the name of that one.
    @throws cv::Exception (StsBadArg) for a detector that is not known, (StsNullPtr) for none. */
    CV_WRAP static float scaleFactorFor(const Ptr<Feature2D>& detector);
    /** @overload
    A literal would fit both of the above, since Ptr converts from any pointer. */
    static float scaleFactorFor(const char* detectorName);

    //! Bytes of each level, coarse first; levels without a bit (by a selection) are left out.
    //! Their sum is descriptorSize().
    CV_WRAP virtual std::vector<int> levelSizes() const = 0;

    using Feature2D::compute;
    /** @brief Describes keypoints with the image and with further channels, such as depth or labels.

    @param image 8U, 16U or 32F with 1, 3 (BGR) or 4 (BGRA) channels. Float values are cut into 65535
    steps between the image's own minimum and maximum.
    @param extraChannels as many single-channel maps as getExtraChannels(), each of the image's size, 8U,
    16U or 32F; in C++ a single one needs no list. A cell's value is the mean of the map.
    @param keypoints their order is kept; none is removed but by #BORDER_DROP.
    @param descriptors keypoints.size() x descriptorSize(), CV_8U. Empty if the image or the keypoints are: after an
    image that is empty ask whether imread found the file. It may be the matrix of the image or of a map.
    @throws cv::Exception for a wrong type, size or number of maps, for pixels that are NaN or infinite, and for
    keypoints with a NaN or infinite coordinate, a size that is not positive, or with #ORIENTATION_KEYPOINT such an
    angle: such a keypoint has no region, and to leave it out would break the correspondence of keypoints and rows that
    the caller counts on.
     */
    CV_WRAP_AS(computeWithChannels)
    virtual void compute(InputArray image, InputArrayOfArrays extraChannels,
            CV_OUT CV_IN_OUT std::vector<KeyPoint>& keypoints, OutputArray descriptors) = 0;

    //! Setters take what create() takes, and throw a cv::Exception where it does; the old value then stays.
    CV_WRAP virtual void setScaleFactor(float scaleFactor) = 0;
    CV_WRAP virtual float getScaleFactor() const = 0;

    //! Changing granularity, channels, overlap or mapping, or the number of extra channels, ends a selection.
    CV_WRAP virtual void setGranularity(int granularity) = 0;
    CV_WRAP virtual int getGranularity() const = 0;

    CV_WRAP virtual void setChannels(int channels) = 0;
    CV_WRAP virtual int getChannels() const = 0;

    CV_WRAP virtual void setMapping(int mapping) = 0;
    CV_WRAP virtual int getMapping() const = 0;

    CV_WRAP virtual void setOverlap(bool overlap) = 0;
    CV_WRAP virtual bool getOverlap() const = 0;

    //! setOrientation of #ORIENTATION_KEYPOINT (true) or #ORIENTATION_NONE, for programs that know only these two.
    CV_WRAP virtual void setUseOrientation(bool useOrientation) = 0;
    //! Whether there is any orientation but #ORIENTATION_NONE.
    CV_WRAP virtual bool getUseOrientation() const = 0;

    /** @brief Sets how ROS and gradients are rotated: one of #Orientation, #ORIENTATION_NONE by default.

    Rotation costs matches by changed light, since the angles change with the light as well. So where cameras stay
    upright, none is best. Where they turn, the best angles are those that do not come from single keypoints:
    matchRotated finds one angle between two images; or set KeyPoint::angle to the direction of gravity (from an IMU),
    and use #ORIENTATION_KEYPOINT.

    #ORIENTATION_GRADIENT ignores KeyPoint::angle and leaves it as it is. The angle is the peak of a smoothed histogram
    of the directions of gradients in the circle within the ROS, weighted by their magnitudes and by a Gaussian of half
    the radius; gradients between 32 x 32 cells of the ROS, each the mean of four points. Of keypoints with the same
    position and size (as SIFT finds them, one for each direction) the second gets the second highest peak, and so on.
    A descriptor of extra channels alone stays upright.

    Sums over upright rectangles do not rotate with a ROS, so but for #MAPPING_BOXES a rotated one is sampled: on a grid
    of 32 x 32 points if its side is at most 64 pixels and granularity at most 5, else of 64 x 64, at the nearest pixel
    of each, where the gradient is rotated. So angle 0 does not give the bits of angle -1: one counts samples, the other
    all pixels.
    A point outside the image takes the pixel that #BORDER_REFLECT reflects there, or with #BORDER_CLAMP the nearest
    pixel of the border: the edge of the image crosses rotated cells at an angle, and cells with different numbers of
    samples would no longer be comparable without a division. A side of more than 16384 pixels is cut to that. */
    CV_WRAP virtual void setOrientation(int mode) = 0;
    CV_WRAP virtual int getOrientation() const = 0;

    CV_WRAP virtual void setExtraChannels(int extraChannels) = 0;
    CV_WRAP virtual int getExtraChannels() const = 0;

    //! One of #Border; BORDER_REFLECT by default.
    CV_WRAP virtual void setBorder(int border) = 0;
    CV_WRAP virtual int getBorder() const = 0;

    //! The detector behind detect and detectAndCompute; ORB by default. It does not change the scale factor. One of
    //! another library gets images of 16U and 32F as 8-bit grey, from the image's own minimum to its maximum. Masks are
    //! CV_8UC1 of the image's size, or empty. Throws if it is null, or is this extractor, also within other extractors
    //! and NormalizedDetector.
    CV_WRAP virtual void setDetector(const Ptr<Feature2D>& detector) = 0;
    CV_WRAP virtual Ptr<Feature2D> getDetector() const = 0;

    /** @brief Restricts the descriptor to chosen quads (paper, "Reduction of the IIB Descriptor Size").

    @param quads CV_32S, a row a quad, each at most once: level g (1..G, not descending), channel (its place among the
    channels in use, extra channels last), row and column of the quad's top left cell in the level's grid (0..2^g - 2;
    odd positions, between siblings, are allowed and need no `overlap`), and a bit mask of the mapping's bits to keep
    (bit 0 is the first). With #MAPPING_BOXES row and column are those of a box, 0..n - 1. Empty: all quads or boxes
    again.
    @throws cv::Exception for another type or shape, levels out of order or values out of range.
     */
    CV_WRAP virtual void setSelection(InputArray quads) = 0;
    //! The chosen quads, as setSelection takes them; empty if there is no selection.
    CV_WRAP virtual Mat getSelection() const = 0;
};

typedef IIBDescriptorExtractor IIB;  //!< the paper's name

//! @}

}}  // namespace cv::iib

#endif

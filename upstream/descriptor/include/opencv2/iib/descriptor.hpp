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

Each keypoint has a region of support: an upright square with centre KeyPoint::pt and side
`scaleFactor * KeyPoint::size`, in pixels. Level g = 1..G (the granularity) cuts it into a grid of
2^g x 2^g cells. Four sibling cells make a *quad*, and a mapping turns their four mean values into
bits, in each image channel. Light changes the values, but seldom the order among neighbours.

A side under 2^G pixels is raised to 2^G, so that no cell is empty. Where a region leaves the image, it
sees the image's reflection (BORDER_REFLECT_101, once).

The descriptors are CV_8U and compared with NORM_HAMMING. Levels come coarse first, in whole bytes: the
descriptor of granularity G-1 is a prefix of the one of G, unless the region is so small that G raises
it. Within a level the order is, outermost first: the offset of the 2x2 windows (with `overlap`), the row
of quads, the bit of the mapping, the column of quads, the channel. The same input gives the same bits
on every machine.
 */
class CV_EXPORTS_W IIBDescriptorExtractor : public Feature2D
{
public:
    //! Image channels (paper, "Choice of Image Data Channels"), to be or-ed.
    enum Channel
    {
        CHANNEL_GRAD_X = 1,       //!< |gx|, horizontal gradient magnitude, Sobel 3x3
        CHANNEL_GRAD_Y = 2,       //!< |gy|, vertical gradient magnitude
        CHANNEL_ORIENTATION = 4,  //!< gradient orientation atan2(-gy, gx), 0 to 360 degrees in 1024 steps
        CHANNEL_INTENSITY = 8,    //!< grey value
        CHANNELS_DEFAULT = 15     //!< all four
    };

    //! From the four cell means x of a quad to bits (paper, "Binary Bit Formulation").
    enum Mapping
    {
        MAPPING_MEAN,      //!< 4 bits: x_i > mean(x), equation (1)
        MAPPING_MAX,       //!< 4 bits: x_i = max(x)
        MAPPING_MIN,       //!< 4 bits: x_i = min(x)
        MAPPING_QUARTILE,  //!< 8 bits: the quarter of [min(x), max(x)] that x_i is in, equation (2)
        MAPPING_SORT       //!< 8 bits: the rank of x_i, ties by cell index
    };

    /** @brief Creates an extractor.

    @param scaleFactor side of the region of support in units of KeyPoint::size, > 0. The paper takes 2 for
    ORB, 4 for BRISK and SURF, 12 for AKAZE, 20 for SIFT and KAZE, 64/7 for FAST and AGAST.
    @param granularity number of levels G, 1 to 6.
    @param channels a sum of #Channel values.
    @param mapping one of #Mapping.
    @param overlap slide the 2x2 window of cells by one cell instead of two: (2^g - 1)^2 quads a level.
    @throws cv::Exception (StsBadArg or StsOutOfRange) for a value outside these ranges.
     */
    CV_WRAP static Ptr<IIBDescriptorExtractor> create(float scaleFactor = 2.f, int granularity = 4,
            int channels = IIBDescriptorExtractor::CHANNELS_DEFAULT,
            int mapping = IIBDescriptorExtractor::MAPPING_MEAN, bool overlap = false);

    /** @brief Describes keypoints.

    @param image 8-bit with 1, 3 (BGR) or 4 (BGRA) channels.
    @param keypoints their order is kept, and none is removed.
    @param descriptors keypoints.size() x descriptorSize(), CV_8U; empty if the image or the keypoints are.
    @throws cv::Exception for another type of image, for keypoints whose coordinates are not finite or whose
    size is not positive, and for regions of support of more than 2^22 pixels.
     */
    void compute(InputArray image, std::vector<KeyPoint>& keypoints, OutputArray descriptors) CV_OVERRIDE = 0;
    using Feature2D::compute;

    //! Bytes of each level, coarse first. Their sum is descriptorSize().
    CV_WRAP virtual std::vector<int> levelSizes() const = 0;

    //! Setters take what create() takes, and throw a cv::Exception where it does; the old value then stays.
    CV_WRAP virtual void setScaleFactor(float scaleFactor) = 0;
    CV_WRAP virtual float getScaleFactor() const = 0;

    CV_WRAP virtual void setGranularity(int granularity) = 0;
    CV_WRAP virtual int getGranularity() const = 0;

    CV_WRAP virtual void setChannels(int channels) = 0;
    CV_WRAP virtual int getChannels() const = 0;

    CV_WRAP virtual void setMapping(int mapping) = 0;
    CV_WRAP virtual int getMapping() const = 0;

    CV_WRAP virtual void setOverlap(bool overlap) = 0;
    CV_WRAP virtual bool getOverlap() const = 0;
};

typedef IIBDescriptorExtractor IIB;  //!< the paper's name

//! @}

}}  // namespace cv::iib

#endif

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "opencv2/features2d.hpp"

namespace iib_tools {

const float SEED_RADIUS = 32;  //!< pixels; half the side of the ROS of fixed points

const char TEXTURE[] = "texture";  //!< a map that is computed from the image: local binary patterns

//! A descriptor with its parameters, under the name that result files carry.
struct Configuration
{
    std::string name;
    std::function<cv::Ptr<cv::Feature2D>()> create;
    float seedSize;     //!< KeyPoint::size for a ROS of radius SEED_RADIUS
    std::string seeds;  //!< detector of the seed points: "FAST"; AKAZE and KAZE need their own
    std::vector<std::string> extraNames;  //!< maps that it uses besides the image
    bool oriented;                        //!< whether keypoints get an angle (robustness only)
};

//! All tables of the paper on IIB: channels, mappings, overlap, granularity, extra channels; and the presets.
std::vector<Configuration> iibConfigurations();

std::vector<Configuration> presetConfigurations();

//! The presets for detected points: those of more than 60 bytes for any illumination or view.
std::vector<Configuration> generalPresets();

//! The other descriptors that this OpenCV has, with the parameters OpenCV recommends, upright.
std::vector<Configuration> baselineConfigurations();

//! Default IIB, upright and oriented, the presets, and for comparison ORB, SIFT, BEBLID, TEBLID and LATCH.
std::vector<Configuration> robustnessConfigurations();

//! An IIB extractor read from a file of IIBDescriptorExtractor::save, and named by the file.
Configuration savedConfiguration(const std::string& file);

//! Bytes of a descriptor.
int descriptorBytes(const cv::Feature2D& feature);

}  // namespace iib_tools

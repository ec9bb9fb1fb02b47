// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "recipe.hpp"

namespace iib_tools {

std::vector<Recipe> presetRecipes()
{
    using cv::iib::IIB;
    const int gradients = IIB::CHANNEL_GRAD_X + IIB::CHANNEL_GRAD_Y + IIB::CHANNEL_SIGNED_GRAD_X +
                          IIB::CHANNEL_SIGNED_GRAD_Y;
    const int values = IIB::CHANNEL_GRAD_X + IIB::CHANNEL_GRAD_Y + IIB::CHANNEL_INTENSITY;
    const PoolParameters paper = {IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, 4, 1.f, false, false};
    // a wider ROS pays while the camera stands still
    const PoolParameters still = {gradients, IIB::MAPPING_HAAR, 4, 1.5f, true, false};
    const PoolParameters moving = {values, IIB::MAPPING_HAAR, 4, 1.f, true, false};
    return {
        {{"S128", "S256", "S512"}, {128, 256, 512}, paper, 0., false, 12},
        {{"TINY", "COMPACT", "ACCURATE"}, {256, 512, 1360}, still, 0., false, 12},
        {{"BALANCED"}, {512}, moving, 0.7, false, 12},
    };
}

std::vector<std::string> presetNames()
{
    return {"S128", "S256", "S512", "ACCURATE", "COMPACT", "TINY", "BALANCED"};
}

}  // namespace iib_tools

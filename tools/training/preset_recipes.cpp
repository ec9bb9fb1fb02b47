// SPDX-License-Identifier: Apache-2.0

#include "recipe.hpp"

namespace iib_tools {

std::vector<Recipe> presetRecipes()
{
    using cv::iib::IIB;
    const int gradients = IIB::CHANNEL_GRAD_X + IIB::CHANNEL_GRAD_Y + IIB::CHANNEL_SIGNED_GRAD_X +
                          IIB::CHANNEL_SIGNED_GRAD_Y;
    const int values = IIB::CHANNEL_GRAD_X + IIB::CHANNEL_GRAD_Y + IIB::CHANNEL_INTENSITY;
    // Quads were learned before BORDER_REFLECT became the default; their bits must not change.
    const int zeros = IIB::BORDER_CLAMP;
    // the default's quads without the orientation channel, which is seldom worth its time
    const PoolParameters paper = {values, IIB::MAPPING_MEAN, 4, 1.f, {1}, zeros};
    // a wider ROS helps for static cameras; at 1.25 the sums of its cells still fit 16 bits
    const PoolParameters still = {gradients, IIB::MAPPING_HAAR, 4, 1.25f, {1}, zeros};
    PoolParameters accurate = still;
    accurate.mapping = IIB::MAPPING_PAIRWISE;
    // coarse quads tolerate a moved camera, so level 2 has them at every cell; a fourth channel costs almost no time
    const PoolParameters moving = {
            values + IIB::CHANNEL_SIGNED_GRAD_Y, IIB::MAPPING_MEAN, 4, 1.125f, {1, 15, 1}, zeros};
    // boxes overlap, so that no box of a moved camera loses all of its pixels; see README.md
    const PoolParameters boxes = {values + IIB::CHANNEL_SIGNED_GRAD_X + IIB::CHANNEL_SIGNED_GRAD_Y,
            IIB::MAPPING_BOXES, 5, 1.25f, {}, IIB::BORDER_REFLECT};
    const Warps none = {};
    const auto wide = [](double share) { return Warps{share, 0.5, 22, 0.7, 1.43, 2.5, 0.1, 1.5, 5}; };
    return {
            {"S128", 128, paper, none, 12, 0, false},
            {"S256", 256, paper, none, 12, 0, false},
            {"S512", 512, paper, none, 12, 0, false},
            {"ACCURATE", 0, accurate, none, 12, 0, false},
            {"COMPACT", 512, still, none, 12, 0, false},
            {"TINY", 256, still, none, 12, 0, false},
            {"BALANCED", 512, moving, {0.85, 0.4, 20, 0.7, 1.4, 2, 0, 1, 0}, 24, 0, false},
            {"VIEWPOINT", 512, boxes, wide(0.9), 24, 0, false},
            {"UNIVERSAL", 1024, boxes, wide(0.4), 16, 0.5, false},
            {"SMALL", 256, boxes, wide(0.67), 16, 0.6, false},
    };
}

Recipe paperRecipe()
{
    using cv::iib::IIB;
    return {"AdaBoost", 512, {IIB::CHANNELS_DEFAULT, IIB::MAPPING_MEAN, 4, 1.f, {1}, IIB::BORDER_CLAMP},
            Warps(), 12, 0, true};
}

}  // namespace iib_tools

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "select.hpp"

namespace iib_tools {

//! All that decides a selection but the images and the seed.
struct Recipe
{
    std::string name;
    int bits;  //!< 0: all quads at even positions, there is nothing to learn
    PoolParameters pool;
    Warps warps;
    int pairsPerScene;
    double detected;  //!< share of the pairs whose points are detected, see describeForTraining
    bool adaboost;    //!< choose whole quads by AdaBoost, as in the paper, instead of bits one by one
};

//! How the built-in presets are made, in the order of IIBDescriptorExtractor::Preset.
std::vector<Recipe> presetRecipes();

//! The paper's own: AdaBoost over the quads of all four channels.
Recipe paperRecipe();

//! Trains on all pairs given. Progress counts the pairs described, then the candidates chosen.
cv::Ptr<cv::iib::IIBDescriptorExtractor> train(
        const Recipe& recipe, const TrainingSet& images, uint64 seed, const Progress& progress);

struct NamedExtractor
{
    std::string name;
    cv::Ptr<cv::iib::IIBDescriptorExtractor> extractor;
};

//! The C++ header of the built-in presets; the command, the images' scenes and the seed go into its head.
std::string presetsHeader(const std::vector<NamedExtractor>& presets, const std::string& command,
        const TrainingSet& images, uint64 seed);

}  // namespace iib_tools

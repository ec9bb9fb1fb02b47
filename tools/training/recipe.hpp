// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "select.hpp"

namespace iib_tools {

//! The parameters of learning a selection, besides the images and the seed.
struct Recipe
{
    std::string name;
    int bits;  //!< 0: all quads at even positions, without learning
    PoolParameters pool;
    Warps warps;
    int pairsPerScene;
    double detected;  //!< share of pairs with detected points, see describeForTraining
    bool adaboost;    //!< whether to choose whole quads by AdaBoost, as in the paper, instead of single bits
};

//! The recipes of the built-in presets, in the order of IIBDescriptorExtractor::Preset.
std::vector<Recipe> presetRecipes();

//! The paper's recipe: AdaBoost over the quads of all four channels.
Recipe paperRecipe();

//! Trains on all given pairs. Progress counts described pairs, then chosen candidates.
cv::Ptr<cv::iib::IIBDescriptorExtractor> train(
        const Recipe& recipe, const TrainingSet& images, uint64 seed, const Progress& progress);

struct NamedExtractor
{
    std::string name;
    cv::Ptr<cv::iib::IIBDescriptorExtractor> extractor;
};

//! The C++ header of the built-in presets; its first comment records the command, the scenes and the seed.
std::string presetsHeader(const std::vector<NamedExtractor>& presets, const std::string& command,
        const TrainingSet& images, uint64 seed);

}  // namespace iib_tools

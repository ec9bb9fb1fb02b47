// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/metrics.hpp"
#include "select.hpp"

namespace iib_tools {

//! All that decides a selection but the images and the seed.
struct Recipe
{
    std::string name;
    int bits;  //!< 0: all quads at even positions, there is nothing to learn
    PoolParameters pool;
    Warps warps;
    bool adaBoost;  //!< selectByAdaBoost instead of selectGreedily
    int pairsPerScene;
    double detected;  //!< share of the pairs whose points are detected, see describeForTraining
};

//! None, or as for BALANCED but for the share.
Warps warpsOfShare(double share);

//! How the built-in presets are made, in the order of IIBDescriptorExtractor::Preset.
std::vector<Recipe> presetRecipes();
//! Trains on all pairs given. Progress counts the pairs described, then the candidates chosen.
cv::Ptr<cv::iib::IIBDescriptorExtractor> train(
        const Recipe& recipe, const TrainingSet& images, uint64 seed, const Progress& progress);

//! mAP and mAR at fixed points, means over the pairs.
MeanScores judge(const std::vector<ImagePair>& pairs, const cv::Ptr<cv::Feature2D>& extractor,
        const Progress& progress);

//! The same of pairs made as for training, all of them warped.
MeanScores judgeWarped(const std::vector<ImagePair>& pairs, const cv::Ptr<cv::Feature2D>& extractor,
        const Warps& warps, uint64 seed, const Progress& progress);

//! The pairs whose scene is (or, if `inside` is false, is not) number fold, fold + folds, ... in order.
std::vector<ImagePair> foldOf(const std::vector<ImagePair>& pairs, int fold, int folds, bool inside);

struct NamedExtractor
{
    std::string name;
    cv::Ptr<cv::iib::IIBDescriptorExtractor> extractor;
};

//! The C++ header of the built-in presets; the command, the images' scenes and the seed go into its head.
std::string presetsHeader(const std::vector<NamedExtractor>& presets, const std::string& command,
        const TrainingSet& images, uint64 seed);

}  // namespace iib_tools

// SPDX-License-Identifier: Apache-2.0

#include "described_images.hpp"

namespace iib_tools {

DescribedImages::Result DescribedImages::get(
        const Detector& detector, const cv::Mat& image, const std::string& file)
{
    const Key key(detector.name, file);
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto found = known_.find(key);
        if (found != known_.end())
            return found->second;
    }
    const Result result = std::make_shared<std::vector<Described>>(describeAll(detector, image, file));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (known_.emplace(key, result).second)
        order_.push_back(key);
    if (order_.size() > most_)
    {
        known_.erase(order_.front());
        order_.pop_front();
    }
    return result;
}

}  // namespace iib_tools

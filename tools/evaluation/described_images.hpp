// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>

#include "detectors.hpp"

namespace iib_tools {

/** What describeAll gave for images that occur in several pairs; describing takes most of an experiment's time. Keeps
the last ones only. Safe to use from several threads. */
class DescribedImages
{
public:
    typedef std::shared_ptr<const std::vector<Described>> Result;

    //! Keeps so many images of one detector each, of about a megabyte.
    explicit DescribedImages(size_t most = 200) : most_(most) {}

    //! Of the image of a file; an image that is changed before needs another name. Two threads that ask for the same at once may both compute it.
    Result get(const Detector& detector, const cv::Mat& image, const std::string& file)
    {
        const Key key(detector.name, file);
        std::unique_lock<std::mutex> lock(mutex_);
        if (known_.count(key))
            return known_[key];
        lock.unlock();
        const Result result = std::make_shared<std::vector<Described>>(describeAll(detector, image, file));
        lock.lock();
        if (known_.emplace(key, result).second)
            order_.push_back(key);
        if (order_.size() > most_)
        {
            known_.erase(order_.front());
            order_.pop_front();
        }
        return result;
    }

private:
    typedef std::pair<std::string, std::string> Key;  // detector, file

    size_t most_;
    std::map<Key, Result> known_;
    std::deque<Key> order_;  // oldest first
    std::mutex mutex_;
};

}  // namespace iib_tools

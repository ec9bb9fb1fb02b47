// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DESCRIPTOR_DETECTION_CALL_HPP
#define OPENCV_IIB_DESCRIPTOR_DETECTION_CALL_HPP

#include "../precomp.hpp"

namespace cv {
namespace iib {

/** @brief A call of an extractor to its detector, one of those that this thread is in.

A detector can lead back to its extractor on ways that setDetector() cannot see, such as through AffineFeature. Such calls
would go on until the stack is full, so their number has a limit. It is not 1: a thread that waits for the end of a parallel
loop may be given another image for the same extractor meanwhile.
 */
class DetectionCall
{
public:
    enum
    {
        MAX_NESTED = 8
    };

    //! Throws if this thread is already in MAX_NESTED calls of this extractor to its detector.
    explicit DetectionCall(const Feature2D* extractor_) : extractor(extractor_), outer(innermost())
    {
        int nested = 0;
        for (const DetectionCall* call = outer; call; call = call->outer)
            nested += call->extractor == extractor;
        if (nested == MAX_NESTED)
            CV_Error(Error::StsBadArg, "the extractor's detector leads back to the extractor; give "
                                       "setDetector() one that finds keypoints, such as ORB");
        innermost() = this;
    }
    ~DetectionCall() { innermost() = outer; }

    DetectionCall(const DetectionCall&) = delete;
    DetectionCall& operator=(const DetectionCall&) = delete;

private:
    static const DetectionCall*& innermost()
    {
        static thread_local const DetectionCall* call = 0;
        return call;
    }

    const Feature2D* const extractor;
    const DetectionCall* const outer;
};

}  // namespace iib
}  // namespace cv

#endif

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "test_precomp.hpp"

namespace opencv_test {

const float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN(),
            ENDLESS = std::numeric_limits<float>::infinity();

//! Expects a cv::Exception with this code and a text that names the culprit.
template <typename Call> void expectError(int code, const String& culprit, const Call& call)
{
    try
    {
        call();
        ADD_FAILURE() << "no exception about " << culprit;
    }
    catch (const cv::Exception& e)
    {
        EXPECT_EQ(code, e.code) << e.what();
        EXPECT_NE(String::npos, e.err.find(culprit)) << "\"" << culprit << "\" is not in: " << e.err;
    }
}

//! A text with one piece replaced by another.
inline String replaced(String text, const String& from, const String& to)
{
    const size_t at = text.find(from);
    CV_Assert(at != String::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace opencv_test

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_COMMON_FILE_NUMBERS_HPP
#define OPENCV_IIB_COMMON_FILE_NUMBERS_HPP

#include "../precomp.hpp"

namespace cv {
namespace iib {

//! What a node is, for errors.
inline String describeNode(const FileNode& node)
{
    if (node.empty())
        return "nothing";
    if (node.isInt() || node.isReal())
        return format("%.17g", (double)node);
    if (node.isString())
        return "\"" + (String)node + "\"";
    return node.isSeq() ? "a sequence" : "a map";
}

//! Whether a number of a file is one of this type.
inline bool holds(double number, double) { return std::abs(number) <= DBL_MAX; }
inline bool holds(double number, float) { return std::abs(number) <= FLT_MAX; }
inline bool holds(double number, int) { return number == std::floor(number) && std::abs(number) <= INT_MAX; }
inline bool holds(double number, bool) { return number == 0 || number == 1; }

inline const char* expected(double) { return "a number"; }
inline const char* expected(float) { return "a number"; }
inline const char* expected(int) { return "a whole number"; }
inline const char* expected(bool) { return "0 or 1"; }

//! Reads a number that must be of the value's type, else throws StsParseError. One that is missing keeps its value.
template <typename T> void readNumber(const FileNode& node, const char* name, T& value)
{
    const FileNode number = node[name];
    if (number.empty())
        return;
    if (!(number.isInt() || number.isReal()) || !holds((double)number, T()))
        CV_Error(Error::StsParseError,
                format("%s is %s; it must be %s", name, describeNode(number).c_str(), expected(T())));
    value = (T)(double)number;
}

}  // namespace iib
}  // namespace cv

#endif

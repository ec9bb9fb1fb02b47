// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

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
    if (node.isSeq())
        return format("a sequence of %d", (int)node.size());
    String keys;
    for (const String& key : node.keys())
        keys += (keys.empty() ? "" : ", ") + key;
    return "a map of: " + keys;
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

/** The number of a node, which must be one of type T, else this throws StsParseError with the name.

Where OpenCV's FileStorage has no 64-bit numbers, as in 4.6, it cuts whole numbers of a file to 32 bits, and nothing can
tell that afterwards.
 */
template <typename T> T numberOf(const FileNode& node, const String& name)
{
    if (!(node.isInt() || node.isReal()) || !holds((double)node, T()))
        CV_Error(Error::StsParseError, name + " is " + describeNode(node) + "; it must be " + expected(T()));
    return (T)(double)node;
}

//! Reads the number of this name. One that is missing keeps its value.
template <typename T> void readNumber(const FileNode& node, const char* name, T& value)
{
    const FileNode number = node[name];
    if (!number.empty())
        value = numberOf<T>(number, name);
}

//! The node that write() made under a name, or `node` if it is that one itself: users give either.
inline FileNode nodeNamed(const FileNode& node, const char* name)
{
    const FileNode inner = node.isMap() ? node[name] : FileNode();
    return inner.isMap() ? inner : node;
}

//! Algorithm::save() of one whose getDefaultName() holds a dot, which a node's name may not: what write() writes, alone.
inline void saveAlone(const Algorithm& algorithm, const String& filename)
{
    FileStorage fs(filename, FileStorage::WRITE);
    CV_Assert(fs.isOpened());
    algorithm.write(fs);
}

}  // namespace iib
}  // namespace cv

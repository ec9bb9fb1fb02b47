// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"

namespace cv { namespace iib {

//! Throws "NAME is VALUE; it must be WHAT" unless the condition holds.
inline void require(
        bool holds, const char* name, double value, const char* what, Error::Code code = Error::StsOutOfRange)
{
    if (!holds)
        CV_Error(code,
                format(value == std::floor(value) ? "%s is %.0f; it must be %s" : "%s is %g; it must be %s",
                        name, value, what));
}

//! A node's content, for errors.
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

/** The number of a node; throws StsParseError with the name if it is no number of type T.

FileStorage of OpenCV 4.6 has no 64-bit numbers: it silently cuts larger whole numbers to 32 bits. */
template <typename T> T numberOf(const FileNode& node, const String& name)
{
    typedef std::numeric_limits<T> Limits;
    const double number = node.isInt() || node.isReal() ? (double)node : NAN;
    const double least = (double)Limits::lowest(), most = (double)Limits::max();
    if (!(number >= least && number <= most) || (Limits::is_integer && number != std::floor(number)))
        CV_Error(Error::StsParseError, name + " is " + describeNode(node) +
                                               format("; it must be a %snumber from %g to %g",
                                                       Limits::is_integer ? "whole " : "", least, most));
    return (T)number;
}

//! Reads the number of this name; keeps the value if it is missing.
template <typename T> void readNumber(const FileNode& node, const char* name, T& value)
{
    const FileNode number = node[name];
    if (!number.empty())
        value = numberOf<T>(number, name);
}

//! The node that write() made under a name, or `node` itself: users pass either.
inline FileNode nodeNamed(const FileNode& node, const char* name)
{
    const FileNode inner = node.isMap() ? node[name] : FileNode();
    return inner.isMap() ? inner : node;
}

//! nodeNamed(), which must be of format 1; throws StsParseError otherwise.
inline FileNode nodeOfFormat1(const FileNode& node, const char* name)
{
    const FileNode fn = nodeNamed(node, name);
    int version = 0;
    if (fn.isMap())
        readNumber(fn, "format", version);
    if (version != 1)
        CV_Error(Error::StsParseError,
                String("the node holds no ") + name + " parameters of format 1: it is " + describeNode(node));
    return fn;
}

}}  // namespace cv::iib

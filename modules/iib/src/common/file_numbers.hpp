// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#pragma once

#include "../precomp.hpp"
#include "opencv2/iib/detail/files.hpp"

namespace cv { namespace iib {

//! Throws "NAME is VALUE; it must be WHAT" unless that holds.
inline void require(
        bool holds, const char* name, double value, const char* what, Error::Code code = Error::StsOutOfRange)
{
    if (!holds)
        CV_Error(code,
                format(value == std::floor(value) ? "%s is %.0f; it must be %s" : "%s is %g; it must be %s",
                        name, value, what));
}

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

/** The number of a node, which must be one of type T, else this throws StsParseError with the name.

Where OpenCV's FileStorage has no 64-bit numbers, as in 4.6, it cuts whole numbers of a file to 32 bits, and nothing can
tell that afterwards.
 */
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

/** Algorithm::save() that fails loudly, where OpenCV's own leaves half a file on a full disk. @param name of the node
 around what write() writes; empty: none, for names that no node may have. */
inline void saveWhole(const Algorithm& algorithm, const String& filename, const String& name = String())
{
    if (filename.size() > 3 && filename.compare(filename.size() - 3, 3, ".gz") == 0)
        CV_Error(
                Error::StsBadArg, "Cannot write " + filename +
                                          ": parameters are not packed; end its name in .yml, .xml or .json");
    FileStorage fs(filename, FileStorage::WRITE + FileStorage::MEMORY);
    CV_Assert(fs.isOpened());
    if (!name.empty())
        fs << name << "{";
    algorithm.write(fs);
    if (!name.empty())
        fs << "}";
    writeText(filename, fs.releaseAndGetString());
}

}}  // namespace cv::iib

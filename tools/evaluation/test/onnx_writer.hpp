// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef IIB_TOOLS_TEST_ONNX_WRITER_HPP
#define IIB_TOOLS_TEST_ONNX_WRITER_HPP

#include <string>
#include <vector>

//! Just enough of ONNX's protobuf encoding to write networks of a few nodes. Field numbers are onnx.proto's.
namespace onnx {

inline std::string varint(unsigned long long value)
{
    std::string bytes;
    for (; value >= 128; value >>= 7)
        bytes += char((value & 127) | 128);
    return bytes + char(value);
}

inline std::string number(int field, unsigned long long value) { return varint(field << 3) + varint(value); }

inline std::string bytes(int field, const std::string& content)
{
    return varint((field << 3) | 2) + varint(content.size()) + content;
}

//! TensorProto of floats.
inline std::string tensor(
        const std::string& name, const std::vector<int>& shape, const std::vector<float>& values)
{
    std::string out;
    for (int n : shape)
        out += number(1, n);
    const char* raw = reinterpret_cast<const char*>(values.data());
    return out + number(2, 1) + bytes(8, name) + bytes(9, std::string(raw, raw + 4 * values.size()));
}

//! TensorProto of the two 64-bit integers that Reshape takes.
inline std::string shape(const std::string& name, char rows, char columns)
{
    const char raw[16] = {rows, 0, 0, 0, 0, 0, 0, 0, columns};
    return number(1, 2) + number(2, 7) + bytes(8, name) + bytes(9, std::string(raw, sizeof(raw)));
}

//! ValueInfoProto of floats.
inline std::string value(const std::string& name, const std::vector<int>& shape)
{
    std::string dims;
    for (int n : shape)
        dims += bytes(1, number(1, n));
    return bytes(1, name) + bytes(2, bytes(1, number(1, 1) + bytes(2, dims)));
}

//! AttributeProto of integers.
inline std::string integers(const std::string& name, const std::vector<int>& values)
{
    std::string out = bytes(1, name) + number(20, 7);
    for (int v : values)
        out += number(8, v);
    return out;
}

inline std::string node(const std::string& type, const std::vector<std::string>& inputs,
        const std::string& output, const std::vector<std::string>& attributes)
{
    std::string out;
    for (const std::string& input : inputs)
        out += bytes(1, input);
    out += bytes(2, output) + bytes(3, output) + bytes(4, type);
    for (const std::string& attribute : attributes)
        out += bytes(5, attribute);
    return out;
}

//! ModelProto with the nodes, weights, one input and the outputs.
inline std::string model(const std::vector<std::string>& nodes, const std::vector<std::string>& weights,
        const std::string& input, const std::vector<std::string>& outputs)
{
    std::string graph;
    for (const std::string& n : nodes)
        graph += bytes(1, n);
    graph += bytes(2, "test");
    for (const std::string& w : weights)
        graph += bytes(5, w);
    graph += bytes(11, input);
    for (const std::string& o : outputs)
        graph += bytes(12, o);
    return number(1, 7) + bytes(7, graph) + bytes(8, number(2, 11));
}

}  // namespace onnx

#endif

// SPDX-License-Identifier: Apache-2.0

// Parameters and selections in FileStorage. Any tree of names and values must be refused by a cv::Exception without a
// change, or be the same when written again. OpenCV's writer builds the tree, since OpenCV's parser is not under test.

#include "byte_source.hpp"

#include "opencv2/iib.hpp"

namespace {

using namespace cv;
using cv::iib::HierarchicalMatcher;
using cv::iib::IIB;

const char* const NAMES[] = {"format", "scaleFactor", "granularity", "channels", "mapping", "overlap",
        "useOrientation", "extraChannels", "border", "selection", "levelSizes", "mode", "thresholds",
        "crossCheck", "maxRatio", "other"};

//! A number, mostly small.
int drawInt(ByteSource& in) { return in.between(0, 15) == 15 ? in.read<int>() : in.between(-1, 17); }

void writeValue(ByteSource& in, FileStorage& fs, int depth)
{
    const int kind = in.between(0, 9);
    if (kind < 4)
        fs << drawInt(in);
    else if (kind < 6)
        fs << in.number();
    else if (kind == 6)
        fs << (in.flag() ? "text" : "1");
    else
    {
        fs << (kind == 9 && depth < 3 ? "{" : "[");
        for (int i = in.between(0, 12); i > 0; i--)
            if (kind == 9 && depth < 3)
            {
                fs << format("n%d", i);
                writeValue(in, fs, depth + 1);
            }
            else if (kind == 8 && depth < 3)
                writeValue(in, fs, depth + 1);
            else
                fs << drawInt(in);
        fs << (kind == 9 && depth < 3 ? "}" : "]");
    }
}

String drawTree(ByteSource& in)
{
    FileStorage fs(".yml", FileStorage::WRITE | FileStorage::MEMORY);
    fs << "object"
       << "{";
    const int names = (int)(sizeof(NAMES) / sizeof(NAMES[0]));
    if (in.between(0, 3) > 0)
        fs << NAMES[0] << 1;
    int name = 1;
    for (int count = in.between(0, names); count > 0 && name < names; count--, name += 1 + in.between(0, 1))
    {
        fs << NAMES[name];
        writeValue(in, fs, 0);
    }
    fs << "}";
    return fs.releaseAndGetString();
}

template <typename T> void read(T& object, const FileNode& node)
{
    const String before = written(object);
    if (refused([&] { object.read(node); }))
    {
        FUZZ_CHECK(written(object) == before);
        return;
    }
    const String after = written(object);
    const FileStorage again(after, FileStorage::READ | FileStorage::MEMORY);
    object.read(again["object"]);
    FUZZ_CHECK(written(object) == after);
}

}  // namespace

FUZZ_TARGET
{
    const FileStorage fs(drawTree(in), FileStorage::READ | FileStorage::MEMORY);
    const FileNode node = in.between(0, 15) == 15 ? fs["object"]["selection"] : fs["object"];
    read(*IIB::create(), node);
    read(*HierarchicalMatcher::create(std::vector<int>(1, 4)), node);
}

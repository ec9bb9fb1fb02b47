// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "packed_codes.hpp"
#include "parameters.hpp"

#include "opencv2/iib/checked_file.private.hpp"

namespace cv {
namespace iib {

static const FileKind KIND = {"IIBINDEX", 1, "an index of HierarchicalMatcher"};
static const size_t CHUNK_ROWS = 4096;  // what is unpacked or packed at once

void saveCodes(const String& filename, const MatcherParameters& p, const PackedCodes& codes)
{
    CheckedWriter file(filename, KIND);
    file.list(codes.layout().levelSizes(), 4);
    file.number(p.mode, 4);
    file.number(p.crossCheck, 4);
    file.real(p.maxRatio);
    for (float threshold : p.thresholds)
        file.real(threshold);
    file.number(codes.images(), 8);
    for (size_t i = 0; i < codes.images(); i++)
        file.number(codes.rows(i), 8);
    for (size_t i = 0; i < codes.images(); i++)
        for (size_t row = 0; row < codes.rows(i); row += CHUNK_ROWS)
        {
            const Mat chunk = codes.descriptors(i, row, std::min(row + CHUNK_ROWS, codes.rows(i)));
            file.bytes(chunk.data, chunk.total());
        }
    file.seal();
    file.commit();
}

static MatcherParameters readParameters(CheckedReader& file)
{
    MatcherParameters p;
    p.levelSizes = file.list<int>(4);
    p.mode = (int)file.word();
    p.crossCheck = file.word() != 0;
    p.maxRatio = file.real();
    for (size_t i = 0; i < p.stages(); i++)
        p.thresholds.push_back(file.real());
    return p;
}

static std::vector<size_t> readRows(CheckedReader& file, uint64 width)
{
    const uint64 images = file.number(8);
    file.expect(images, 8);
    std::vector<size_t> rows((size_t)images);
    uint64 total = 0;
    for (size_t& count : rows)
    {
        const uint64 number = file.number(8);
        total += number;
        if (number > INT_MAX || width > INT_MAX || (width == 0 && number > 0))
            file.fail("its numbers do not make sense");
        file.expect(total, width);
        count = (size_t)number;
    }
    return rows;
}

Ptr<PackedCodes> loadCodes(const String& filename, MatcherParameters& parameters)
{
    CheckedReader file(filename, KIND);
    parameters = readParameters(file);
    uint64 width = 0, total = 0;
    for (int size : parameters.levelSizes)
        width += (unsigned)size;
    const std::vector<size_t> rows = readRows(file, width);
    checkLevelSizesGiven(parameters.levelSizes);
    check(parameters);
    for (size_t count : rows)
        total += count;
    const Ptr<PackedCodes> codes = makePtr<PackedCodes>(parameters.levelSizes);
    codes->reserve(rows.size(), (size_t)total);
    Mat chunk;
    for (size_t count : rows)
    {
        codes->add(Mat());
        for (size_t row = 0; row < count; row += chunk.rows)
        {
            chunk.create((int)std::min(CHUNK_ROWS, count - row), (int)width, CV_8U);
            file.bytes(chunk.data, chunk.total());
            codes->append(chunk);
        }
    }
    file.seal();
    file.expectEnd();
    return codes;
}

}  // namespace iib
}  // namespace cv

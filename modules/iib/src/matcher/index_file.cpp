// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "index_file.hpp"

#include "opencv2/iib/detail/checked_file.hpp"

namespace cv { namespace iib {

static const FileKind KIND = {"IIBINDEX", 1, "an index of HierarchicalMatcher"};
static const size_t CHUNK_ROWS = 4096;  // rows unpacked or packed at a time

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

Ptr<PackedCodes> loadCodes(const String& filename, MatcherParameters& parameters)
{
    CheckedReader file(filename, KIND);
    MatcherParameters p;
    p.levelSizes = file.list<int>(4);
    p.mode = (int)file.word();
    p.crossCheck = file.word() != 0;
    p.maxRatio = file.real();
    for (size_t i = 0; i < p.stages(); i++)
        p.thresholds.push_back(file.real());
    checkLevelSizesGiven(p.levelSizes);
    check(p);
    parameters = p;
    const Ptr<PackedCodes> codes = makePtr<PackedCodes>(p.levelSizes);
    const int width = codes->layout().bytes();
    const std::vector<uint64> rows = file.list<uint64>(8);
    uint64 total = 0;
    for (uint64 count : rows)
    {
        total += count;
        if (count > INT_MAX)
            file.fail("it has impossible numbers of rows");
        file.expect(total, width);
    }
    codes->reserve(rows.size(), (size_t)total);
    Mat chunk;
    for (uint64 count : rows)
    {
        codes->add(Mat());
        for (uint64 row = 0; row < count; row += chunk.rows)
        {
            chunk.create((int)std::min((uint64)CHUNK_ROWS, count - row), width, CV_8U);
            file.bytes(chunk.data, chunk.total());
            codes->append(chunk);
        }
    }
    file.seal();
    file.expectEnd();
    return codes;
}

}}  // namespace cv::iib

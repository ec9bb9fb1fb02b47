// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "index_file.hpp"

namespace cv {
namespace iib {

static const FileKind KIND = {"IIBINDEX", 1, "an index of HierarchicalMatcher"};

IndexWriter::IndexWriter(const String& filename, const IndexHeader& header) : file(filename, KIND)
{
    const MatcherParameters& p = header.parameters;
    file.number(p.levelSizes.size(), 4);
    for (size_t i = 0; i < p.levelSizes.size(); i++)
        file.number(p.levelSizes[i], 4);
    file.number(p.mode, 4);
    file.number(p.crossCheck, 4);
    file.real(p.maxRatio);
    for (size_t i = 0; i < p.thresholds.size(); i++)
        file.real(p.thresholds[i]);
    file.number(header.rows.size(), 8);
    for (size_t i = 0; i < header.rows.size(); i++)
        file.number(header.rows[i], 8);
}

void IndexWriter::finish()
{
    file.seal();
    file.commit();
}

IndexReader::IndexReader(const String& filename) : file(filename, KIND)
{
    MatcherParameters& p = head.parameters;
    const unsigned levels = file.word();
    file.expect(levels, 4);
    uint64 width = 0;
    for (unsigned i = 0; i < levels; i++)
    {
        p.levelSizes.push_back((int)file.word());
        width += (unsigned)p.levelSizes.back();
    }
    p.mode = (int)file.word();
    p.crossCheck = file.word() != 0;
    p.maxRatio = file.real();
    for (unsigned i = 1; i < levels; i++)
        p.thresholds.push_back(file.real());

    const uint64 images = file.number(8);
    file.expect(images, 8);
    head.rows.resize((size_t)images);
    uint64 total = 0;
    for (size_t i = 0; i < head.rows.size(); i++)
    {
        total += head.rows[i] = file.number(8);
        if (head.rows[i] > INT_MAX || width > INT_MAX || (width == 0 && head.rows[i] > 0))
            file.fail("its numbers do not make sense");
        file.expect(total, width);
    }
}

void IndexReader::finish()
{
    file.seal();
    file.expectEnd();
}

}  // namespace iib
}  // namespace cv

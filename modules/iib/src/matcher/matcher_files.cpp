// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "matcher_impl.hpp"
#include "index_file.hpp"

namespace cv {
namespace iib {

static const size_t CHUNK_ROWS = 4096;  // what is unpacked or packed at once

void HierarchicalMatcherImpl::write(FileStorage& fs) const { writeParameters(fs, parameters); }

void HierarchicalMatcherImpl::read(const FileNode& node)
{
    MatcherParameters p = readParameters(node, getDefaultName(), parameters);
    if (p.levelSizes != parameters.levelSizes)
    {
        if (index && index->rows() > 0)
            CV_Error(Error::StsBadArg,
                    "Other level sizes cannot be read while there are train descriptors: clear() first");
        Ptr<PackedCodes> empty;
        if (!p.levelSizes.empty())
            empty = makePtr<PackedCodes>(p.levelSizes);
        HierarchicalMatcher::clear();
        index = empty;
    }
    std::swap(parameters, p);
}

void HierarchicalMatcherImpl::saveIndex(const String& filename) const
{
    if (!index)
        CV_Error(Error::StsBadArg, "There is nothing to save: a matcher without level sizes knows them only "
                                   "after descriptors were added");
    IndexHeader header;
    header.parameters = parameters;
    header.parameters.levelSizes = index->layout().levelSizes();
    for (size_t i = 0; i < index->images(); i++)
        header.rows.push_back(index->rows(i));
    IndexWriter file(filename, header);
    for (size_t i = 0; i < index->images(); i++)
        for (size_t row = 0; row < index->rows(i); row += CHUNK_ROWS)
            file.write(index->descriptors(i, row, std::min(row + CHUNK_ROWS, index->rows(i))));
    file.finish();
}

void HierarchicalMatcherImpl::load(IndexReader& file)
{
    const std::vector<uint64>& rows = file.header().rows;
    uint64 total = 0;
    for (size_t i = 0; i < rows.size(); i++)
        total += rows[i];
    index->reserve(rows.size(), (size_t)total);
    Mat chunk;
    for (size_t i = 0; i < rows.size(); i++)
    {
        index->add(Mat());
        for (uint64 row = 0; row < rows[i]; row += chunk.rows)
        {
            chunk.create((int)std::min((uint64)CHUNK_ROWS, rows[i] - row), index->layout().bytes(), CV_8U);
            file.read(chunk);
            index->append(chunk);
        }
    }
    file.finish();
    trainDescCollection.resize(rows.size());
}

Ptr<HierarchicalMatcher> HierarchicalMatcher::loadIndex(const String& filename)
{
    IndexReader file(filename);
    const MatcherParameters& p = file.header().parameters;
    checkLevelSizesGiven(p.levelSizes);
    check(p);
    Ptr<HierarchicalMatcherImpl> matcher = makePtr<HierarchicalMatcherImpl>(p);
    matcher->load(file);
    return matcher;
}

}  // namespace iib
}  // namespace cv

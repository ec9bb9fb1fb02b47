// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "precomp.hpp"
#include "manifest.hpp"

#include "opencv2/core/utils/filesystem.hpp"

#include <cstdio>
#include <set>

namespace cv {
namespace iib {

namespace {

String manifestOf(const String& folder) { return folder + "/manifest.iib"; }

String segmentOf(const String& folder, uint64 number)
{
    return folder + format("/segment-%06llu.iib", (unsigned long long)number);
}

//! What a killed writer left behind; only under the lock.
void removeUnfinished(const String& folder)
{
    std::vector<String> files;
    glob(folder + "/*.tmp", files);
    for (size_t i = 0; i < files.size(); i++)
        std::remove(files[i].c_str());
}

class MappedIndexImpl CV_FINAL : public MappedIndex
{
public:
    explicit MappedIndexImpl(const String& folder_) : folder(folder_) { refresh(); }

    std::vector<int> levelSizes() const CV_OVERRIDE { return manifest.levelSizes; }
    int64 images() const CV_OVERRIDE { return (int64)firstImages.back(); }
    int64 rows() const CV_OVERRIDE { return (int64)firstRows.back(); }
    int segments() const CV_OVERRIDE { return (int)opened.size(); }
    uint64 version() const CV_OVERRIDE { return manifest.checksum; }

    int64 imageOf(int64 row) const CV_OVERRIDE
    {
        const size_t i = segmentHolding(row, firstRows, "row");
        return (int64)(firstImages[i] + opened[i]->codes().imageOf((size_t)row - firstRows[i]));
    }

    int64 firstRow(int64 image) const CV_OVERRIDE
    {
        const size_t i = segmentHolding(image, firstImages, "image");
        return (int64)(firstRows[i] + opened[i]->codes().start((size_t)image - firstImages[i]));
    }

    Mat descriptors(int64 image) const CV_OVERRIDE
    {
        const size_t i = segmentHolding(image, firstImages, "image"), local = (size_t)image - firstImages[i];
        return opened[i]->codes().descriptors(local);
    }

    void add(InputArrayOfArrays descriptors) CV_OVERRIDE
    {
        const SearchedCodes codes(manifest.levelSizes, descriptors);
        if (codes.images() == 0)
            return;
        commit([&](Manifest& next) {
            if (next.levelSizes != manifest.levelSizes)
                CV_Error(
                        Error::StsBadArg, folder + " holds an index of other level sizes now: open it again");
            const uint64 number = next.segments.empty() ? 1 : next.segments.back().number + 1;
            next.segments.push_back(writeSegment(segmentOf(folder, number), number, next.levelSizes, codes));
        });
    }

    void remove(const std::vector<int64>& images) CV_OVERRIDE
    {
        for (size_t i = 0; i < images.size(); i++)
            segmentHolding(images[i], firstImages, "image");
        commit([&](Manifest& next) {
            std::set<uint64> removed(next.removed.begin(), next.removed.end());
            removed.insert(images.begin(), images.end());
            next.removed.assign(removed.begin(), removed.end());
        });
    }

    void refresh() CV_OVERRIDE
    {
        Manifest next = readManifest(manifestOf(folder));
        SearchedCodes::check(next.levelSizes);
        std::vector<Ptr<CodeSegment>> segments;
        std::vector<size_t> rows(1, 0), images(1, 0);
        for (size_t i = 0; i < next.segments.size(); i++)
        {
            const SegmentEntry& entry = next.segments[i];
            const bool known = i < opened.size() && opened[i]->entry().number == entry.number &&
                               opened[i]->entry().checksum == entry.checksum;
            segments.push_back(
                    known ? opened[i]
                          : makePtr<CodeSegment>(segmentOf(folder, entry.number), entry, next.levelSizes));
            rows.push_back(rows.back() + (size_t)entry.rows);
            images.push_back(images.back() + (size_t)entry.images);
        }
        std::swap(manifest, next);
        std::swap(opened, segments);
        std::swap(firstRows, rows);
        std::swap(firstImages, images);
    }

    void knnSearch(InputArray queries, int k, std::vector<int64>& found, std::vector<int>& distances,
            int segment) const CV_OVERRIDE
    {
        if (segment < -1 || segment >= segments())
            CV_Error_(Error::StsOutOfRange, ("segment is %d: there are %d", segment, segments()));
        const size_t first = segment < 0 ? 0 : segment, end = segment < 0 ? opened.size() : first + 1;
        std::vector<SearchedCodes::Part> parts;
        for (size_t i = first; i < end; i++)
        {
            const SearchedCodes& codes = opened[i]->codes();  // first: it checks what the manifest claims
            parts.push_back({&codes, firstRows[i], hiddenOf(i)});
        }
        SearchedCodes::findNearest(manifest.levelSizes, parts, queries, k, found, distances);
    }

private:
    void commit(const std::function<void(Manifest&)>& change)
    {
        {
            const FileLock lock(folder + "/lock");
            removeUnfinished(folder);
            Manifest next = readManifest(manifestOf(folder));
            change(next);
            writeManifest(manifestOf(folder), next);
        }
        refresh();
    }

    //! The last segment that begins at or before `number`; `firsts` ends with the number of all.
    size_t segmentHolding(int64 number, const std::vector<size_t>& firsts, const char* what) const
    {
        if (number < 0 || (uint64)number >= firsts.back())
            CV_Error_(Error::StsOutOfRange,
                    ("%s %lld: there are %lld", what, (long long)number, (long long)firsts.back()));
        return std::upper_bound(firsts.begin(), firsts.end(), (size_t)number) - firsts.begin() - 1;
    }

    //! Which images of a segment were removed; empty if none was.
    std::vector<bool> hiddenOf(size_t segment) const
    {
        const std::vector<uint64>& removed = manifest.removed;
        const auto first = std::lower_bound(removed.begin(), removed.end(), firstImages[segment]),
                   end = std::lower_bound(first, removed.end(), firstImages[segment + 1]);
        std::vector<bool> hidden(first == end ? 0 : firstImages[segment + 1] - firstImages[segment], false);
        for (auto image = first; image != end; ++image)
            hidden[(size_t)*image - firstImages[segment]] = true;
        return hidden;
    }

    const String folder;
    Manifest manifest;
    std::vector<Ptr<CodeSegment>> opened;
    std::vector<size_t> firstRows, firstImages;  //!< of each segment, and the number of all
};

}  // namespace

MappedIndex::~MappedIndex() {}

Ptr<MappedIndex> MappedIndex::create(const String& folder, const std::vector<int>& levelSizes)
{
    SearchedCodes::check(levelSizes);
    if (!utils::fs::isDirectory(folder) && !utils::fs::createDirectory(folder))
        CV_Error(Error::StsError, "Cannot make the folder " + folder + ": check its parent and the rights");
    {
        const FileLock lock(folder + "/lock");
        if (utils::fs::exists(manifestOf(folder)))
            CV_Error(Error::StsBadArg, folder + " holds an index already: open it, or take another folder");
        Manifest manifest;
        manifest.levelSizes = levelSizes;
        writeManifest(manifestOf(folder), manifest);
    }
    return open(folder);
}

Ptr<MappedIndex> MappedIndex::open(const String& folder) { return makePtr<MappedIndexImpl>(folder); }

}  // namespace iib
}  // namespace cv

// SPDX-License-Identifier: Apache-2.0
#include "precomp.hpp"
#include "index_commit.hpp"
#include "index_folder.hpp"

#include "opencv2/core/utils/filesystem.hpp"

#include <functional>
#include <set>

namespace cv {
namespace iib {

namespace {

uint64 imagesOf(const Manifest& manifest)
{
    uint64 images = 0;
    for (const SegmentEntry& segment : manifest.segments)
        images += segment.images;
    return images;
}

class MappedIndexImpl CV_FINAL : public MappedIndex
{
public:
    MappedIndexImpl(const String& folder_, const Manifest& manifest)
        : folder(folder_), last(folder, manifest, 0)
    {
    }

    std::vector<int> levelSizes() const CV_OVERRIDE { return last.manifest().levelSizes; }
    int64 images() const CV_OVERRIDE { return last.images(); }
    int64 rows() const CV_OVERRIDE { return last.rows(); }
    int segments() const CV_OVERRIDE { return last.segments(); }
    uint64 version() const CV_OVERRIDE { return last.manifest().checksum; }
    int64 imageOf(int64 row) const CV_OVERRIDE { return last.imageOf(row); }
    int64 firstRow(int64 image) const CV_OVERRIDE { return last.firstRow(image); }
    Mat descriptors(int64 image) const CV_OVERRIDE { return last.descriptors(image); }

    void add(InputArrayOfArrays descriptors) CV_OVERRIDE
    {
        const SearchedCodes codes(levelSizes(), descriptors);
        if (codes.images() == 0)
            return;
        commit([&](Manifest& next) {
            if (next.levelSizes != levelSizes())
                CV_Error(
                        Error::StsBadArg, folder + " holds an index of other level sizes now: open it again");
            const uint64 number = next.segments.empty() ? 1 : next.segments.back().number + 1;
            next.segments.push_back(writeSegment(segmentOf(folder, number), number, next.levelSizes, codes));
        });
    }

    void remove(const std::vector<int64>& images) CV_OVERRIDE
    {
        commit([&](Manifest& next) {
            const uint64 count = imagesOf(next);
            for (int64 image : images)
                checkNumber(image, count, "image");
            std::set<uint64> removed(next.removed.begin(), next.removed.end());
            removed.insert(images.begin(), images.end());
            next.removed.assign(removed.begin(), removed.end());
        });
    }

    void refresh() CV_OVERRIDE { last = IndexCommit(folder, readManifest(manifestOf(folder)), &last); }

    void knnSearch(InputArray queries, int k, std::vector<int64>& found, std::vector<int>& distances,
            int segment) const CV_OVERRIDE
    {
        if (segment < -1 || segment >= segments())
            CV_Error_(Error::StsOutOfRange, ("segment is %d: there are %d", segment, segments()));
        std::vector<SearchedCodes::Part> parts;
        for (int i = segment < 0 ? 0 : segment, end = segment < 0 ? segments() : segment + 1; i < end; i++)
            parts.push_back(last.part(i));
        SearchedCodes::findNearest(levelSizes(), parts, queries, k, found, distances);
    }

private:
    // Whatever may throw comes before the commit: what is committed does not throw.
    void commit(const std::function<void(Manifest&)>& change)
    {
        const FileLock lock(lockOf(folder));
        removeUnfinished(folder);
        Manifest next = readManifest(manifestOf(folder));
        change(next);
        CheckedWriter file = writeManifest(manifestOf(folder), next);
        IndexCommit after(folder, next, &last);
        file.commit();
        last = std::move(after);
    }

    const String folder;
    IndexCommit last;
};

}  // namespace

MappedIndex::~MappedIndex() {}

Ptr<MappedIndex> MappedIndex::create(const String& folder, const std::vector<int>& levelSizes)
{
    SearchedCodes::check(levelSizes);
    if (!utils::fs::isDirectory(folder) && !utils::fs::createDirectory(folder))
        CV_Error(Error::StsError, "Cannot make the folder " + folder + ": check its parent and the rights");
    checkEmpty(folder);  // before the lock is in it
    const FileLock lock(lockOf(folder));
    checkEmpty(folder);
    Manifest manifest;
    manifest.levelSizes = levelSizes;
    CheckedWriter file = writeManifest(manifestOf(folder), manifest);
    const Ptr<MappedIndex> index = makePtr<MappedIndexImpl>(folder, manifest);
    file.commit();
    return index;
}

Ptr<MappedIndex> MappedIndex::open(const String& folder)
{
    return makePtr<MappedIndexImpl>(folder, readManifest(manifestOf(folder)));
}

}  // namespace iib
}  // namespace cv

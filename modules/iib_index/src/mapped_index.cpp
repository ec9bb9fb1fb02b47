// SPDX-License-Identifier: Apache-2.0
#include "precomp.hpp"
#include "index_folder.hpp"

#include <functional>
#include <numeric>
#include <set>

namespace cv { namespace iib {

namespace {

//! @throws cv::Exception (StsOutOfRange) unless 0 <= number < count.
void checkNumber(int64 number, uint64 count, const char* what)
{
    if (number < 0 || (uint64)number >= count)
        CV_Error_(
                Error::StsOutOfRange, ("%s %lld: there are %lld", what, (long long)number, (long long)count));
}

// The last segment that begins at or before a number; `firsts` ends with the total.
size_t segmentHolding(int64 number, const std::vector<size_t>& firsts, const char* what)
{
    checkNumber(number, firsts.back(), what);
    return std::upper_bound(firsts.begin(), firsts.end(), (size_t)number) - firsts.begin() - 1;
}

//! A commit of an index, ready for searches.
struct IndexCommit
{
    Manifest manifest;
    std::vector<Ptr<CodeSegment>> segments;
    std::vector<size_t> firstRows, firstImages;  //!< of each segment, then the total

    //! Reuses segments of an earlier commit, which may be mapped already.
    //! @throws cv::Exception for invalid level sizes in the manifest.
    IndexCommit(const String& folder, const Manifest& manifest_, const IndexCommit* before)
        : manifest(manifest_), firstRows(1, 0), firstImages(1, 0)
    {
        PackedCodes::check(manifest.levelSizes);
        const size_t known = before ? before->segments.size() : 0;
        for (size_t i = 0; i < manifest.segments.size(); i++)
        {
            const SegmentEntry& entry = manifest.segments[i];
            const bool same = i < known && before->segments[i]->entry().number == entry.number &&
                              before->segments[i]->entry().checksum == entry.checksum;
            segments.push_back(
                    same ? before->segments[i]
                         : makePtr<CodeSegment>(segmentOf(folder, entry.number), entry, manifest.levelSizes));
            firstRows.push_back(firstRows.back() + (size_t)entry.rows);
            firstImages.push_back(firstImages.back() + (size_t)entry.images);
        }
    }

    CodePart part(int segment) const
    {
        // The codes come first, to check the number of images: a damaged manifest may claim more than memory holds.
        const PackedCodes& codes = segments[segment]->codes();
        const std::vector<uint64>& removed = manifest.removed;
        const auto first = std::lower_bound(removed.begin(), removed.end(), firstImages[segment]),
                   end = std::lower_bound(first, removed.end(), firstImages[segment + 1]);
        std::vector<bool> hidden(first == end ? 0 : firstImages[segment + 1] - firstImages[segment], false);
        for (auto image = first; image != end; ++image)
            hidden[(size_t)*image - firstImages[segment]] = true;
        return {&codes, firstRows[segment], hidden};
    }
};

class MappedIndexImpl CV_FINAL : public MappedIndex
{
public:
    MappedIndexImpl(const String& folder_, const Manifest& manifest)
        : folder(folder_), last(folder, manifest, 0)
    {
    }

    std::vector<int> levelSizes() const CV_OVERRIDE { return last.manifest.levelSizes; }
    int64 images() const CV_OVERRIDE { return (int64)last.firstImages.back(); }
    int64 rows() const CV_OVERRIDE { return (int64)last.firstRows.back(); }
    int segments() const CV_OVERRIDE { return (int)last.segments.size(); }
    uint64 version() const CV_OVERRIDE { return last.manifest.checksum; }

    int64 imageOf(int64 row) const CV_OVERRIDE
    {
        const size_t i = segmentHolding(row, last.firstRows, "row"), first = last.firstRows[i];
        return (int64)(last.firstImages[i] + last.segments[i]->codes().imageOf((size_t)row - first));
    }

    int64 firstRow(int64 image) const CV_OVERRIDE
    {
        const size_t i = segmentHolding(image, last.firstImages, "image"), first = last.firstImages[i];
        return (int64)(last.firstRows[i] + last.segments[i]->codes().start((size_t)image - first));
    }

    Mat descriptors(int64 image) const CV_OVERRIDE
    {
        const size_t i = segmentHolding(image, last.firstImages, "image"), first = last.firstImages[i];
        return last.segments[i]->codes().descriptors((size_t)image - first);
    }

    void add(InputArrayOfArrays descriptors) CV_OVERRIDE
    {
        const PackedCodes codes(levelSizes(), descriptors);
        if (codes.images() == 0)
            return;
        commit([&](Manifest& next) {
            if (next.levelSizes != levelSizes())
                CV_Error(
                        Error::StsBadArg, folder + " now holds an index of other level sizes: open it again");
            const uint64 number = next.segments.empty() ? 1 : next.segments.back().number + 1;
            next.segments.push_back(writeSegment(segmentOf(folder, number), number, next.levelSizes, codes));
        });
    }

    void remove(const std::vector<int64>& images) CV_OVERRIDE
    {
        commit([&](Manifest& next) {
            const uint64 count = std::accumulate(next.segments.begin(), next.segments.end(), (uint64)0,
                    [](uint64 sum, const SegmentEntry& segment) { return sum + segment.images; });
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
        std::vector<CodePart> parts;
        for (int i = segment < 0 ? 0 : segment, end = segment < 0 ? segments() : segment + 1; i < end; i++)
            parts.push_back(last.part(i));
        PackedCodes::findNearest(levelSizes(), parts, queries, k, found, distances);
    }

private:
    // Everything that may throw comes before the file's commit, so that a call that throws has committed nothing.
    void commit(const std::function<void(Manifest&)>& change)
    {
        const FileLock lock(lockOf(folder), FileLock::LOCK_FILE);
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
    PackedCodes::check(levelSizes);
    makeFolder(checkedName(folder));
    checkEmpty(folder);  // also here, so that no lock is left in a folder of other files
    const FileLock lock(lockOf(folder), FileLock::LOCK_FILE);
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

}}  // namespace cv::iib

// SPDX-License-Identifier: Apache-2.0

// MappedIndex on any manifest and segment, with right checksums in most runs. Expects a cv::Exception, or the results
// of brute force.

#include "byte_source.hpp"
#include "support/temporary_file.hpp"

#include "opencv2/iib/detail/checked_file.hpp"
#include "opencv2/iib_index.hpp"

namespace {

using namespace cv;
using cv::iib::MappedIndex;

//! Writes a file in the format of checked_file.hpp, sometimes with wrong numbers.
class FileOf
{
public:
    FileOf(ByteSource& in_, const char* letters, int format) : in(in_), text(letters) { number(format, 4); }
    void number(uint64 value, int size)
    {
        if (in.rarely(64))
        {
            value = in.flag() ? in.read<uint64>() : (uint64)in.read<short>() << in.between(0, 56);
            altered = true;
        }
        for (int i = 0; i < size; i++)
            text += (char)(value >> 8 * i);
    }
    void bytes(const std::string& more) { text += more; }
    //! Appends and returns the hash of all bytes so far.
    uint64 seal()
    {
        cv::iib::Fnv1a hash;
        hash.add(text.data(), text.size());
        number(hash.value(), 8);
        return hash.value();
    }
    const std::string& whole()
    {
        if (in.rarely(64))
        {
            text.resize(in.read<ushort>() % (text.size() + 1));
            altered = true;
        }
        return text;
    }
    bool isAltered() const { return altered; }
    size_t size() const { return text.size(); }

private:
    ByteSource& in;
    std::string text;
    bool altered = false;
};

//! The checksum of code_segment.cpp.
uint64 wordHash(const std::string& bytes)
{
    uint64 state = CV_BIG_UINT(0xcbf29ce484222325);
    for (size_t i = 0; i + 8 <= bytes.size(); i += 8)
    {
        uint64 word;
        std::memcpy(&word, &bytes[i], sizeof(word));
        state = (state ^ word) * CV_BIG_UINT(0x100000001b3);
    }
    return state;
}

//! A level of up to 4 bytes is one word, without padding in either packing: 64 bytes hold 16 codes.
const int BLOCK_BYTES = 64, CODES_PER_BLOCK = 16;

//! The state of the files written last.
struct Written
{
    bool mayBeRefused;  //!< whether they differ from files of the library
    bool filled;        //!< whether padding bits may be set, which then count in distances
};

Written write(ByteSource& in, const String& folder)
{
    const int levelBytes = in.between(1, 4), images = in.between(0, 5), checkedBlocks = in.between(1, 3);
    std::vector<int> rows;
    int all = 0;
    for (int i = 0; i < images; i++)
    {
        rows.push_back(in.between(0, 20));
        all += rows.back();
    }
    const bool tables = in.flag();
    FileOf codes(in, "IIBCODES", 2);
    codes.number(1, 4);
    codes.number(levelBytes, 4);
    codes.number(tables ? 2 : 1, 4);
    codes.number(checkedBlocks, 4);
    codes.number(images, 8);
    for (int count : rows)
        codes.number(count, 8);
    std::string blocks((all + CODES_PER_BLOCK - 1) / CODES_PER_BLOCK * BLOCK_BYTES, '\0');
    const bool filled = in.rarely(8);  // with padding bits set
    for (size_t i = 0; i < blocks.size(); i++)
    {
        const int place = i % BLOCK_BYTES, code = tables ? place % CODES_PER_BLOCK : place / 4,
                  byte = tables ? place / CODES_PER_BLOCK : place % 4;
        if (filled || (byte < levelBytes && (int)(i / BLOCK_BYTES) * CODES_PER_BLOCK + code < all))
            blocks[i] = (char)in.read<uchar>();
    }
    for (size_t i = 0; i < blocks.size(); i += checkedBlocks * BLOCK_BYTES)
        codes.number(wordHash(blocks.substr(i, checkedBlocks * BLOCK_BYTES)), 8);
    const uint64 checksum = codes.seal();
    codes.bytes(std::string((4096 - codes.size() % 4096) % 4096, '\0') + blocks);
    const int segments = in.between(0, 3);  // all with the same codes
    for (int i = 1; i <= segments; i++)
        opencv_test::writeFile(folder + format("/segment-%06d.iib", i), codes.whole());

    FileOf commit(in, "IIBSHARD", 1);
    commit.number(1, 4);
    commit.number(levelBytes, 4);
    commit.number(segments, 8);
    for (int i = 0; i < segments; i++)
    {
        commit.number(i + 1, 8);
        commit.number(all, 8);
        commit.number(images, 8);
        commit.number(checksum, 8);
    }
    const int removed = in.between(0, 3);
    commit.number(removed, 8);
    for (int i = 0; i < removed; i++)
        commit.number(i * 2, 8);
    commit.seal();
    opencv_test::writeFile(folder + "/manifest.iib", commit.whole());
    return {codes.isAltered() || commit.isAltered() || 2 * (removed - 1) >= segments * images,
            filled || codes.isAltered()};
}

//! A search must find the images' rows with the right distances, unless padding bits are set.
void check(const MappedIndex& index, bool filled)
{
    FUZZ_CHECK(index.images() >= 0 && index.rows() >= 0);
    const std::vector<int> levels = index.levelSizes();
    int width = 0;
    for (int level : levels)
        width += level;
    const Mat query(1, width, CV_8U, Scalar(0x35));
    std::vector<int64> rows;
    std::vector<int> distances;
    const int k = (int)std::min(index.rows() + 2, (int64)100);
    index.knnSearch(query, k, rows, distances);
    FUZZ_CHECK(rows.size() == (size_t)k && distances.size() == rows.size());
    std::vector<std::pair<int, int64>> all;
    for (int64 image = 0; image < index.images(); image++)
    {
        const Mat codes = index.descriptors(image);
        for (int i = 0; i < codes.rows; i++)
            all.push_back(
                    std::make_pair((int)norm(codes.row(i), query, NORM_HAMMING), index.firstRow(image) + i));
    }
    FUZZ_CHECK((int64)all.size() == index.rows());
    for (int i = 0; i < k && rows[i] >= 0; i++)
    {
        FUZZ_CHECK(rows[i] < index.rows());
        FUZZ_CHECK(filled ||
                   std::find(all.begin(), all.end(), std::make_pair(distances[i], rows[i])) != all.end());
        FUZZ_CHECK(index.firstRow(index.imageOf(rows[i])) <= rows[i]);
        FUZZ_CHECK(i == 0 ||
                   std::make_pair(distances[i - 1], rows[i - 1]) < std::make_pair(distances[i], rows[i]));
    }
}

}  // namespace

FUZZ_TARGET
{
    static const opencv_test::TemporaryFolder folder;
    const Written written = write(in, folder.name);
    // The first call that reads a file also checks it.
    const bool thrown = refused([&] { check(*MappedIndex::open(folder.name), written.filled); });
    FUZZ_CHECK(!thrown || written.mayBeRefused);
}

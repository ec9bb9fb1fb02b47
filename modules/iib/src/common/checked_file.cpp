// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "checked_file.hpp"

#include <atomic>
#include <cstdio>
#include <cstring>

#ifdef _WIN32
#define NOMINMAX 1  // as libstdc++ has it
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <sys/stat.h>
#include <windows.h>
#else
#include <cstdlib>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace cv {
namespace iib {

#ifdef _WIN32
std::wstring systemName(const String& name)
{
    std::wstring wide;
    for (const unsigned page : {CP_UTF8, CP_ACP})
        if (wide.empty())
        {
            wide.resize(MultiByteToWideChar(page, MB_ERR_INVALID_CHARS, name.data(), (int)name.size(), 0, 0));
            MultiByteToWideChar(page, 0, name.data(), (int)name.size(), &wide[0], (int)wide.size());
        }
    return wide;
}
#endif

namespace {

const size_t LETTERS = 8;

//! What is at a file's name.
struct Present
{
    bool any, file;
    int rights;
};

#ifdef _WIN32
int processId() { return _getpid(); }
String fileOf(const String& name) { return name; }
Present presentAt(const String& name)
{
    const DWORD attributes = GetFileAttributesW(systemName(name).c_str());
    return {attributes != INVALID_FILE_ATTRIBUTES, (attributes & FILE_ATTRIBUTE_DIRECTORY) == 0, 0};
}
void keepRights(std::FILE*, int) {}
std::FILE* create(const String& name)
{
    const int file = _wopen(systemName(name).c_str(),
            _O_CREAT | _O_EXCL | _O_WRONLY | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
    return file < 0 ? 0 : _fdopen(file, "wb");
}
void remove(const String& name) { _wremove(systemName(name).c_str()); }
bool flushToDisk(std::FILE* file) { return std::fflush(file) == 0 && _commit(_fileno(file)) == 0; }

// Tries again what is refused for a moment: who reads a file keeps it from being replaced, and vice versa.
template <typename Action> bool patiently(int seconds, Action action)
{
    for (int left = 100 * seconds; !action(); left--)
    {
        const DWORD error = GetLastError();
        if (left == 0 || (error != ERROR_SHARING_VIOLATION && error != ERROR_ACCESS_DENIED))
            return false;
        Sleep(10);
    }
    return true;
}

bool replace(const String& from, const String& to, const String&)
{
    const std::wstring target = systemName(to);
    const auto move = [&] {
        return MoveFileExW(systemName(from).c_str(), target.c_str(),
                       MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0;
    };
    if (patiently(1, move))
        return true;
    // Readers in turn leave moments; missing rights, which give the same error, are not waited for.
    const HANDLE file = CreateFileW(target.c_str(), GENERIC_WRITE | DELETE, 0, 0, OPEN_EXISTING, 0, 0);
    if (file != INVALID_HANDLE_VALUE)
        CloseHandle(file);
    else if (GetLastError() == ERROR_ACCESS_DENIED)
        return false;
    return patiently(60, move);
}

void openToRead(std::filebuf& file, const String& name)
{
    patiently(5, [&] { return file.open(systemName(name).c_str(), std::ios::in | std::ios::binary) != 0; });
}
#else
int processId() { return (int)getpid(); }
std::FILE* create(const String& name) { return std::fopen(name.c_str(), "wbx"); }
void remove(const String& name) { std::remove(name.c_str()); }
void openToRead(std::filebuf& file, const String& name) { file.open(name, std::ios::in | std::ios::binary); }

String fileOf(const String& name)
{
    struct stat status;
    if (lstat(name.c_str(), &status) != 0 || !S_ISLNK(status.st_mode))
        return name;
    char* const resolved = realpath(name.c_str(), 0);
    const String result = resolved ? resolved : "";
    std::free(resolved);
    if (result.empty())
        CV_Error(Error::StsError, "Cannot write " + name + ": it is a link that leads to no file");
    return result;
}

Present presentAt(const String& name)
{
    struct stat status;
    const bool any = stat(name.c_str(), &status) == 0;
    return {any, any && S_ISREG(status.st_mode), any ? int(status.st_mode & 07777) : 0};
}

// Rights that cannot be kept are no reason to lose the data.
void keepRights(std::FILE* file, int rights)
{
    if (fchmod(fileno(file), (mode_t)rights) != 0)
        return;
}

bool flushToDisk(std::FILE* file) { return std::fflush(file) == 0 && fsync(fileno(file)) == 0; }

bool replace(const String& from, const String& to, const String& folder)
{
    if (std::rename(from.c_str(), to.c_str()) != 0)
        return false;
    // The new name is safe once the folder is on the disk too; some file systems cannot do that.
    const int descriptor = ::open(folder.c_str(), O_RDONLY);
    if (descriptor >= 0)
    {
        fsync(descriptor);
        close(descriptor);
    }
    return true;
}
#endif

// CRC-32 of IEEE 802.3, as gzip has it.
unsigned crc32(const String& bytes)
{
    unsigned crc = ~0u;
    for (char byte : bytes)
    {
        crc ^= (uchar)byte;
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

//! A gzip file (RFC 1952) of stored blocks (RFC 1951): what these files save is too short to be worth more.
String gzipped(const String& text)
{
    String file("\x1f\x8b\x08\0\0\0\0\0\0\xff", 10);
    const auto number = [&](size_t value, int bytes) { file.append((const char*)&value, bytes); };
    size_t at = 0;
    do
    {
        const String block = text.substr(at, 0xffff);
        at += block.size();
        number(at == text.size(), 1);  // whether it is the last one
        number(block.size(), 2);
        number(~block.size(), 2);
        file += block;
    } while (at < text.size());
    number(crc32(text), 4);
    number(text.size(), 4);
    return file;
}

}  // namespace

//! A file that takes the place of another when it is whole: written beside it, flushed to the disk, renamed.
class ReplacedFile
{
public:
    explicit ReplacedFile(const String& filename)
        : name(checkedName(filename)), target(fileOf(filename)), stream(0)
    {
        const Present old = presentAt(target);
        if (old.any && !old.file)
            CV_Error(Error::StsError, "Cannot write " + name + ": it is a folder, a device or a pipe");
        static std::atomic<int> counter(0);
        for (int attempt = 0; attempt < 100 && !stream; attempt++)  // another's name in use
        {
            temporary = format("%s.%d-%d.tmp", target.c_str(), processId(), counter++);
            stream = create(temporary);
        }
        if (!stream)
            CV_Error(Error::StsError, "Cannot write " + name + ": check the folder and its rights");
        if (old.any)
            keepRights(stream, old.rights);
    }
    ReplacedFile(const ReplacedFile&) = delete;
    ReplacedFile& operator=(const ReplacedFile&) = delete;
    ~ReplacedFile()
    {
        if (stream)
            std::fclose(stream);
        if (!committed)
            remove(temporary);
    }

    void write(const void* data, size_t size)
    {
        if (size > 0)  // fwrite takes no null pointer, not even for nothing
            std::fwrite(data, 1, size, stream);
    }

    void commit()
    {
        // Before anything is done, since memory may lack.
        const size_t slash = target.rfind('/');
        const String folder = slash == String::npos ? String(".") : target.substr(0, slash + 1);
        const bool good = !std::ferror(stream) && flushToDisk(stream), closed = std::fclose(stream) == 0;
        stream = 0;
        committed = good && closed && replace(temporary, target, folder);
        if (!committed)
            CV_Error(Error::StsError,
                    "Cannot write " + name + ": check the folder, its rights and the free space");
    }

private:
    const String name;    //!< as given, for errors
    const String target;  //!< with links resolved
    String temporary;
    std::FILE* stream;
    bool committed = false;
};

void writeText(const String& filename, const String& text)
{
    const bool packed = filename.size() > 3 && filename.compare(filename.size() - 3, 3, ".gz") == 0;
    const String content = packed ? gzipped(text) : text;
    ReplacedFile file(filename);
    file.write(content.data(), content.size());
    file.commit();
}

CheckedWriter::CheckedWriter(const String& filename, const FileKind& kind)
    : file(makePtr<ReplacedFile>(filename)), written(0)
{
    bytes(kind.letters, LETTERS);
    number(kind.version, 4);
}

void CheckedWriter::bytes(const void* data, size_t size)
{
    hash.add(data, size);
    unchecked(data, size);
}

void CheckedWriter::unchecked(const void* data, size_t size)
{
    file->write(data, size);
    written += size;
}

// Files are little-endian, as are all machines that this is built for.
void CheckedWriter::number(uint64 value, int size) { bytes(&value, size); }

void CheckedWriter::real(float value) { bytes(&value, sizeof(value)); }

uint64 CheckedWriter::seal()
{
    const uint64 value = hash.value();
    number(value, 8);
    return value;
}

void CheckedWriter::commit() { file->commit(); }

CheckedReader::CheckedReader(const String& filename, const FileKind& kind)
    : name(checkedName(filename)), kindName(kind.name), whole(0), rest(0), format(0)
{
    if (presentAt(name).file)  // a pipe would not open before somebody writes to it
        openToRead(*stream.rdbuf(), name);
    stream.seekg(0, std::ios::end);
    const std::streamoff end = stream.tellg();
    stream.seekg(0);
    if (!stream || end < 0)
        CV_Error(Error::StsError, "Cannot read " + name);
    whole = rest = (uint64)end;
    char letters[LETTERS];
    bytes(letters, sizeof(letters));
    if (std::memcmp(letters, kind.letters, sizeof(letters)) != 0)
        fail("it is a file of another kind");
    format = word();
    if (format == 0)
        fail("its format 0 does not exist: it is altered");
    if (format > kind.version)
        fail(cv::format("its format %u is newer than this library's, %u", format, kind.version));
}

uint64 CheckedReader::seal()
{
    const uint64 expected = hash.value();
    if (number(8) != expected)
        fail("it is altered: its checksum does not fit");
    return expected;
}

void CheckedReader::expect(uint64 count, uint64 size) const
{
    if (size != 0 && count > rest / size)
        fail("it is truncated or altered");
}

void CheckedReader::expectEnd() const
{
    if (rest != 0)
        fail("it is altered: there is more behind its end");
}

void CheckedReader::bytes(void* data, size_t size)
{
    expect(size, 1);
    stream.read((char*)data, size);
    if (!stream)
        fail("it is truncated");
    hash.add(data, size);
    rest -= size;
}

uint64 CheckedReader::number(int size)
{
    uint64 value = 0;
    bytes(&value, size);
    return value;
}

float CheckedReader::real()
{
    float value = 0;
    bytes(&value, sizeof(value));
    return value;
}

void CheckedReader::fail(const String& why) const
{
    CV_Error(Error::StsParseError, name + " cannot be read as " + kindName + ": " + why);
}

}  // namespace iib
}  // namespace cv

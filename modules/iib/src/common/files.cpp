// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "opencv2/iib/detail/files.hpp"

#include <atomic>
#include <fstream>

#ifdef _WIN32
#define NOMINMAX 1  // as libstdc++ has it
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <sys/stat.h>
#include <windows.h>
#else
#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace cv { namespace iib {

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

//! The file of a name, if there is one. `file`: it is a regular file.
struct Present
{
    bool any, file;
    int rights;
};

#ifdef _WIN32
int processId() { return _getpid(); }
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

// Repeats an action that Windows refuses while another process has the file open.
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
    // Wait longer for readers that follow each other, but not for missing rights, which give the same error.
    const HANDLE file = CreateFileW(target.c_str(), GENERIC_WRITE | DELETE, 0, 0, OPEN_EXISTING, 0, 0);
    if (file != INVALID_HANDLE_VALUE)
        CloseHandle(file);
    else if (GetLastError() == ERROR_ACCESS_DENIED)
        return false;
    return patiently(60, move);
}

bool open(std::filebuf& file, const String& name)
{
    return patiently(
            5, [&] { return file.open(systemName(name).c_str(), std::ios::in | std::ios::binary) != 0; });
}
#else
int processId() { return (int)getpid(); }
std::FILE* create(const String& name) { return std::fopen(name.c_str(), "wbx"); }
void remove(const String& name) { std::remove(name.c_str()); }
bool open(std::filebuf& file, const String& name)
{
    return file.open(name, std::ios::in | std::ios::binary) != 0;
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

//! The begin of a temporary file's name, short enough for the system's limit of 255 bytes.
String beginOf(const String& file)
{
    return file.size() - (file.rfind('/') + 1) > 200 ? file.substr(0, file.rfind('/') + 1) + "iib" : file;
}

String partOf(const String& file, int process, int number)
{
    return format("%s.%d-%d.tmp", beginOf(file).c_str(), process, number);
}

}  // namespace

#ifdef _WIN32
String endOfLinks(const String& name) { return name; }
#else
String endOfLinks(const String& name)
{
    String path = name;
    for (int links = 0; links < 40; links++)
    {
        char target[4096];
        const ssize_t size = readlink(path.c_str(), target, sizeof(target));
        if (size < 0)
            return path;
        const size_t folder = target[0] == '/' ? 0 : path.rfind('/') + 1;  // 0 without a slash
        path = path.substr(0, folder) + String(target, (size_t)size);
    }
    CV_Error(Error::StsError, "Cannot write " + name + ": its links lead in a circle");
}
#endif

WholeFile::WholeFile(const String& filename)
    : name(checkedName(filename)), target(endOfLinks(filename)), stream(0)
{
    const Present old = presentAt(target);
    if (old.any && !old.file)
        CV_Error(Error::StsError, "Cannot write " + name + ": it is a folder, a device or a pipe");
    static std::atomic<int> counter(0);
    for (int attempt = 0; attempt < 100 && !stream; attempt++)  // the name may be in use
    {
        temporary = partOf(target, processId(), counter++);
        stream = create(temporary);
    }
    if (!stream)
        CV_Error(Error::StsError, "Cannot write " + name + ": check the folder and its rights");
    if (old.any)
        keepRights(stream, old.rights);
}

void WholeFile::write(const void* data, size_t size)
{
    if (size > 0)  // fwrite does not take a null pointer, even for 0 bytes
        std::fwrite(data, 1, size, stream);
}

[[noreturn]] static void cannotWrite(const String& name)
{
    CV_Error(Error::StsError, "Cannot write " + name + ": check the folder, its rights and the free space");
}

void WholeFile::finish()
{
    if (!stream)
        return;
    const bool good = !std::ferror(stream) && flushToDisk(stream), closed = std::fclose(stream) == 0;
    stream = 0;
    if (!good || !closed)
    {
        discard();
        cannotWrite(name);
    }
}

void WholeFile::commit()
{
    // first, since allocating may throw
    const size_t slash = target.rfind('/');
    const String folder = slash == String::npos ? String(".") : target.substr(0, slash + 1);
    finish();
    if (!replace(temporary, target, folder))
        cannotWrite(name);
    temporary.clear();
}

void WholeFile::discard()
{
    if (stream)
        std::fclose(stream);
    stream = 0;
    if (!temporary.empty())
        remove(temporary);
    temporary.clear();
}

bool isPartOf(const String& file, const String& name)
{
    const String begin = beginOf(file);
    int process = 0, number = 0;
    return name.compare(0, begin.size(), begin) == 0 &&
           std::sscanf(name.c_str() + begin.size(), ".%d-%d.tmp", &process, &number) == 2 &&
           name == partOf(file, process, number);
}

void writeText(const String& filename, const String& text)
{
    WholeFile file(filename);
    file.write(text.data(), text.size());
    file.commit();
}

void openToRead(std::filebuf& file, const String& name)
{
    if (presentAt(name).file)  // opening a pipe would wait for a writer
        open(file, name);
}

#ifdef _WIN32
FileLock::FileLock(const String& name, What what)
{
    const bool waits = what == LOCK_FILE;
    const String& path = waits ? name : name + ".lock";
    const Present there = presentAt(name);
    if (what == OUTPUT_FOLDER && (!there.any || there.file))
        CV_Error(Error::StsError, "Cannot write " + name + ": it is not a folder");
    while ((file = CreateFileW(systemName(path).c_str(), GENERIC_WRITE, 0, 0,
                    waits ? OPEN_ALWAYS : CREATE_NEW,
                    waits ? FILE_ATTRIBUTE_NORMAL : FILE_FLAG_DELETE_ON_CLOSE, 0)) == INVALID_HANDLE_VALUE)
    {
        const DWORD error = GetLastError();
        if (!waits && (error == ERROR_FILE_EXISTS || error == ERROR_ACCESS_DENIED))
            CV_Error(Error::StsError,
                    name + " is being written by another process: wait until it has ended; or remove " +
                            path);
        if (error != ERROR_SHARING_VIOLATION)
            CV_Error(Error::StsError, "Cannot write " + name + ": check the folder and its rights");
        Sleep(10);
    }
}

FileLock::~FileLock() { CloseHandle(file); }
#else
FileLock::FileLock(const String& name, What what)
{
    const bool waits = what == LOCK_FILE;
    const int flags = O_CLOEXEC | (waits ? 0 : O_NOFOLLOW) |
                      (what == OUTPUT_FOLDER ? O_RDONLY | O_DIRECTORY : O_RDWR | O_CREAT);
    // Repeated if another process removed or replaced the file between open() and flock().
    for (int times = 0; times < 100; times++)
    {
        file = ::open(name.c_str(), flags, 0666);
        if (file < 0 && errno == ENOENT && what == OUTPUT_FOLDER)
            CV_Error(Error::StsError, "Another process has removed " + name + " meanwhile: try again");
        int result = -1;
        while (file >= 0 && (result = flock(file, waits ? LOCK_EX : LOCK_EX | LOCK_NB)) != 0 &&
                errno == EINTR)
            continue;
        const bool busy = file >= 0 && result != 0 && errno == EWOULDBLOCK;
        bool gone = false;
        struct stat there, locked;
        if (result == 0 && fstat(file, &locked) == 0)
        {
            const bool found = stat(name.c_str(), &there) == 0;
            if (found && locked.st_dev == there.st_dev && locked.st_ino == there.st_ino)
                return;
            gone = found || errno == ENOENT;
        }
        if (file >= 0)
            close(file);
        if (busy)
            CV_Error(Error::StsError, name + " is being written by another process: wait until it has ended");
        if (!gone)
            CV_Error(Error::StsError, "Cannot write " + name + ": check the folder and its rights");
    }
    CV_Error(Error::StsError, "Other processes keep replacing " + name + ": wait until they have ended");
}

FileLock::~FileLock()
{
    // close() alone is not enough if the process was forked: the child has the same open file
    flock(file, LOCK_UN);
    close(file);
}
#endif

}}  // namespace cv::iib

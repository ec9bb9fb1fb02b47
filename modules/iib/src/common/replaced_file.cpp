// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#include "../precomp.hpp"
#include "replaced_file.hpp"

#include <atomic>

#include <sys/stat.h>
#ifdef _WIN32
#define NOMINMAX
#include <io.h>
#include <process.h>
#include <windows.h>
#else
#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>
#endif

namespace cv {
namespace iib {

namespace {

#ifdef _WIN32
int processId() { return _getpid(); }
String withoutLinks(const String& name) { return name; }
bool isRegular(const struct stat& status) { return (status.st_mode & _S_IFREG) != 0; }
void keepRights(std::FILE*, const struct stat&) {}
bool flushToDisk(std::FILE* file) { return std::fflush(file) == 0 && _commit(_fileno(file)) == 0; }
bool replace(const String& from, const String& to, const String&)
{
    return MoveFileExA(from.c_str(), to.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0;
}
#else
int processId() { return (int)getpid(); }

String withoutLinks(const String& name)
{
    char* const resolved = realpath(name.c_str(), 0);
    const String result = resolved ? resolved : name.c_str();
    std::free(resolved);
    return result;
}

bool isRegular(const struct stat& status) { return S_ISREG(status.st_mode); }

// Rights that cannot be kept are no reason to lose the data.
void keepRights(std::FILE* file, const struct stat& status)
{
    if (fchmod(fileno(file), status.st_mode & 07777) != 0)
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

}  // namespace

ReplacedFile::ReplacedFile(const String& filename) : name(filename), target(withoutLinks(filename)), stream(0)
{
    open();
    if (!stream)
        CV_Error(Error::StsError, "Cannot write " + name + ": check the folder and its rights");
}

void ReplacedFile::open()
{
    struct stat status;
    const bool exists = stat(target.c_str(), &status) == 0;
    if (exists && !isRegular(status))
    {
        stream = std::fopen(target.c_str(), "wb");
        return;
    }
    static std::atomic<int> counter(0);
    for (int attempt = 0; attempt < 100 && !stream; attempt++)  // another's name in use
    {
        temporary = format("%s.%d-%d.tmp", target.c_str(), processId(), counter++);
        stream = std::fopen(temporary.c_str(), "wbx");
    }
    if (stream && exists)
        keepRights(stream, status);
}

ReplacedFile::~ReplacedFile()
{
    if (!stream)
        return;
    std::fclose(stream);
    if (!temporary.empty())
        std::remove(temporary.c_str());
}

void ReplacedFile::write(const void* data, size_t size)
{
    if (size > 0)  // fwrite takes no null pointer, not even for nothing
        std::fwrite(data, 1, size, stream);
}

void ReplacedFile::commit()
{
    // Before anything is done, since memory may lack.
    const size_t slash = target.rfind('/');
    const String folder = slash == String::npos ? String(".") : target.substr(0, slash + 1);
    bool good = !std::ferror(stream);
    if (temporary.empty())
        good = std::fflush(stream) == 0 && good;
    else
        good = good && flushToDisk(stream);
    good = std::fclose(stream) == 0 && good;
    stream = 0;
    if (!temporary.empty() && !(good && replace(temporary, target, folder)))
    {
        std::remove(temporary.c_str());
        good = false;
    }
    if (!good)
        CV_Error(Error::StsError,
                "Cannot write " + name + ": check the folder, its rights and the free space");
}

}  // namespace iib
}  // namespace cv

// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

#ifndef OPENCV_IIB_DETAIL_FILES_HPP
#define OPENCV_IIB_DETAIL_FILES_HPP

#include "opencv2/core.hpp"

#include <cstdio>
#include <iosfwd>

namespace cv { namespace iib {

//! @cond IGNORED

// How this library, the modules beside it and the Python package write files.

//! A file's name in the system's encoding. Windows: read as UTF-8 or, if it is not valid UTF-8, in the code page.
#ifdef _WIN32
CV_EXPORTS std::wstring systemName(const String& name);
#else
inline const String& systemName(const String& name) { return name; }
#endif

//! The name. @throws cv::Exception for a zero byte, at which a C string would end.
inline const String& checkedName(const String& name)
{
    if (name.find('\0') != String::npos)
        CV_Error(Error::StsBadArg,
                format("the name of a file that begins with %s holds a zero byte", name.c_str()));
    return name;
}

//! The target of a symbolic link, even if nothing is there yet. @throws cv::Exception for a circle of links.
CV_EXPORTS String endOfLinks(const String& name);

/** Replaces a file at once: writes a temporary file beside it, flushes that to the disk, and renames it. Readers get the old
file or the new one. If anything fails, the old file stays. Symbolic links are followed. Folders, devices and pipes are
refused. */
class CV_EXPORTS WholeFile
{
public:
    //! @throws cv::Exception if the temporary file cannot be created.
    explicit WholeFile(const String& filename);
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;
    ~WholeFile() { discard(); }

    //! The name of the temporary file.
    const String& part() const { return temporary; }
    void write(const void* data, size_t size);
    //! Flushes the file to the disk, so that commit() only renames it. @throws cv::Exception if any write failed; the
    //! temporary file is removed then.
    void finish();
    //! Calls finish() and renames the file. @throws cv::Exception if any write failed.
    void commit();
    //! Removes the temporary file.
    void discard();

private:
    String name;    //!< as given, for errors
    String target;  //!< with links resolved
    String temporary;
    std::FILE* stream;
};

//! Whether `name` is that of a temporary WholeFile of `file`.
CV_EXPORTS bool isPartOf(const String& file, const String& name);

//! Writes a text as a WholeFile.
CV_EXPORTS void writeText(const String& filename, const String& text);

/** Algorithm::save(), but atomic: OpenCV's own leaves half a file on a full disk. @param name of the node around the output
 of write(); empty: no node. */
inline void saveWhole(const Algorithm& algorithm, const String& filename, const String& name = String())
{
    if (filename.size() > 3 && filename.compare(filename.size() - 3, 3, ".gz") == 0)
        CV_Error(Error::StsBadArg,
                "Cannot write " + filename +
                        ": compressed files are not supported; end its name in .yml, .xml or .json");
    FileStorage fs(filename, FileStorage::WRITE + FileStorage::MEMORY);
    CV_Assert(fs.isOpened());
    if (!name.empty())
        fs << name << "{";
    algorithm.write(fs);
    if (!name.empty())
        fs << "}";
    writeText(filename, fs.releaseAndGetString());
}

//! Opens a regular file; leaves `file` closed for anything else.
void openToRead(std::filebuf& file, const String& name);

#ifndef OPENCV_BINDING_PARSER  // the enumeration is not for Python
//! A lock among processes and threads until the end of the object. A killed process loses its lock.
class CV_EXPORTS FileLock
{
public:
    //! The constructor waits for LOCK_FILE and throws for the others if another process holds the lock. On Windows, the
    //! lock of an output is a file NAME.lock beside it, which is removed with the lock.
    enum What
    {
        LOCK_FILE,     //!< created if it is missing, and kept
        OUTPUT_FILE,   //!< created if it is missing, except on Windows
        OUTPUT_FOLDER  //!< never created: another process may have removed it
    };
    //! @throws cv::Exception if it cannot be locked.
    FileLock(const String& name, What what);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
#ifdef _WIN32
    void* file;
#else
    int file;
#endif
};
#endif

//! @endcond

}}  // namespace cv::iib

#endif

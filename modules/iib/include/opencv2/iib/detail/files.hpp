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

// For this library, the modules beside it and the Python package: whoever writes files does it by these.

//! A file's name as the system takes it. Windows: from UTF-8, as Python has it, else from the code page.
#ifdef _WIN32
CV_EXPORTS std::wstring systemName(const String& name);
#else
inline const String& systemName(const String& name) { return name; }
#endif

//! The name. @throws cv::Exception for one with a zero byte: who opens it by a C string would open another file.
inline const String& checkedName(const String& name)
{
    if (name.find('\0') != String::npos)
        CV_Error(Error::StsBadArg,
                format("the name of a file that begins with %s holds a zero byte", name.c_str()));
    return name;
}

//! Where open() finds or makes a file: at the end of links. @throws cv::Exception if they lead in a circle.
CV_EXPORTS String endOfLinks(const String& name);

/** A file that takes the place of another when it is whole: written beside it by a name that nothing has, flushed to the
disk, renamed. The old one stays as it is until commit(), and if anything fails: who reads meanwhile gets one or the other. A
symbolic link is followed, also if nothing is at its end yet. What is no regular file is refused: a folder, a device, a pipe. */
class CV_EXPORTS WholeFile
{
public:
    //! @throws cv::Exception if it cannot be made.
    explicit WholeFile(const String& filename);
    WholeFile(const WholeFile&) = delete;
    WholeFile& operator=(const WholeFile&) = delete;
    ~WholeFile() { discard(); }

    //! Where it is until commit(), for who writes by names.
    const String& part() const { return temporary; }
    void write(const void* data, size_t size);
    //! Puts what was written on the disk, so that commit() has only to rename, as of several files. Nothing is
    //! written after it. @throws cv::Exception if any write failed; the file is discarded then.
    void finish();
    //! Puts the file in its place, once it is on the disk. @throws cv::Exception if any write failed.
    void commit();
    //! Removes what was not committed.
    void discard();

private:
    String name;    //!< as given, for errors
    String target;  //!< with links resolved
    String temporary;
    std::FILE* stream;
};

//! Whether a name in a folder is that of a WholeFile of another one, which a killed process has left.
CV_EXPORTS bool isPartOf(const String& file, const String& name);

//! Writes a file as a WholeFile.
CV_EXPORTS void writeText(const String& filename, const String& text);

//! Opens a file, if it is a regular one.
void openToRead(std::filebuf& file, const String& name);

#ifndef OPENCV_BINDING_PARSER  // its numbers are nothing for Python
//! Holds a lock among processes and threads to its end. The system gives the lock of a killed process back.
class CV_EXPORTS FileLock
{
public:
    //! The last two are refused while another holds their lock (Windows: by a file NAME.lock beside it, which goes with the lock).
    enum What
    {
        LOCK_FILE,     //!< made for the lock if it is missing, and stays; its lock is waited for
        OUTPUT_FILE,   //!< made if it is missing, but on Windows
        OUTPUT_FOLDER  //!< never made: another process may have removed it meanwhile
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

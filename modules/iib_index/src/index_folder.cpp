// SPDX-License-Identifier: Apache-2.0
#include "precomp.hpp"
#include "index_folder.hpp"

#include "opencv2/core/utils/filesystem.hpp"

#include <cstdio>

namespace cv {
namespace iib {

static const char *const MANIFEST = "manifest.iib", *const SEGMENT = "segment-%06llu.iib",
                         *const LOCK = "lock";

String manifestOf(const String& folder) { return folder + "/" + MANIFEST; }

String segmentOf(const String& folder, uint64 number)
{
    return folder + "/" + format(SEGMENT, (unsigned long long)number);
}

String lockOf(const String& folder) { return folder + "/" + LOCK; }

// CheckedWriter writes NAME.PROCESS-NUMBER.tmp. Formatted again, the numbers have to give the same name.
static bool isUnfinished(const String& name)
{
    const size_t end = name.find(".iib.");
    if (end == String::npos)
        return false;
    const String target = name.substr(0, end + 4), rest = name.substr(end + 4);
    int process = 0, number = 0;
    unsigned long long segment = 0;
    std::sscanf(rest.c_str(), ".%d-%d.tmp", &process, &number);
    std::sscanf(target.c_str(), "segment-%llu.iib", &segment);
    return rest == format(".%d-%d.tmp", process, number) &&
           (target == MANIFEST || target == format(SEGMENT, segment));
}

void checkEmpty(const String& folder)
{
    std::vector<String> names;
    utils::fs::glob_relative(folder, String(), names, false, true);
    for (const String& name : names)
    {
        if (name == MANIFEST)
            CV_Error(Error::StsBadArg, folder + " holds an index already: open it, or take another folder");
        if (name != LOCK && !isUnfinished(name))
            CV_Error(Error::StsBadArg, folder + " is not empty, it holds " + name + ": take an empty folder");
    }
}

void removeUnfinished(const String& folder)
{
    std::vector<String> names;
    utils::fs::glob_relative(folder, String(), names);
    for (const String& name : names)
        if (isUnfinished(name))
            std::remove((folder + "/" + name).c_str());
}

}  // namespace iib
}  // namespace cv

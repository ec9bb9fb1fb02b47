// SPDX-License-Identifier: Apache-2.0

#include "arrays.hpp"
#include "bindings.hpp"

#include <set>

#include "opencv2/iib/detail/files.hpp"
#include "opencv2/iib/detail/output_folder.hpp"

namespace iib_python {

using cv::iib::FileLock;
using cv::iib::OutputFolder;
using cv::iib::WholeFile;

//! @param own names of files that the folder may contain.
static void makeFolder(OutputFolder* self, nb::handle path, const std::vector<nb::bytes>& own)
{
    std::set<std::string> names;
    for (const nb::bytes& each : own)
        names.emplace(each.c_str(), each.size());
    new (self) OutputFolder(pathOf(path), [&](const std::string& name) { return names.count(name) != 0; });
}

void bindFiles(nb::module_& m)
{
    nb::class_<WholeFile>(m, "WholeFile")
            .def("__init__", [](WholeFile* self, nb::handle path) { new (self) WholeFile(pathOf(path)); })
            .def_prop_ro("part",
                    [](const WholeFile& self) { return nb::bytes(self.part().data(), self.part().size()); })
            .def("commit", &WholeFile::commit, WithoutGil())
            .def("discard", &WholeFile::discard);
    nb::class_<FileLock>(m, "FileLock").def("__init__", [](FileLock* self, nb::handle path, bool isFolder) {
        new (self) FileLock(pathOf(path), isFolder ? FileLock::OUTPUT_FOLDER : FileLock::OUTPUT_FILE);
    });
    nb::class_<OutputFolder>(m, "OutputFolder").def("__init__", &makeFolder);
}

}  // namespace iib_python

// SPDX-License-Identifier: Apache-2.0

// Runs a fuzz target on files, for compilers without libFuzzer: replay FILE_OR_FOLDER...

#include "byte_source.hpp"

#include "opencv2/core/utils/filesystem.hpp"

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

int main(int argc, char** argv)
{
    std::vector<cv::String> files;
    for (int i = 1; i < argc; i++)
        if (cv::utils::fs::isDirectory(argv[i]))
            cv::utils::fs::glob(argv[i], "*", files);
        else
            files.push_back(argv[i]);
    for (const cv::String& file : files)
    {
        std::ifstream in(file.c_str(), std::ios::binary);
        const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
        std::printf("%s: %d bytes\n", file.c_str(), (int)bytes.size());
        std::fflush(stdout);
        LLVMFuzzerTestOneInput((const uchar*)bytes.data(), bytes.size());
    }
    return files.empty() ? 1 : 0;
}

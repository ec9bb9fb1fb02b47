// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "opencv2/core.hpp"
#include "opencv2/core/utility.hpp"

namespace iib_tools {

/** Parses a command line with the keys, defaults and help of cv::CommandLineParser. Adds positional arguments between
options, `--name value` beside `--name=value`, repeated options, and errors for unknown options. */
class CommandLine
{
public:
    /** @param keys options in the format of cv::CommandLineParser. An option with an empty default is a switch; every
    other option takes a value, and `<none>` means no default. `help` (`-h`) is added.
    @throws cv::Exception, code StsBadArg, for an unknown option, and a missing or unexpected value. */
    CommandLine(int argc, const char* const* argv, const std::string& about, const std::string& keys)
        : parser_(1, argv, "{help||prints this, as -h}" + keys)
    {
        parser_.about(about);
        const std::string known = "{help||}" + keys;
        for (int i = 1; i < argc; i++)
        {
            const std::string word = argv[i];
            if (word.size() < 2 || word[0] != '-')
            {
                positional_.push_back(word);
                continue;
            }
            const size_t equals = word.find('='), none = std::string::npos;
            const std::string given = word.substr(0, equals),
                              name = given == "-h" ? "help" : given.substr(given[1] == '-' ? 2 : 1);
            const size_t key = std::min(known.find("{" + name + " "), known.find("{" + name + "|"));
            if (key == none)
                CV_Error(cv::Error::StsBadArg, "unknown option " + given + " (--help lists them)");
            const bool isSwitch = known[known.find_first_not_of(' ', known.find('|', key) + 1)] == '|';
            if (isSwitch && equals != none)
                CV_Error(cv::Error::StsBadArg, "option " + given + " takes no value");
            values_[name].push_back(isSwitch         ? "true"
                                    : equals != none ? word.substr(equals + 1)
                                    : ++i < argc     ? argv[i]
                                                     : "");
            if (values_[name].back().empty())
                CV_Error(cv::Error::StsBadArg, "option " + given + " needs a value");
        }
    }

    const std::vector<std::string>& positional() const { return positional_; }

    //! Whether a switch is set, or an option has a value or a default.
    bool has(const std::string& name) const { return values_.count(name) || parser_.has(name); }

    //! The last value of an option, or its default; empty without either.
    std::string text(const std::string& name) const
    {
        return values_.count(name) ? values_.at(name).back() : parser_.get<std::string>(name);
    }

    //! All values of a repeatable option, without its default.
    std::vector<std::string> all(const std::string& name) const
    {
        return values_.count(name) ? values_.at(name) : std::vector<std::string>();
    }

    //! A number from low to high. @throws cv::Exception, code StsBadArg, for anything else.
    double number(const std::string& name, double low, double high) const
    {
        const std::string value = text(name);
        char* end = nullptr;
        const double n = std::strtod(value.c_str(), &end);
        if (value.empty() || *end != '\0' || !(n >= low && n <= high))
            CV_Error(cv::Error::StsBadArg, cv::format("--%s=%s: not a number from %g to %g", name.c_str(),
                                                   value.c_str(), low, high));
        return n;
    }

    //! A whole number from low to high. @throws cv::Exception, code StsBadArg, for anything else.
    int whole(const std::string& name, int low, int high) const
    {
        const double n = number(name, low, high);
        if (n != std::floor(n))
            CV_Error(cv::Error::StsBadArg,
                    cv::format("--%s=%s: not a whole number", name.c_str(), text(name).c_str()));
        return int(n);
    }

    //! Prints the help to standard output.
    void printHelp() const { parser_.printMessage(); }

private:
    cv::CommandLineParser parser_;
    std::vector<std::string> positional_;
    std::map<std::string, std::vector<std::string>> values_;  // by option
};

/** The main() of a tool. Returns the result of `run`, or 0 for `--help`, 2 for a wrong command line and 1 for any other
exception. Errors are one line on stderr.
@param about purpose of the program and its positional arguments. */
inline int runTool(int argc, const char* const* argv, const std::string& about, const std::string& keys,
        const std::function<int(const CommandLine&)>& run)
{
    try
    {
        const CommandLine line(argc, argv, about, keys);
        if (!line.has("help"))
            return run(line);
        line.printHelp();
        return 0;
    }
    catch (const std::exception& e)  // includes errors of std::filesystem
    {
        const std::string path = argc > 0 ? argv[0] : "";
        const auto* const ours = dynamic_cast<const cv::Exception*>(&e);
        std::fprintf(stderr, "%s: %s\n", path.substr(path.find_last_of('/') + 1).c_str(),
                ours ? ours->err.c_str() : e.what());
        return ours && ours->code == cv::Error::StsBadArg ? 2 : 1;
    }
}

}  // namespace iib_tools

#!/usr/bin/python3
"""Mutation testing: builds the library once with all mutants of mutants.txt, then switches on one at a time and runs the tests of
its area. An area is a folder of modules/iib/test, another module, or MODULE/NAME for its test_NAME.cpp. A mutant that no test
notices is a survivor. Mutants of code that needs another processor are skipped.

mutate.py --source REPOSITORY --work FOLDER [--only NAME...]
mutate.py --source REPOSITORY --check

A mutant replaces an expression by a wrong one. In a copy of the source both are in IIB_MUTANT(number, right, wrong), and the
environment variable IIB_MUTANT chooses at run time.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

# A constant in each source file, since a function call would slow down inner loops.
HEADER = """#pragma once
#include <cstdlib>
namespace {
const int iibChosenMutant = std::getenv("IIB_MUTANT") ? std::atoi(std::getenv("IIB_MUTANT")) : 0;
}
#define IIB_MUTANT(number, right, wrong) (iibChosenMutant == (number) ? (wrong) : (right))
"""


def pattern(code):
    """A regular expression that finds code with any spaces and line breaks."""
    return r"\s*".join(re.escape(token) for token in re.findall(r"\w+|\S", code))


class Mutant:
    """One line of mutants.txt; the tests of `area` must notice it. `sources`: the text of every source, by path; the mutant's
    source is the one that holds its code."""

    def __init__(self, number, line, area, sources):
        fields = re.fullmatch(r"(\S+): (.*)\{\{(.+) => (.+)\}\}(.*)", line)
        if not fields:
            sys.exit(f"mutants.txt: '{line}' is not NAME: code {{{{right => wrong}}}} code")
        self.name, before, right, self.wrong, after = fields.groups()
        self.number, (self.area, _, self.flag) = number, area.partition(" ")
        self.code = re.compile(r"(\s*)".join(f"({pattern(part)})" for part in (before, right, after)))
        found = [path for path, text in sources.items() for _ in self.code.finditer(text)]
        if len(found) != 1:
            sys.exit(f"{self.name}: its code is in the sources {len(found)} times, not once: update mutants.txt")
        self.path, = found

    def applied(self, text):
        """The source `text` with the switch around the right code."""
        text, count = self.code.subn(
            lambda found: f"{found[1]}{found[2]}IIB_MUTANT({self.number}, {found[3]}, {self.wrong}){found[4]}{found[5]}", text)
        if count != 1:
            sys.exit(f"{self.name}: another mutant changes the same code")
        return text


def read_sources(repository):
    return {str(path.relative_to(repository)): path.read_text()
            for path in sorted(repository.glob("modules/*/src/**/*.?pp")) if ".generated." not in path.name}


def read_mutants(path, sources):
    """Mutants `NAME: code {{right => wrong}} code`, one a line, below `[AREA]`, or `[AREA FLAG]` if only processors with
    this flag run the code."""
    mutants, area = [], None
    for line in path.read_text().splitlines():
        if line.startswith("["):
            area = line.strip("[]")
        elif line and not line.startswith("#"):
            mutants.append(Mutant(len(mutants) + 1, line, area, sources))
    return mutants


def write_if_changed(path, content):
    """Keeps the time of an unchanged file, so that it is not compiled again."""
    if not path.is_file() or path.read_bytes() != content:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def switched(sources, mutants):
    """The text of the sources with the switches of all mutants, by path."""
    content = {}
    for mutant in mutants:
        content[mutant.path] = mutant.applied(content.get(mutant.path, sources[mutant.path]))
    return content


def copy_source(repository, changed, target):
    """Copies the repository's files, with the texts of the `changed` ones."""
    command = ["git", "-C", repository, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.check_output(command).decode().split("\0")
    content = {name: (repository / name).read_bytes() for name in listed if (repository / name).is_file()}
    content["mutation.hpp"] = HEADER.encode()
    for path, text in changed.items():
        content[path] = text.encode()
    for old in target.rglob("*"):
        if old.is_file() and str(old.relative_to(target)) not in content:
            old.unlink()
    for name, text in content.items():
        write_if_changed(target / name, text)
        if (repository / name).is_file():
            shutil.copymode(repository / name, target / name)


def tests_of(area):
    """The module and the files of the tests of `area`."""
    module, _, name = area.partition("/")
    return (module, f"test_{name or '*'}.cpp") if module.startswith("iib_") else ("iib", f"{area}/*.cpp")


def suites(source, area):
    """A GoogleTest filter for the test suites of `area`."""
    names = set()
    module, files = tests_of(area)
    for path in sorted((source / "modules" / module / "test").rglob(files)):
        text = path.read_text()
        names |= set(re.findall(r"^TEST(?:_P|_F)?\((\w+),", text, re.MULTILINE))
    if not names:
        sys.exit(f"there are no tests of {area}")
    return ":".join(f"{name}.*:*/{name}.*" for name in sorted(names))


def run_tests(program, suites, number, timeout):
    """Whether all tests of the suites pass, with all instruction sets and without the wide ones, whose kernels differ.
    A crash, an abort or a timeout counts as noticed."""
    for off in ("", "AVX512-SKX,AVX512-ICL", "AVX2,AVX512-SKX,AVX512-ICL"):
        environment = dict(os.environ, IIB_MUTANT=str(number), OPENCV_CPU_DISABLE=off)
        environment.pop("OPENCV_TEST_DATA_PATH", None)  # tests on photographs are slow, and not every machine has them
        try:
            run = subprocess.run([program, f"--gtest_filter={suites}", "--gtest_break_on_failure"], env=environment,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=timeout)
        except subprocess.TimeoutExpired:
            return False
        if run.returncode != 0:
            return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--source", type=pathlib.Path, required=True, help="the repository")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--work", type=pathlib.Path, help="folder for the copy and its build")
    what.add_argument("--check", action="store_true", help="only check that each mutant's code is in the sources once, and has tests")
    parser.add_argument("--only", nargs="*", default=[], help="names of mutants; all by default")
    options = parser.parse_args()

    sources = read_sources(options.source)
    mutants = read_mutants(pathlib.Path(__file__).with_name("mutants.txt"), sources)
    unknown = set(options.only) - {m.name for m in mutants}
    if unknown:
        sys.exit(f"no such mutants: {', '.join(sorted(unknown))}")
    changed = switched(sources, mutants)
    for area in {mutant.area for mutant in mutants}:
        suites(options.source, area)
    if options.check:
        return 0
    source, build = options.work / "source", options.work / "build"
    copy_source(options.source, changed, source)
    subprocess.check_call(["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DIIB_BUILD_TOOLS=OFF",
                           f"-DCMAKE_CXX_FLAGS=-include {source / 'mutation.hpp'}"], stdout=subprocess.DEVNULL)
    modules = sorted({tests_of(mutant.area)[0] for mutant in mutants})
    subprocess.check_call(["cmake", "--build", build, "--target", *(f"opencv_test_{module}" for module in modules)])

    chosen = [m for m in mutants if not options.only or m.name in options.only]
    flags = pathlib.Path("/proc/cpuinfo").read_text().split()
    for mutant in chosen:
        if mutant.flag and mutant.flag not in flags:
            print(f"== skipped: {mutant.name}: this processor has no {mutant.flag}")
    chosen = [m for m in chosen if not m.flag or m.flag in flags]
    programs, filters, limits = {}, {}, {}
    for area in sorted({m.area for m in chosen}):
        started = time.monotonic()
        programs[area] = build / f"opencv_test_{tests_of(area)[0]}"
        filters[area] = suites(source, area)
        if not run_tests(programs[area], filters[area], 0, 3600):
            sys.exit(f"the tests of {area} fail without any mutant")
        limits[area] = 60 + 5 * (time.monotonic() - started)

    def survives(mutant):
        result = run_tests(programs[mutant.area], filters[mutant.area], mutant.number, limits[mutant.area])
        print(f"{'SURVIVED' if result else 'noticed '} {mutant.name} ({mutant.path})", flush=True)
        return result

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        survivors = [mutant.name for mutant, survived in zip(chosen, pool.map(survives, chosen)) if survived]
    print(f"{len(chosen) - len(survivors)} of {len(chosen)} mutants noticed")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())

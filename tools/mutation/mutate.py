#!/usr/bin/python3
"""Mutation testing: builds the library once with every mutant of mutants.txt switched off, then runs the tests with
one of them switched on at a time. A mutant that no test notices is a survivor.

mutate.py --source REPOSITORY --work FOLDER [--only NAME...]

A mutant is an expression of the source with a wrong one beside it. In a copy of the source both stand in
IIB_MUTANT(number, right, wrong), and the environment variable IIB_MUTANT chooses at run time.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

HEADER = """#pragma once
#include <cstdlib>
namespace iib_mutation {
inline int chosen()
{
    static const int number = std::getenv("IIB_MUTANT") ? std::atoi(std::getenv("IIB_MUTANT")) : 0;
    return number;
}
}
#define IIB_MUTANT(number, right, wrong) (iib_mutation::chosen() == (number) ? (wrong) : (right))
"""


class Mutant:
    def __init__(self, number, name, path, context, right, wrong):
        self.number, self.name, self.path = number, name, path
        self.context, self.right, self.wrong = context, right, wrong

    def apply(self, source):
        """Puts the switch around `right` within the line that holds `context`."""
        text = (source / self.path).read_text()
        if text.count(self.context) != 1:
            sys.exit(f"{self.name}: {self.path} holds '{self.context}' {text.count(self.context)} times, not once: "
                     "bring mutants.txt up to date")
        if self.context.count(self.right) != 1:
            sys.exit(f"{self.name}: '{self.right}' is not there once in its context")
        switch = f"IIB_MUTANT({self.number}, {self.right}, {self.wrong})"
        text = text.replace(self.context, self.context.replace(self.right, switch))
        (source / self.path).write_text(text)


def read_mutants(path):
    """Blocks of lines `name: ...`, `file: ...`, `in: ...`, `right: ...`, `wrong: ...`."""
    mutants = []
    for block in re.split(r"\n\s*\n", path.read_text()):
        lines = [line for line in block.splitlines() if line and not line.startswith("#")]
        if not lines:
            continue
        fields = dict(line.split(": ", 1) for line in lines)
        mutants.append(Mutant(len(mutants) + 1, fields["name"], fields["file"], fields["in"], fields["right"],
                              fields["wrong"]))
    return mutants


def copy_source(repository, target):
    shutil.rmtree(target, ignore_errors=True)
    files = subprocess.check_output(["git", "-C", repository, "ls-files", "-z"]).decode().split("\0")
    for name in filter(None, files):
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(repository / name, target / name)


def run_tests(program, number, timeout):
    """Whether every test passes, with all instruction sets and without the wide ones, whose kernels differ. A crash,
    an abort or a hang counts as noticed."""
    for off in ("", "AVX512-SKX,AVX512-ICL", "AVX2,AVX512-SKX,AVX512-ICL"):
        environment = dict(os.environ, IIB_MUTANT=str(number), OPENCV_CPU_DISABLE=off)
        try:
            run = subprocess.run([program, "--gtest_break_on_failure"], env=environment, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL, timeout=timeout)
        except subprocess.TimeoutExpired:
            return False
        if run.returncode != 0:
            return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--source", type=pathlib.Path, required=True, help="the repository")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the copy and its build")
    parser.add_argument("--only", nargs="*", default=[], help="names of mutants; all by default")
    options = parser.parse_args()

    mutants = read_mutants(pathlib.Path(__file__).with_name("mutants.txt"))
    unknown = set(options.only) - {m.name for m in mutants}
    if unknown:
        sys.exit(f"no such mutants: {', '.join(sorted(unknown))}")
    source, build = options.work / "source", options.work / "build"
    copy_source(options.source, source)
    header = source / "mutation.hpp"
    header.write_text(HEADER)
    for mutant in mutants:
        mutant.apply(source)
    subprocess.check_call(["cmake", "-S", source, "-B", build, "-G", "Ninja", "-DIIB_BUILD_TOOLS=OFF",
                           f"-DCMAKE_CXX_FLAGS=-include {header}"], stdout=subprocess.DEVNULL)
    subprocess.check_call(["cmake", "--build", build, "--target", "opencv_test_iib"])

    program = build / "opencv_test_iib"
    started = time.monotonic()
    if not run_tests(program, 0, 3600):
        sys.exit("the tests fail without any mutant")
    timeout = 60 + 5 * (time.monotonic() - started)
    chosen = [m for m in mutants if not options.only or m.name in options.only]
    survivors = []
    for mutant in chosen:
        survives = run_tests(program, mutant.number, timeout)
        print(f"{'SURVIVED' if survives else 'noticed '} {mutant.name} ({mutant.path})", flush=True)
        if survives:
            survivors.append(mutant.name)
    print(f"{len(chosen) - len(survivors)} of {len(chosen)} mutants noticed")
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())

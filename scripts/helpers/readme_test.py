#!/usr/bin/env python3
"""Builds the programs of README.md, doc/install.md and the tutorials against an installation, with CMake and pkg-config, and runs them:
readme_test.py BUILD COMPILER FLAGS GENERATOR"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAIR = [str(ROOT / 'tools/synthetic' / name) for name in ('day.png', 'night.png')]
# Program: arguments and output. The last program's query is its first image, so every point finds itself.
TUTORIALS = {'day_night': (PAIR, r'\d\d+ of \d+ matches agree with\n.*'),
             'relative_pose': ([*PAIR, '700', 'pose.png'], r'\d\d+ of \d+ matches agree with\n.*'),
             'presets': ([], "128 bytes, 22.5 times the keypoint's size\n64 bytes, 22.5 times the keypoint's size\n"),
             'localization': (None, ''),
             'saving_index': ([PAIR[0], *PAIR], r'1000 matches in [^\n]*day.png\n0 matches in [^\n]*night.png\n')}
INDEX = '''#include <opencv2/iib_index.hpp>
int main(int, char** arguments)
{
    cv::iib::MappedIndex::create(arguments[1], {8})->add(cv::Mat(3, 8, CV_8U, cv::Scalar(1)));
    return cv::iib::MappedIndex::open(arguments[1])->rows() == 3 ? 0 : 1;
}
'''
LOCALIZER = '''#include <opencv2/iib_geometry.hpp>
#include <iostream>
int main(int, char** arguments)
{
    try
    {
        const cv::iib::Camera camera = cv::iib::Camera::parse("PINHOLE,640,480,500,500,320,240");
        cv::iib::Localizer(arguments[1]).localize(cv::Mat(camera.size, CV_8U), camera);
    }
    catch (const cv::Exception& e)
    {
        std::cout << e.err;
    }
}
'''
build, (compiler, flags, generator) = os.path.abspath(sys.argv[1]), sys.argv[2:]


def block(page, language, pattern):
    """The first block of a language that contains a text."""
    found = re.findall(r'^```%s\n(.*?)^```$' % language, (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)
    return next(text for text in found if pattern in text)


def run(*command, code=0, prints=None):
    """Runs a command, and checks its exit status and output. :return: its output."""
    print(shlex.join(map(str, command)), flush=True)
    done = subprocess.run(list(map(str, command)), cwd=work, capture_output=True, text=True)
    if done.returncode != code or prints is not None and not re.fullmatch(prints, done.stdout, re.DOTALL):
        sys.exit('%s, exit code %d:\n%s%s' % (command[0], done.returncode, done.stdout, done.stderr))
    return done.stdout + done.stderr


def match(program):
    """Runs doc/install.md's program with the pair, and with unreadable images."""
    run(program, *PAIR, prints=r'[1-9]\d* matches\n')
    for arguments in (['no-such-image.png', PAIR[1]], [PAIR[0], 'no-such-image.png'], []):
        run(program, *arguments, code=1, prints='0 matches\n')


def configure(project, name, *options, code=0):
    return run('cmake', '-G', generator, '-S', project, '-B', work / name, '-DCMAKE_PREFIX_PATH=%s' % prefix,
               '-DCMAKE_CXX_COMPILER=' + compiler, '-DCMAKE_CXX_FLAGS=' + flags, *options, code=code)


def compile_(source, text, *options):
    (work / source).write_text(text)
    run(compiler, *shlex.split(flags), '-std=c++11', source, *packaged, *(options or ('-o', pathlib.Path(source).stem)))


with tempfile.TemporaryDirectory(prefix='a folder ') as name:  # paths with blanks must work
    work = pathlib.Path(name)
    project, prefix = work / 'project', work / 'prefix'
    project.mkdir()
    (project / 'CMakeLists.txt').write_text(block('doc/install.md', 'cmake', 'project(') + '''
add_executable(index index.cpp)
target_link_libraries(index opencv_iib_index)
''')
    (project / 'match_pair.cpp').write_text(block('doc/install.md', 'cpp', 'int main'))
    (project / 'index.cpp').write_text(INDEX)
    run('cmake', '--install', build, '--prefix', prefix)
    configure(project, 'by cmake')
    run('cmake', '--build', work / 'by cmake')
    match(work / 'by cmake/match_pair')
    run(work / 'by cmake/index', 'codes by cmake')

    os.environ['PKG_CONFIG_PATH'] = str(next(prefix.rglob('opencv_iib.pc')).parent)
    packaged = shlex.split(run('pkg-config', '--cflags', '--libs', 'opencv_iib'))
    compile_('match_pair.cpp', block('doc/install.md', 'cpp', 'int main'))
    match(work / 'match_pair')
    compile_('index.cpp', INDEX)
    run(work / 'index', 'codes by pkg-config')
    for page in ('doc/guide.md', 'README.md'):
        fragment = block(page, 'cpp', 'BFMatcher::create')
        compile_('fragment.cpp', '#include <opencv2/iib.hpp>\nvoid fragment();\nvoid fragment()\n{\n%s}\n' % fragment, '-fsyntax-only')
    for name, (arguments, printed) in TUTORIALS.items():
        page, = ROOT.glob('modules/*/tutorials/iib_%s.markdown' % name)
        compile_(name + '.cpp', block(page, 'cpp', 'int main'))
        if arguments is not None:
            run(work / name, *arguments, prints=printed)
    if not (work / 'pose.png').exists():
        sys.exit('relative_pose writes no picture')

    # The errors of iib_geometry, if it was built, say what is wrong.
    if (prefix / 'include/opencv4/opencv2/iib/localization.hpp').exists():
        (work / 'localizer').mkdir()
        (work / 'localizer/localizer.cpp').write_text(LOCALIZER)
        (work / 'localizer/align.cpp').write_text(block('modules/iib_geometry/tutorials/iib_align.markdown', 'cpp', 'int main'))
        (work / 'localizer/CMakeLists.txt').write_text('''cmake_minimum_required(VERSION 3.16)
project(localizer CXX)
find_package(opencv_iib REQUIRED COMPONENTS geometry)
find_package(OpenCV REQUIRED COMPONENTS imgcodecs imgproc)
add_executable(localizer localizer.cpp)
add_executable(align align.cpp)
target_link_libraries(localizer opencv_iib_geometry)
target_link_libraries(align opencv_iib_geometry opencv_imgcodecs opencv_imgproc)
''')
        configure(work / 'localizer', 'localizer by cmake')
        run('cmake', '--build', work / 'localizer by cmake')
        run(work / 'localizer by cmake/align', *PAIR, 'aligned.png', prints=r'\d\d+ matches agree; .*\n')
        run(work / 'localizer by cmake/localizer', 'nowhere', prints='nowhere is no map: it has no map.iib')

    # The version is CMakeLists.txt's. Minor versions may be incompatible, so a program that asks for another one is refused.
    major, minor, patch = map(int, re.search(r'project\(opencv_iib VERSION (\d+)\.(\d+)\.(\d+)', (ROOT / 'CMakeLists.txt').read_text()).groups())
    run('pkg-config', '--modversion', 'opencv_iib', prints='%d[.]%d[.]%d\n' % (major, minor, patch))
    asked = {'%d.%d' % (major, minor): 1, '%d.%d.%d' % (major, minor, patch): 1, '%d.%d.%d' % (major, minor, patch + 1): 0,
             '%d.%d' % (major, minor + 1): 0, '%d.%d' % (major, max(minor - 1, 0)): int(not minor), '%d.0' % (major + 1): 0}
    (work / 'versions').mkdir()
    (work / 'versions/CMakeLists.txt').write_text('cmake_minimum_required(VERSION 3.16)\nproject(versions CXX)\n' + ''.join(
        'find_package(opencv_iib %s QUIET)\nmessage(STATUS "asked for %s: ${opencv_iib_FOUND} ${opencv_iib_VERSION}")\n' % (one, one)
        for one in asked))
    answers = dict(re.findall(r'asked for (\S+): (\d)', configure(work / 'versions', 'by version')))
    if answers != {one: str(found) for one, found in asked.items()}:
        sys.exit('versions of the CMake package: expected %s, got %s' % (asked, answers))

    # An OpenCV of another minor version is refused, and the message says why.
    (work / 'other').mkdir()
    (work / 'other/OpenCVConfig.cmake').write_text('set(OpenCV_VERSION 4.99.0)\n')
    (work / 'other/OpenCVConfigVersion.cmake').write_text('set(PACKAGE_VERSION 4.99.0)\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n')
    refused = configure(project, 'by other', '-DOpenCV_DIR=%s' % (work / 'other'), code=1)
    if not re.search(r'was built with OpenCV [0-9.]+, but .* holds OpenCV 4\.99\.0', ' '.join(refused.split())):
        sys.exit('with OpenCV 4.99: ' + refused)

# Installs BUILD into a new prefix, takes the CMake project and the C++ programs out of README.md and the tutorials as they stand there,
# builds them against the installed package, by CMake and by pkg-config, and runs the program.
# cmake -DBUILD=<build folder> -DWORK=<scratch folder> -DCXX=<compiler> -DFLAGS=<flags>
#   -DGENERATOR=<CMake generator> -P ReadmeTest.cmake
file(REMOVE_RECURSE "${WORK}")
# Paths with spaces must do.
set(project "${WORK}/a project")
set(prefix "${WORK}/a prefix")
get_filename_component(root "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
set(synthetic "${root}/tools/synthetic")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(run_program program)
  execute_process(COMMAND "${program}" "${synthetic}/day.png" "${synthetic}/night.png"
    OUTPUT_VARIABLE output ECHO_OUTPUT_VARIABLE COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "^[1-9][0-9]* matches\n$")
    message(FATAL_ERROR "${program} does not match the pair")
  endif()
  foreach(arguments "no-such-image.png;${synthetic}/night.png" "${synthetic}/day.png;no-such-image.png" "")
    execute_process(COMMAND "${program}" ${arguments} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_QUIET)
    if(NOT code EQUAL 1 OR NOT output STREQUAL "0 matches\n")
      message(FATAL_ERROR "${program} ${arguments}: exit code ${code}, output '${output}'")
    endif()
  endforeach()
endfunction()

# The first block of a language in a page that matches a pattern.
function(code_block page language pattern out)
  file(READ "${root}/${page}" text)
  string(REPLACE ";" "<semicolon>" text "${text}")
  string(REGEX MATCHALL "\n```${language}\n[^`]*\n```\n" blocks "${text}")
  foreach(block IN LISTS blocks)
    if(block MATCHES "${pattern}")
      string(REGEX REPLACE "^\n```${language}\n(.*)```\n$" "\\1" block "${block}")
      string(REPLACE "<semicolon>" ";" block "${block}")
      set(${out} "${block}" PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "${page} lacks a block of ${language} with '${pattern}'")
endfunction()

code_block(README.md cmake "project\\(" lists)
code_block(README.md cpp "int main" program)
code_block(doc/guide.md cpp "BFMatcher::create" fragment)
file(WRITE "${project}/CMakeLists.txt" "${lists}")
file(WRITE "${project}/match_pair.cpp" "${program}")

run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")
set(configure "${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${project}" "-DCMAKE_PREFIX_PATH=${prefix}"
  "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${configure} -B "${WORK}/by cmake")
run("${CMAKE_COMMAND}" --build "${WORK}/by cmake")
run_program("${WORK}/by cmake/match_pair")

file(GLOB_RECURSE pc "${prefix}/*/opencv_iib.pc")
get_filename_component(pc_dir "${pc}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
execute_process(COMMAND pkg-config --cflags --libs opencv_iib
  OUTPUT_VARIABLE pc_flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${FLAGS} -std=c++11")
separate_arguments(pc_flags UNIX_COMMAND "${pc_flags}")
run("${CXX}" ${flags} "${project}/match_pair.cpp" ${pc_flags} -o "${WORK}/by pkg-config")
run_program("${WORK}/by pkg-config")

file(WRITE "${WORK}/fragment.cpp" "#include <opencv2/iib.hpp>\nvoid fragment();\nvoid fragment()\n{\n${fragment}}\n")
run("${CXX}" ${flags} -fsyntax-only "${WORK}/fragment.cpp" ${pc_flags})

foreach(page day_night relative_pose presets localization saving_index)
  code_block("modules/iib/tutorials/iib_${page}.markdown" cpp "int main" program)
  file(WRITE "${WORK}/${page}.cpp" "${program}")
  run("${CXX}" ${flags} "${WORK}/${page}.cpp" ${pc_flags} -o "${WORK}/${page}")
endforeach()
set(pair "${synthetic}/day.png" "${synthetic}/night.png")
execute_process(COMMAND "${WORK}/day_night" ${pair} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "^[0-9][0-9]+ of [0-9]+ matches agree with\n")
  message(FATAL_ERROR "day_night: '${output}'")
endif()
execute_process(COMMAND "${WORK}/relative_pose" ${pair} 700 "${WORK}/pose.png" OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "^[0-9][0-9]+ of [0-9]+ matches agree with\n" OR NOT EXISTS "${WORK}/pose.png")
  message(FATAL_ERROR "relative_pose: '${output}'")
endif()
execute_process(COMMAND "${WORK}/presets" OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output STREQUAL "128 bytes, 22.5 times the keypoint's size\n64 bytes, 22.5 times the keypoint's size\n")
  message(FATAL_ERROR "presets: '${output}'")
endif()
# The query is the first image: every point finds itself.
execute_process(COMMAND "${WORK}/saving_index" "${synthetic}/day.png" ${pair} WORKING_DIRECTORY "${WORK}"
  OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "^1000 matches in [^\n]*day.png\n0 matches in [^\n]*night.png\n$")
  message(FATAL_ERROR "saving_index: '${output}'")
endif()

# The other library of the package, by CMake and by pkg-config.
file(WRITE "${project}/index.cpp" "#include <opencv2/iib_index.hpp>
int main(int, char** arguments)
{
    cv::iib::MappedIndex::create(arguments[1], {8})->add(cv::Mat(3, 8, CV_8U, cv::Scalar(1)));
    return cv::iib::MappedIndex::open(arguments[1])->rows() == 3 ? 0 : 1;
}
")
file(APPEND "${project}/CMakeLists.txt" "\nadd_executable(index index.cpp)\ntarget_link_libraries(index opencv_iib_index)\n")
run("${CMAKE_COMMAND}" --build "${WORK}/by cmake")
run("${WORK}/by cmake/index" "${WORK}/codes by cmake")
run("${CXX}" ${flags} "${project}/index.cpp" ${pc_flags} -o "${WORK}/index by pkg-config")
run("${WORK}/index by pkg-config" "${WORK}/codes by pkg-config")

# The library of apps/localization, where it was built; its errors say what is wrong.
if(EXISTS "${prefix}/include/opencv4/opencv2/iib/localization.hpp")
  set(localizer "${WORK}/localizer project")
  file(WRITE "${localizer}/localizer.cpp" "#include <opencv2/iib/localization.hpp>
#include <iostream>
int main(int, char** arguments)
{
    try
    {
        const cv::iib::Camera camera = cv::iib::Camera::parse(\"PINHOLE,640,480,500,500,320,240\");
        cv::iib::Localizer(arguments[1]).localize(cv::Mat(camera.size, CV_8U), camera);
    }
    catch (const cv::Exception& e)
    {
        std::cout << e.err;
    }
}
")
  file(WRITE "${localizer}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.16)
project(localizer CXX)
find_package(opencv_iib REQUIRED COMPONENTS localization)
add_executable(localizer localizer.cpp)
target_link_libraries(localizer opencv_iib_localization)
")
  run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${localizer}" -B "${WORK}/localizer" "-DCMAKE_PREFIX_PATH=${prefix}"
    "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
  run("${CMAKE_COMMAND}" --build "${WORK}/localizer")
  execute_process(COMMAND "${WORK}/localizer/localizer" nowhere OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output STREQUAL "nowhere is no map, or a damaged one: it has no map.json")
    message(FATAL_ERROR "localizer: '${output}'")
  endif()
endif()

# An OpenCV of another minor version is refused, and the message says why.
file(WRITE "${WORK}/other/OpenCVConfig.cmake" "set(OpenCV_VERSION 4.99.0)\n")
file(WRITE "${WORK}/other/OpenCVConfigVersion.cmake" "set(PACKAGE_VERSION 4.99.0)\nset(PACKAGE_VERSION_COMPATIBLE TRUE)\n")
execute_process(COMMAND ${configure} -B "${WORK}/by other" "-DOpenCV_DIR=${WORK}/other"
  RESULT_VARIABLE code OUTPUT_QUIET ERROR_VARIABLE error)
string(REGEX REPLACE "[ \n]+" " " error "${error}")
if(code EQUAL 0 OR NOT error MATCHES "was built with OpenCV [0-9.]+, but .* holds OpenCV 4[.]99[.]0")
  message(FATAL_ERROR "with OpenCV 4.99: exit code ${code}, error '${error}'")
endif()

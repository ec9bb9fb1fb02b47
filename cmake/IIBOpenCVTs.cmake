# Target opencv_ts: OpenCV's test framework, which no distribution packages, from OpenCV's source.
# It is built once per version, compiler and flags, in the user's cache folder.
if(NOT OPENCV_SOURCE_DIR)
  execute_process(COMMAND "${PROJECT_SOURCE_DIR}/scripts/helpers/opencv_source.sh"
    OUTPUT_VARIABLE source OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
  if(NOT failed)
    set(OPENCV_SOURCE_DIR "${source}")
  endif()
endif()
if(NOT EXISTS "${OPENCV_SOURCE_DIR}/modules/ts/CMakeLists.txt")
  message(FATAL_ERROR "The tests need OpenCV ${OpenCV_VERSION}'s source, which apt did not give: "
    "set -DOPENCV_SOURCE_DIR=<OpenCV source tree>, or -DIIB_BUILD_TESTS=OFF to build without tests.")
endif()

if(DEFINED ENV{XDG_CACHE_HOME})
  set(cache "$ENV{XDG_CACHE_HOME}/opencv_iib")
else()
  set(cache "$ENV{HOME}/.cache/opencv_iib")
endif()
# Without sanitizers, so that one build serves all.
string(REPLACE ";" " " flags "${CMAKE_CXX_FLAGS} ${IIB_REQUIRED_FLAGS}")
file(SHA1 "${PROJECT_SOURCE_DIR}/cmake/ts/CMakeLists.txt" recipe)
string(SHA1 key "${OPENCV_SOURCE_DIR} ${OpenCV_VERSION} ${CMAKE_CXX_COMPILER} ${CMAKE_CXX_COMPILER_VERSION} ${flags} ${recipe}")
string(SUBSTRING ${key} 0 12 key)
set(ts_dir "${cache}/ts-${key}")

file(MAKE_DIRECTORY "${cache}")
file(LOCK "${ts_dir}.lock" GUARD FILE)
if(NOT EXISTS "${ts_dir}/complete")
  message(STATUS "iib: building opencv_ts in ${ts_dir}")
  cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
  file(REMOVE_RECURSE "${ts_dir}")
  execute_process(COMMAND "${CMAKE_COMMAND}" -G "${CMAKE_GENERATOR}" -S "${PROJECT_SOURCE_DIR}/cmake/ts" -B "${ts_dir}"
      "-DOPENCV_SOURCE_DIR=${OPENCV_SOURCE_DIR}" "-DOpenCV_DIR=${OpenCV_DIR}" "-DCMAKE_CXX_FLAGS=${flags}"
      "-DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}" -DCMAKE_BUILD_TYPE=Release
      "-DCMAKE_TOOLCHAIN_FILE=${CMAKE_TOOLCHAIN_FILE}"
    COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
  execute_process(COMMAND "${CMAKE_COMMAND}" --build "${ts_dir}" --config Release --parallel ${cores}
    COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
  file(TOUCH "${ts_dir}/complete")
endif()
file(LOCK "${ts_dir}.lock" RELEASE)

include("${ts_dir}/opencv_ts.cmake")
target_include_directories(opencv_ts INTERFACE "${OPENCV_SOURCE_DIR}/modules/ts/include" "${ts_dir}/stubs")
find_package(Threads REQUIRED)
target_link_libraries(opencv_ts INTERFACE
  opencv_core opencv_imgproc opencv_imgcodecs opencv_videoio opencv_highgui Threads::Threads)

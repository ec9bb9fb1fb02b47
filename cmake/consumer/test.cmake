# Installs BUILD into a new prefix, builds the README's C++ against that, by CMake and by pkg-config,
# and runs its program on the demo's pair of images.
# cmake -DBUILD=<build folder> -DWORK=<scratch folder> -DCXX=<compiler> -DFLAGS=<flags>
#   -DGENERATOR=<CMake generator> -P test.cmake
file(REMOVE_RECURSE "${WORK}")
set(prefix "${WORK}/prefix")
get_filename_component(root "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
set(pair "${root}/tools/synthetic/day.png" "${root}/tools/synthetic/night.png")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

function(run_consumer program)
  execute_process(COMMAND "${program}" ${pair} OUTPUT_VARIABLE output ECHO_OUTPUT_VARIABLE
    COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "^[1-9][0-9]* mutual matches\n$")
    message(FATAL_ERROR "${program} does not match the pair")
  endif()
endfunction()

file(READ "${root}/README.md" readme)
if(NOT readme MATCHES "```cpp\n(#include[^`]*)```.*```cpp\n([^`]*)```")
  message(FATAL_ERROR "README.md lacks its C++ program or the fragment after it")
endif()
file(WRITE "${WORK}/consumer.cpp"
  "${CMAKE_MATCH_1}\nvoid fragment(const cv::Mat& descriptors)\n{\n${CMAKE_MATCH_2}}\n")

run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")
run("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/cmake" "-DCMAKE_PREFIX_PATH=${prefix}"
  "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${FLAGS}" "-DCONSUMER=${WORK}/consumer.cpp")
run("${CMAKE_COMMAND}" --build "${WORK}/cmake")
run_consumer("${WORK}/cmake/consumer")

file(GLOB_RECURSE pc "${prefix}/*/opencv_iib.pc")
get_filename_component(pc_dir "${pc}" DIRECTORY)
get_filename_component(lib_dir "${pc_dir}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
execute_process(COMMAND pkg-config --cflags --libs opencv_iib
  OUTPUT_VARIABLE pc_flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(compile UNIX_COMMAND
  "${FLAGS} -std=c++11 \"${WORK}/consumer.cpp\" ${pc_flags} -o \"${WORK}/consumer\"")
run("${CXX}" ${compile})
set(ENV{LD_LIBRARY_PATH} "${lib_dir}")
run_consumer("${WORK}/consumer")

# Installs BUILD into a new prefix and builds the consumer against that, by CMake and by pkg-config.
# cmake -DBUILD=<build folder> -DWORK=<scratch folder> -DCXX=<compiler> -DFLAGS=<flags> -P test.cmake
file(REMOVE_RECURSE "${WORK}")
set(prefix "${WORK}/prefix")

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${WORK}/cmake" "-DCMAKE_PREFIX_PATH=${prefix}"
  "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
run("${CMAKE_COMMAND}" --build "${WORK}/cmake")
run("${WORK}/cmake/consumer")

file(GLOB_RECURSE pc "${prefix}/*/opencv_iib.pc")
get_filename_component(pc_dir "${pc}" DIRECTORY)
get_filename_component(lib_dir "${pc_dir}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
execute_process(COMMAND pkg-config --cflags --libs opencv_iib
  OUTPUT_VARIABLE pc_flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(compile UNIX_COMMAND
  "${FLAGS} -std=c++11 \"${CMAKE_CURRENT_LIST_DIR}/consumer.cpp\" ${pc_flags} -o \"${WORK}/consumer\"")
run("${CXX}" ${compile})
set(ENV{LD_LIBRARY_PATH} "${lib_dir}")
run("${WORK}/consumer")

# ctest entries: each suite of the modules' test programs, with all instruction sets and under each pin WIDEST=DISABLED; a smoke
# run of the performance tests; README's programs on an installation; the demo. scripts/test.sh --all also runs those with the
# label `nightly`.
if(CMAKE_CROSSCOMPILING)
  return()  # scripts/helpers/emulated.sh and scripts/windows.sh run the programs in an emulator
endif()
set(pins "")
if(IIB_DISPATCH)
  set(pins AVX512_SKX=AVX512-ICL AVX2=AVX512-SKX,AVX512-ICL SSE4_2=AVX2,AVX512-SKX,AVX512-ICL
    baseline=SSE4.1,SSE4.2,AVX,AVX2,AVX512-SKX,AVX512-ICL)
endif()
# A pin that disables nothing on this machine would repeat the run without a pin.
if(EXISTS /proc/cpuinfo)
  file(READ /proc/cpuinfo processor LIMIT 8192)
  set(narrower AVX512_SKX AVX2 SSE4_2)
  set(wider avx512_vpopcntdq avx512bw avx2)
  foreach(pin flag IN ZIP_LISTS narrower wider)
    if(NOT processor MATCHES " ${flag}[ \n]")
      list(FILTER pins EXCLUDE REGEX "^${pin}=")
    endif()
  endforeach()
endif()
# Suites of kernels compare every instruction set with naive code over sizes and alignments. They always run under each pin;
# the other suites run under pins only with the label `nightly`, since their results cannot differ if the kernels agree.
set(kernels_of_opencv_test_iib Kernels Hamming Bits Boxes _Rotated GradientOrientation Normalization Refinement Matcher_Sizes Golden InstructionSets)
set(kernels_of_opencv_test_iib_index MappedIndex)
set(kernels_of_opencv_test_iib_geometry "")  # it has no kernels
foreach(program opencv_test_iib_geometry opencv_test_iib opencv_test_iib_index)  # the longest suites first
  set(pins_of_program ${pins})
  if(IIB_SANITIZE AND NOT kernels_of_${program})
    set(pins_of_program "")  # its own code is the same under each pin, and takes hours
  endif()
  set(suites "${PROJECT_BINARY_DIR}/${program}.suites.cmake")
  add_custom_command(TARGET ${program} POST_BUILD
    COMMAND "${CMAKE_COMMAND}" "-DEXE=$<TARGET_FILE:${program}>" "-DOUT=${suites}" "-DPINS=${pins_of_program}"
      "-DKERNELS=${kernels_of_${program}}" -P "${PROJECT_SOURCE_DIR}/cmake/ListSuites.cmake"
    BYPRODUCTS "${suites}" VERBATIM)
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${suites}")
endforeach()

find_program(IIB_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
if(TARGET iib_demo AND IIB_PYTHON)
  add_test(NAME demo COMMAND "${IIB_PYTHON}" -B "${PROJECT_SOURCE_DIR}/scripts/helpers/demo_test.py" "$<TARGET_FILE:iib_demo>"
    "${OpenCV_VERSION}")
  if(IIB_SANITIZE)
    set_tests_properties(demo PROPERTIES LABELS nightly)
  endif()
endif()

if(IIB_SANITIZE)
  return()  # tests of headers, times and symbols do not depend on instrumentation
endif()

add_test(NAME perf-smoke COMMAND opencv_perf_iib --perf_min_samples=1 --perf_force_samples=1)
add_test(NAME perf-smoke-index COMMAND opencv_perf_iib_index --perf_min_samples=1 --perf_force_samples=1)
add_test(NAME perf-smoke-geometry COMMAND opencv_perf_iib_geometry --perf_min_samples=1 --perf_force_samples=1)
if(UNIX)
  add_test(NAME scripts COMMAND "${PROJECT_SOURCE_DIR}/scripts/helpers/scripts_test.sh")
  add_test(NAME upstream COMMAND "${PROJECT_SOURCE_DIR}/scripts/helpers/upstream_test.sh")
  set_tests_properties(upstream PROPERTIES SKIP_RETURN_CODE 77)
endif()
set(compilers "${CMAKE_CXX_COMPILER}")
foreach(name g++ clang++)
  find_program(IIB_${name} ${name})
  if(IIB_${name})
    list(APPEND compilers "${IIB_${name}}")
  endif()
endforeach()
list(REMOVE_DUPLICATES compilers)
add_test(NAME headers COMMAND "${CMAKE_COMMAND}" "-DCOMPILERS=${compilers}"
  "-DINCLUDE=${IIB_DIR}/include;${IIB_INDEX_DIR}/include;${IIB_GEOMETRY_DIR}/include"
  "-DOPENCV_INCLUDE=${OpenCV_INCLUDE_DIRS}" -P "${PROJECT_SOURCE_DIR}/cmake/HeaderTest.cmake")
# No source compiles with -ffast-math, and the build's flags undo it if the user's flags contain it.
set(fast_math "${CMAKE_CXX_COMPILER}" -std=c++11 -ffast-math)
set(source -fsyntax-only -x c++ "-I${IIB_DIR}/include")
foreach(folder IN LISTS OpenCV_INCLUDE_DIRS)
  list(APPEND source -isystem "${folder}")
endforeach()
list(APPEND source "${IIB_DIR}/src/precomp.hpp")
add_test(NAME fast-math-refused COMMAND ${fast_math} ${source})
set_tests_properties(fast-math-refused PROPERTIES PASS_REGULAR_EXPRESSION "error: .*-ffast-math lets NaN through")
add_test(NAME fast-math-undone COMMAND ${fast_math} ${IIB_FLAGS} ${source})
if(IIB_PYTHON)
  add_test(NAME readme COMMAND "${IIB_PYTHON}" -B "${PROJECT_SOURCE_DIR}/scripts/helpers/readme_test.py" "${PROJECT_BINARY_DIR}"
    "${CMAKE_CXX_COMPILER}" "${CMAKE_CXX_FLAGS}" "${CMAKE_GENERATOR}")
  add_test(NAME includes COMMAND "${IIB_PYTHON}" "${PROJECT_SOURCE_DIR}/scripts/helpers/includes_test.py" "${IIB_DIR}"
    "${PROJECT_SOURCE_DIR}/modules/iib_index" "${IIB_GEOMETRY_DIR}")
  set(pages "${PROJECT_SOURCE_DIR}/tools/pages")
  add_test(NAME pages COMMAND "${IIB_PYTHON}" -B "${pages}/pages.py" --check)  # fails if writing the pages would change them
  add_test(NAME pages-test COMMAND "${IIB_PYTHON}" -B "${pages}/test/test_pages.py")
  add_test(NAME pages-names COMMAND "${IIB_PYTHON}" -B "${pages}/test/check_names.py" "${PROJECT_BINARY_DIR}")
  set_tests_properties(pages pages-test PROPERTIES SKIP_REGULAR_EXPRESSION "is not installed|No module named")
  add_test(NAME mutants COMMAND "${IIB_PYTHON}" "${PROJECT_SOURCE_DIR}/tools/mutation/mutate.py"
    --source "${PROJECT_SOURCE_DIR}" --check)
endif()
# The Python package, linked with the library built here. The script skips by itself without a package index.
if(UNIX AND NOT APPLE AND TARGET opencv_iib_geometry)  # a part of the package; its OpenCV modules may be missing
  add_library(opencv_iib_static STATIC $<TARGET_OBJECTS:opencv_iib> $<TARGET_OBJECTS:opencv_iib_index>
    $<TARGET_OBJECTS:opencv_iib_geometry>)
  add_test(NAME python COMMAND "${CMAKE_COMMAND}" -E env "OpenCV_DIR=${OpenCV_DIR}"
    "${PROJECT_SOURCE_DIR}/scripts/helpers/python_test.sh" "$<TARGET_FILE:opencv_iib_static>")
  set_tests_properties(python PROPERTIES SKIP_REGULAR_EXPRESSION "skipped: python tests \\("
    COST 1000)  # it takes longest, so it starts first
endif()
if(UNIX AND NOT APPLE)
  set(symbol_test "-DNM=${CMAKE_NM}" "-DREADELF=${CMAKE_READELF}" "-DVERSION=${PROJECT_VERSION}"
    "-DROOT=${PROJECT_SOURCE_DIR}" -P "${PROJECT_SOURCE_DIR}/cmake/SymbolTest.cmake")
  add_test(NAME symbols COMMAND "${CMAKE_COMMAND}" "-DLIBRARY=$<TARGET_FILE:opencv_iib>" ${symbol_test})
  add_test(NAME symbols-index COMMAND "${CMAKE_COMMAND}" "-DLIBRARY=$<TARGET_FILE:opencv_iib_index>" ${symbol_test})
  add_test(NAME symbols-geometry COMMAND "${CMAKE_COMMAND}" "-DLIBRARY=$<TARGET_FILE:opencv_iib_geometry>" ${symbol_test})
endif()
# Other compilers and unoptimized builds inline less.
if(IIB_DISPATCH AND NOT IIB_SANITIZE AND CMAKE_BUILD_TYPE STREQUAL "Release" AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_test(NAME dispatched-symbols COMMAND "${CMAKE_COMMAND}"
    "-DOBJECTS=$<FILTER:$<TARGET_OBJECTS:opencv_iib>,INCLUDE,/dispatch/>" "-DNM=${CMAKE_NM}"
    -P "${PROJECT_SOURCE_DIR}/cmake/DispatchTest.cmake")
endif()

# The modules' test and performance programs, on OpenCV's own test framework.
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc features2d flann calib3d imgcodecs videoio highgui
  OPTIONAL_COMPONENTS video)
include(IIBOpenCVTs)

# The program opencv_KIND_NAME of modules/NAME/KIND.
function(iib_add_test_program kind name)
  set(dir "${PROJECT_SOURCE_DIR}/modules/${name}/${kind}")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${dir}/*.cpp" "${dir}/*.hpp")
  set(target opencv_${kind}_${name})
  add_executable(${target} ${sources})
  target_include_directories(${target} PRIVATE "${dir}" "${OPENCV_SOURCE_DIR}/modules")
  target_precompile_headers(${target} PRIVATE "${dir}/${kind}_precomp.hpp")
  target_compile_options(${target} PRIVATE ${IIB_ADDRESS_ALONE})
  if(kind STREQUAL "test" AND NOT MSVC)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)  # compiling takes longer than running, except for the oracles
  endif()
  target_link_libraries(${target} PRIVATE opencv_${name} opencv_ts opencv_calib3d)
endfunction()
iib_add_test_program(test iib)
iib_add_test_program(perf iib)
if(OpenCV_video_FOUND)  # has a method to compare the refinement with
  target_link_libraries(opencv_perf_iib PRIVATE opencv_video)
  target_compile_definitions(opencv_perf_iib PRIVATE IIB_PERF_VIDEO)
endif()
iib_add_test_program(test iib_index)
iib_add_test_program(perf iib_index)
iib_add_test_program(test iib_geometry)
iib_add_test_program(perf iib_geometry)
foreach(program opencv_perf_iib opencv_perf_iib_geometry)
  target_compile_definitions(${program} PRIVATE "IIB_PERF_PICTURES=\"${PROJECT_SOURCE_DIR}/tools/synthetic\"")
endforeach()
if(TARGET iib_contrib)
  target_link_libraries(opencv_perf_iib PRIVATE iib_contrib)
  target_compile_definitions(opencv_perf_iib PRIVATE IIB_PERF_XFEATURES2D)
endif()

# Suites of internals link symbols that the library does not export.
target_sources(opencv_test_iib PRIVATE "$<FILTER:$<TARGET_OBJECTS:opencv_iib>,INCLUDE,/(common/grey|kernels/.*|matcher/(pair_scan|parameters|search)|descriptor/(keypoint_batches|parameters|plan))[.]>")
target_sources(opencv_test_iib_geometry PRIVATE $<TARGET_OBJECTS:opencv_iib_geometry>)
target_link_libraries(opencv_test_iib_geometry PRIVATE ${IIB_GEOMETRY_OPENCV})
target_include_directories(opencv_test_iib_geometry PRIVATE "${IIB_GEOMETRY_DIR}/src")
target_compile_features(opencv_test_iib_geometry PRIVATE cxx_std_17)
if(TARGET iib_sample_localize)
  target_compile_definitions(opencv_test_iib_geometry PRIVATE "IIB_SAMPLE_LOCALIZE=\"$<TARGET_FILE:iib_sample_localize>\"")
  add_dependencies(opencv_test_iib_geometry iib_sample_localize)
endif()

# The naive oracles are not under test; with sanitizers they would take most of the time.
set(options $<$<CONFIG:Release>:-O2>)
if(IIB_SANITIZE)
  set_target_properties(opencv_perf_iib opencv_perf_iib_index opencv_perf_iib_geometry PROPERTIES EXCLUDE_FROM_ALL ON)
  list(APPEND options -fno-sanitize=all)
endif()
set_source_files_properties("${IIB_DIR}/test/support/box_oracle.cpp" "${IIB_DIR}/test/support/descriptor_oracle.cpp"
  "${IIB_DIR}/test/support/matcher_oracle.cpp" PROPERTIES COMPILE_OPTIONS "${options}" SKIP_PRECOMPILE_HEADERS ON)

# A tool's test program: the sources in test/ beside the caller, with the tools' main, and an entry in ctest.
function(iib_add_tool_test name target library)
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/test/*.cpp")
  list(APPEND sources "${PROJECT_SOURCE_DIR}/tools/common/test/test_main.cpp")
  list(REMOVE_DUPLICATES sources)
  add_executable(${target} ${sources})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}/modules")  # for the tests' support
  target_compile_features(${target} PRIVATE cxx_std_17)  # std::filesystem
  target_link_libraries(${target} PRIVATE ${library} opencv_ts)
  target_precompile_headers(${target} PRIVATE <opencv2/ts.hpp>)
  add_test(NAME ${name} COMMAND ${target})
endfunction()

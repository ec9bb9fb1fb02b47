# Stand-in for OpenCV's ocv_add_dispatched_file: builds NAME.simd.hpp once for each instruction set
# and writes the NAME.simd_declarations.hpp that NAME.dispatch.cpp includes.
#
# OpenCV's installed cv_cpu_dispatch.h and cv_cpu_helper.h hold all the macros (CV_CPU_DISPATCH,
# CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN, CV_AVX2, ...), active when __OPENCV_BUILD is defined and
# cv_cpu_config.h has the compiler's instruction sets. The sets below are OpenCVCompilerOptimizations.cmake's.
include(CheckCXXCompilerFlag)

set(IIB_BASELINE "")
set(IIB_DISPATCH "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$" AND CMAKE_SIZEOF_VOID_P EQUAL 8)
  set(IIB_BASELINE SSE SSE2)
  set(IIB_DISPATCH SSE4_2 AVX2 AVX512_SKX AVX512_ICL)

  set(IIB_SSE4_2_FEATURES SSE3 SSSE3 SSE4_1 POPCNT SSE4_2)
  set(IIB_SSE4_2_FLAGS "-msse3 -mssse3 -msse4.1 -mpopcnt -msse4.2")
  set(IIB_AVX2_FEATURES ${IIB_SSE4_2_FEATURES} FP16 FMA3 AVX AVX2)
  set(IIB_AVX2_FLAGS "${IIB_SSE4_2_FLAGS} -mf16c -mfma -mavx -mavx2")
  set(IIB_AVX512_SKX_FEATURES ${IIB_AVX2_FEATURES} AVX_512F AVX512_COMMON AVX512_SKX)
  set(IIB_AVX512_SKX_FLAGS "${IIB_AVX2_FLAGS} -mavx512f -mavx512cd -mavx512vl -mavx512bw -mavx512dq")
  set(IIB_AVX512_ICL_FEATURES ${IIB_AVX512_SKX_FEATURES} AVX512_ICL)
  set(IIB_AVX512_ICL_FLAGS
    "${IIB_AVX512_SKX_FLAGS} -mavx512ifma -mavx512vbmi -mavx512vnni -mavx512vbmi2 -mavx512bitalg -mavx512vpopcntdq")
  if(MINGW)  # GCC assumes aligned AVX variables on the stack, which they are not here (GCC bug 54412)
    foreach(isa AVX2 AVX512_SKX AVX512_ICL)
      string(APPEND IIB_${isa}_FLAGS " -Wa,-muse-unaligned-vector-move")
    endforeach()
  endif()
  if(MSVC)  # its intrinsics need no flag; the flag lets the compiler use these instructions by itself
    set(IIB_SSE4_2_FLAGS "")
    set(IIB_AVX2_FLAGS /arch:AVX2)
    set(IIB_AVX512_SKX_FLAGS /arch:AVX512)
    set(IIB_AVX512_ICL_FLAGS /arch:AVX512)
  endif()
elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64|ARM64)$")
  set(IIB_BASELINE NEON)
endif()

foreach(isa IN LISTS IIB_DISPATCH)
  check_cxx_compiler_flag("${IIB_${isa}_FLAGS}" IIB_COMPILER_HAS_${isa})
  if(NOT IIB_COMPILER_HAS_${isa})
    list(REMOVE_ITEM IIB_DISPATCH ${isa})
  endif()
endforeach()
message(STATUS "iib: kernels for the baseline (${IIB_BASELINE}) and for ${IIB_DISPATCH}")

function(iib_write_private_headers dir)
  set(config "")
  foreach(isa IN LISTS IIB_BASELINE)
    string(APPEND config "#define CV_CPU_COMPILE_${isa} 1\n#define CV_CPU_BASELINE_COMPILE_${isa} 1\n")
  endforeach()
  foreach(isa IN LISTS IIB_DISPATCH)
    string(APPEND config "#define CV_CPU_DISPATCH_COMPILE_${isa} 1\n")
  endforeach()
  file(CONFIGURE OUTPUT "${dir}/cv_cpu_config.h" CONTENT "${config}" @ONLY)
  file(CONFIGURE OUTPUT "${dir}/cvconfig.h" CONTENT "#define CV_ENABLE_INTRINSICS\n" @ONLY)
endfunction()

function(iib_add_dispatched_file target src_dir name)
  set(gen "${CMAKE_CURRENT_BINARY_DIR}/dispatch")
  set(kernel "${src_dir}/${name}.simd.hpp")
  set(declarations "#define CV_CPU_OPTIMIZATION_DECLARATIONS_ONLY
#undef CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
#undef CV_CPU_OPTIMIZATION_NAMESPACE_END
#define CV_CPU_OPTIMIZATION_NAMESPACE_END }
")
  set(modes BASELINE)
  set_source_files_properties("${src_dir}/${name}.dispatch.cpp" PROPERTIES COMPILE_OPTIONS "${IIB_ADDRESS_ALONE}"
    SKIP_PRECOMPILE_HEADERS ON)  # they are compiled with other flags
  foreach(isa IN LISTS IIB_DISPATCH)
    string(TOLOWER ${isa} suffix)
    set(file "${gen}/${name}.${suffix}.cpp")
    file(CONFIGURE OUTPUT "${file}"
      CONTENT "#include \"${src_dir}/precomp.hpp\"\n#include \"${kernel}\"\n" @ONLY)
    set(features ${IIB_${isa}_FEATURES})
    list(TRANSFORM features REPLACE "(.+)" "CV_CPU_COMPILE_\\1=1")
    # GCC warns about undefined halves in its own AVX-512 headers (GCC bug 105593).
    set(quiet "")
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      set(quiet "-Wno-uninitialized -Wno-maybe-uninitialized")
    endif()
    set_source_files_properties("${file}" PROPERTIES
      COMPILE_FLAGS "${IIB_${isa}_FLAGS} ${quiet}"
      COMPILE_OPTIONS "${IIB_ADDRESS_ALONE}"
      SKIP_PRECOMPILE_HEADERS ON
      COMPILE_DEFINITIONS "CV_CPU_DISPATCH_MODE=${isa};${features}")
    target_sources(${target} PRIVATE "${file}")
    string(APPEND declarations "#define CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN namespace opt_${isa} {
#include \"${kernel}\"
#undef CV_CPU_OPTIMIZATION_NAMESPACE_BEGIN
")
    set(modes "${isa}, ${modes}")
  endforeach()
  string(APPEND declarations "#undef CV_CPU_OPTIMIZATION_NAMESPACE_END\n#define CV_CPU_DISPATCH_MODES_ALL ${modes}\n")
  file(CONFIGURE OUTPUT "${gen}/${name}.simd_declarations.hpp" CONTENT "${declarations}" @ONLY)
endfunction()

function(iib_add_dispatched_files target src_dir)
  set(gen "${CMAKE_CURRENT_BINARY_DIR}/dispatch")
  iib_write_private_headers("${gen}")
  target_include_directories(${target} PRIVATE "${gen}")
  target_compile_definitions(${target} PRIVATE __OPENCV_BUILD=1)
  file(GLOB_RECURSE kernels CONFIGURE_DEPENDS RELATIVE "${src_dir}" "${src_dir}/*.dispatch.cpp")
  foreach(kernel IN LISTS kernels)
    string(REPLACE ".dispatch.cpp" "" name "${kernel}")
    iib_add_dispatched_file(${target} "${src_dir}" ${name})
  endforeach()
endfunction()

# All compiler flags, of the library, the tests and opencv_ts.
set(CMAKE_CXX_STANDARD 11)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

include("${CMAKE_CURRENT_LIST_DIR}/../modules/iib/cmake/flags.cmake")
set(IIB_FLAGS ${IIB_REQUIRED_FLAGS})
if(MSVC)
  set(IIB_WARNINGS /W3 /utf-8 /bigobj)
else()
  set(IIB_WARNINGS -Wall -Wextra -Wshadow -Wmissing-declarations)
endif()

# The kernels add neighbouring lanes by shifts of wider lanes, which gives other bits on big-endian processors.
include(TestBigEndian)
test_big_endian(IIB_BIG_ENDIAN)
if(IIB_BIG_ENDIAN)
  message(FATAL_ERROR "opencv_iib needs a little-endian processor: descriptors would differ on this one")
endif()

# For example address,undefined or thread, or fuzzer,address,undefined: then fuzz is for libFuzzer.
set(IIB_SANITIZE "" CACHE STRING "Argument of -fsanitize=, empty for none")
set(IIB_FUZZ OFF)
if(IIB_SANITIZE)
  string(REPLACE "," ";" sanitizers "${IIB_SANITIZE}")
  if("fuzzer" IN_LIST sanitizers)
    set(IIB_FUZZ ON)
    list(TRANSFORM sanitizers REPLACE "^fuzzer$" "fuzzer-no-link")
  endif()
  list(JOIN sanitizers "," argument)
  list(APPEND IIB_FLAGS -fsanitize=${argument} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
  add_link_options(-fsanitize=${argument})
endif()
# For kernels and tests, which GCC compiles slowest: the cheapest flags that find every access out of bounds. scripts/fuzz.sh
# finds other undefined behaviour and uses after a scope, with clang and all flags. Checks by
# calls (asan-instrumentation-with-call-threshold=0) would keep so many masks of AVX-512 in memory that GCC 12 trips over
# them: it stores one byte of a mask (kmovb) and reads four back.
set(IIB_ADDRESS_ALONE "")
if("address" IN_LIST sanitizers AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(IIB_ADDRESS_ALONE -fno-sanitize=undefined -fno-sanitize-address-use-after-scope)
endif()

# What Debian builds its packages with. FORTIFY_SOURCE needs an optimizing build and gets in the way of sanitizers.
function(iib_harden target)
  if(NOT UNIX OR IIB_SANITIZE)
    return()
  endif()
  target_compile_options(${target} PRIVATE -fstack-protector-strong)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
  if("${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${config}}" MATCHES "-O[1-9sz]")
    target_compile_options(${target} PRIVATE -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2)
  endif()
  if(NOT APPLE)
    target_link_options(${target} PRIVATE -Wl,-z,relro,-z,now)
  endif()
endfunction()

add_compile_options(${IIB_FLAGS} ${IIB_WARNINGS})

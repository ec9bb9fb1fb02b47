# IIB_REQUIRED_FLAGS: compiler flags that the stand-alone build and OpenCV's own build both need, for any flags of the user.
# A fused multiply-add rounds once instead of twice and would change bits of the descriptor; -ffast-math in the user's flags
# (ENABLE_FAST_MATH in OpenCV's) would do so too, and let NaN through all checks.
if(MSVC)
  set(IIB_REQUIRED_FLAGS /fp:strict)
else()
  set(IIB_REQUIRED_FLAGS -fno-fast-math -ffp-contract=off)
endif()
if(CMAKE_SIZEOF_VOID_P EQUAL 4)
  list(APPEND IIB_REQUIRED_FLAGS -D_FILE_OFFSET_BITS=64)  # otherwise files with large inode numbers cannot be opened
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # works around a bug of GCC 12 with two shorts in a word
    list(APPEND IIB_REQUIRED_FLAGS -fno-tree-vectorize)
  endif()
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "86|amd64" AND NOT MSVC)  # x87 rounds to other bits
    list(APPEND IIB_REQUIRED_FLAGS -msse2 -mfpmath=sse)
  endif()
endif()

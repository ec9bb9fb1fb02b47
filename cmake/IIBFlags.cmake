# The one place for compiler flags: they hold for the library, the tests and opencv_ts.
set(CMAKE_CXX_STANDARD 11)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

# A fused multiply-add rounds once instead of twice and would change bits of the descriptor.
set(IIB_FLAGS -ffp-contract=off)

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
  list(APPEND IIB_FLAGS -fsanitize=${argument} -fno-sanitize-recover=all -fno-omit-frame-pointer -g)
  add_link_options(-fsanitize=${argument})
endif()

add_compile_options(${IIB_FLAGS} -Wall -Wextra -Wshadow -Wmissing-declarations)

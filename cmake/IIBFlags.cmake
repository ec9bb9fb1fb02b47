# The one place for compiler flags: they hold for the library, the tests and opencv_ts.
set(CMAKE_CXX_STANDARD 11)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)

# A fused multiply-add rounds once instead of twice and would change bits of the descriptor.
set(IIB_FLAGS -ffp-contract=off)

# For example -DIIB_SANITIZE=address,undefined or -DIIB_SANITIZE=thread.
set(IIB_SANITIZE "" CACHE STRING "Argument of -fsanitize=, empty for none")
if(IIB_SANITIZE)
  list(APPEND IIB_FLAGS -fsanitize=${IIB_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g)
  add_link_options(-fsanitize=${IIB_SANITIZE})
endif()

add_compile_options(${IIB_FLAGS} -Wall -Wextra -Wshadow -Wmissing-declarations)

# Compiles each header of the include folders alone, and the headers that users include (opencv2/*.hpp) as C++11 and C++20, with
# every available compiler. Warnings are errors.
# cmake -DCOMPILERS=<list> -DINCLUDE=<list of folders> -DOPENCV_INCLUDE=<list> -P HeaderTest.cmake
set(headers "")
foreach(folder IN LISTS INCLUDE)
  file(GLOB_RECURSE found RELATIVE "${folder}" "${folder}/*.hpp")
  list(APPEND headers ${found})
endforeach()
list(TRANSFORM INCLUDE PREPEND "-I")
list(LENGTH headers count)
if(count EQUAL 0)
  message(FATAL_ERROR "no headers below ${INCLUDE}")
endif()
list(TRANSFORM OPENCV_INCLUDE PREPEND "-isystem;")
function(compile compiler standard header)
  execute_process(
    COMMAND "${compiler}" -std=c++${standard} -Wall -Wextra -Wpedantic -Wshadow -Werror -fsyntax-only -x c++
      ${INCLUDE} ${OPENCV_INCLUDE} -include "${header}" /dev/null
    RESULT_VARIABLE failed ERROR_VARIABLE errors)
  if(failed)
    message(SEND_ERROR "${header}, ${compiler}, C++${standard}:\n${errors}")
  endif()
endfunction()
list(GET COMPILERS 0 first)
foreach(header IN LISTS headers)
  compile("${first}" 11 "${header}")
endforeach()
foreach(compiler IN LISTS COMPILERS)
  foreach(standard 11 20)
    compile("${compiler}" ${standard} opencv2/iib.hpp)
    compile("${compiler}" ${standard} opencv2/iib_index.hpp)
    compile("${compiler}" ${standard} opencv2/iib_geometry.hpp)
  endforeach()
endforeach()

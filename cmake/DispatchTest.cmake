# Checks that OBJECTS, which are compiled for more than the baseline, define no weak symbols. The linker keeps one instance of a
# template or inline function for the whole library, which could hold an illegal instruction on another processor.
# cmake -DOBJECTS=<files> -DNM=<nm> -P DispatchTest.cmake
if(NOT OBJECTS)
  message(SEND_ERROR "there are no dispatched objects")
endif()
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND "${NM}" -C --defined-only "${object}" OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]* [Wu] [^\n]*" weak "${symbols}")
  if(weak)
    message(SEND_ERROR "${object} defines weak symbols: ${weak}")
  endif()
endforeach()

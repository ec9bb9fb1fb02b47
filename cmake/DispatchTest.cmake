# OBJECTS, which were compiled for more than the baseline, define no weak symbols: of a template's or an inline function's
# instances the linker keeps one for the whole library, and that may be an illegal instruction on another processor.
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

# iib_evaluation names the image that it cannot read, says at its end that no pair is left, and ends with an error.
# cmake -DEVALUATION=<program> -DWORK=<folder> -P UnreadableTest.cmake
file(REMOVE_RECURSE "${WORK}")
file(WRITE "${WORK}/data/set/sequence/1.png" "no image")
file(WRITE "${WORK}/data/set/sequence/2.png" "no image")
execute_process(COMMAND "${EVALUATION}" --out "${WORK}/results" "${WORK}/data"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE errors)
if(NOT code EQUAL 1)
  message(FATAL_ERROR "the exit code is ${code}, not 1:\n${output}${errors}")
endif()
if(NOT errors MATCHES "1.png: not a readable image\n" OR
    NOT errors MATCHES "\niib_evaluation: none of the 1 image pairs can be read\n$")
  message(FATAL_ERROR "not told what cannot be read:\n${errors}")
endif()

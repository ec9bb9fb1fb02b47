# iib_evaluation tells in one line that no pair of images can be read, and ends with an error.
# cmake -DEVALUATION=<program> -DWORK=<folder> -P UnreadableTest.cmake
file(REMOVE_RECURSE "${WORK}")
file(WRITE "${WORK}/data/set/sequence/1.png" "no image")
file(WRITE "${WORK}/data/set/sequence/2.png" "no image")
execute_process(COMMAND "${EVALUATION}" --out "${WORK}/results" "${WORK}/data"
  RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE errors)
if(NOT code EQUAL 1)
  message(FATAL_ERROR "the exit code is ${code}, not 1:\n${output}${errors}")
endif()
if(NOT errors MATCHES "^iib_evaluation: [^\n]*read[^\n]*\n$")
  message(FATAL_ERROR "not one line about what cannot be read:\n${errors}")
endif()

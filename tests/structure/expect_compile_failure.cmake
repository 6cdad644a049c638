# cmake -DREGEX=<regex> -P expect_compile_failure.cmake -- <compiler> <arguments>...
# Succeeds when the command succeeds as it is, and fails with -DMUST_NOT_COMPILE and output that matches the regex.

set(command)
set(after_dashes FALSE)
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(i RANGE ${last})
  if(after_dashes)
    list(APPEND command "${CMAKE_ARGV${i}}")
  elseif(CMAKE_ARGV${i} STREQUAL "--")
    set(after_dashes TRUE)
  endif()
endforeach()

execute_process(COMMAND ${command} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "the control must compile, but does not:\n${output}")
endif()

execute_process(COMMAND ${command} -DMUST_NOT_COMPILE RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(status EQUAL 0)
  message(FATAL_ERROR "compiles, but must not")
elseif(NOT output MATCHES "${REGEX}")
  message(FATAL_ERROR "does not compile, but the message does not match '${REGEX}':\n${output}")
endif()

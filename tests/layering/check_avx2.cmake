# Code for AVX2 must not leak: a function that other objects have too could be taken from here by the linker, and then
# end the program on a processor without AVX2. NM, LIBRARIES: what to look at, and with what.
foreach(library ${LIBRARIES})
  execute_process(COMMAND ${NM} -C ${library} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  if(NOT symbols MATCHES "_avx2\\.cpp\\.o:\n(([^\n]+\n)+)")
    message(FATAL_ERROR "${library} has no object for AVX2")
  endif()
  if("${CMAKE_MATCH_1}" MATCHES "[0-9a-f]+ W ([^\n]+)")
    message(FATAL_ERROR "${library}: others may be given the AVX2 copy of ${CMAKE_MATCH_1}")
  endif()
endforeach()

# Every source is as clang-format 14 (Debian 12's) writes it; other versions write other things.
# cmake -DSOURCE_DIR=... -P check_format.cmake
find_program(CLANG_FORMAT NAMES clang-format-14 clang-format)
if(CLANG_FORMAT)
  execute_process(COMMAND ${CLANG_FORMAT} --version OUTPUT_VARIABLE version)
endif()
if(NOT version MATCHES "version 14\\.")
  message("SKIPPED: clang-format 14 is absent, so nobody has looked at the formatting")
  return()
endif()

set(sources)
foreach(folder IN ITEMS core recording study drivers daemon cli tests bench docs)
  file(GLOB_RECURSE found RELATIVE ${SOURCE_DIR}
    ${SOURCE_DIR}/${folder}/*.h ${SOURCE_DIR}/${folder}/*.cpp ${SOURCE_DIR}/${folder}/*.inl
    ${SOURCE_DIR}/${folder}/*.c)
  list(APPEND sources ${found})
endforeach()
list(LENGTH sources count)
if(count LESS 50)
  message(FATAL_ERROR "only ${count} sources found under ${SOURCE_DIR}")
endif()

execute_process(COMMAND ${CLANG_FORMAT} --dry-run ${sources}
  WORKING_DIRECTORY ${SOURCE_DIR} ERROR_VARIABLE complaints RESULT_VARIABLE failed)
string(REGEX MATCHALL "[^\n]+:[0-9]+:[0-9]+: (warning|error)" places "${complaints}")
list(TRANSFORM places REPLACE ":[0-9]+:[0-9]+: (warning|error)" "")
list(REMOVE_DUPLICATES places)
if(failed OR places)
  list(LENGTH places wrong)
  list(JOIN places "\n  " shown)
  message(FATAL_ERROR "clang-format would change ${wrong} of ${count} files; run clang-format -i on\n  ${shown}")
endif()
message("${count} files are as clang-format writes them")

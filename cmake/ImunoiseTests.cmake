# How tests become programs, and programs entries of ctest.

# The trials labelled slow, which `all` leaves out.
add_custom_target(slow_tests)

# Where each run leaves its cases with their times (JUnit XML), for scripts/test.sh.
set(IMUNOISE_CASES ${PROJECT_BINARY_DIR}/cases)

# imunoise_test_program(PROGRAM [SHARDS N] [LABEL slow] [PRELOAD LIBRARY]): an empty GoogleTest program
# test_PROGRAM in tests/ of the build tree, run by ctest in N parts at a time. PRELOAD names a library that
# stands before all others when it runs. imunoise_test() fills it.
function(imunoise_test_program program)
  cmake_parse_arguments(PROGRAM "" "SHARDS;LABEL;PRELOAD" "" ${ARGN})
  add_executable(test_${program})
  set_target_properties(test_${program} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests UNITY_BUILD_MODE GROUP)
  target_link_libraries(test_${program} PRIVATE GTest::gtest_main)
  target_compile_definitions(test_${program} PRIVATE
    IMUNOISE_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    IMUNOISE_SHARED_DIR="${PROJECT_SOURCE_DIR}/../shared"
    IMUNOISE_BINARY_DIR="${PROJECT_BINARY_DIR}"
    IMUNOISE_BINARY="${PROJECT_BINARY_DIR}/imunoise"
    IMUNOISED="${PROJECT_BINARY_DIR}/imunoised"
    IMUNOISE_DRIVER_FOLDER="${PROJECT_BINARY_DIR}/lib/imunoise/drivers"
    IMUNOISE_CMAKE="${CMAKE_COMMAND}")
  set(time_limit 900)  # s
  if(IMUNOISE_SANITIZE)
    set(time_limit 1800)
  endif()
  if(NOT PROGRAM_LABEL)
    set(PROGRAM_LABEL fast)
  endif()
  if(PROGRAM_LABEL STREQUAL "fast")
    if(NOT IMUNOISE_SANITIZE)
      target_compile_options(test_${program} PRIVATE -O1)  # optimising takes longer than it saves
    endif()
  else()  # built when asked for; sanitizers see the fast tests only
    set(time_limit 86400)
    set_target_properties(test_${program} PROPERTIES EXCLUDE_FROM_ALL TRUE)
    add_dependencies(slow_tests test_${program})
    if(IMUNOISE_SANITIZE)
      return()
    endif()
  endif()
  set(environment)
  if(PROGRAM_PRELOAD)
    set(environment LD_PRELOAD=${PROGRAM_PRELOAD})
  endif()
  if(NOT PROGRAM_SHARDS)
    set(PROGRAM_SHARDS 1)
  endif()
  math(EXPR last "${PROGRAM_SHARDS} - 1")
  foreach(shard RANGE ${last})
    set(name ${program})
    if(PROGRAM_SHARDS GREATER 1)
      math(EXPR part "${shard} + 1")
      set(name ${program}.${part}of${PROGRAM_SHARDS})
    endif()
    add_test(NAME ${name} COMMAND test_${program})
    set_tests_properties(${name} PROPERTIES LABELS ${PROGRAM_LABEL} TIMEOUT ${time_limit} ENVIRONMENT
      "${environment};GTEST_TOTAL_SHARDS=${PROGRAM_SHARDS};GTEST_SHARD_INDEX=${shard};GTEST_OUTPUT=xml:${IMUNOISE_CASES}/${name}.xml;GTEST_BRIEF=1")
  endforeach()
endfunction()

# imunoise_test(NAME IN PROGRAM [THREADED] SOURCES ... USES ... [NEEDS TARGET ...] [DEFINES NAME=VALUE ...]): adds
# sources to a program. Those of one NAME are compiled together where builds join sources (scripts do), which
# saves most of the time: their anonymous namespaces are one. THREADED: they run several threads; ThreadSanitizer's
# build holds no others. NEEDS names what must be built before they run. Without IN: a program of its own, with
# the options of imunoise_test_program().
function(imunoise_test name)
  cmake_parse_arguments(TEST "THREADED" "IN;SHARDS;LABEL;PRELOAD" "SOURCES;USES;NEEDS;DEFINES" ${ARGN})
  if(IMUNOISE_SANITIZE MATCHES "thread" AND NOT TEST_THREADED)
    return()
  endif()
  if(NOT TEST_IN)
    set(TEST_IN ${name})
    imunoise_test_program(${name} SHARDS ${TEST_SHARDS} LABEL ${TEST_LABEL} PRELOAD ${TEST_PRELOAD})
  endif()
  set(target test_${TEST_IN})
  get_target_property(there ${target} SOURCES)
  foreach(source IN LISTS TEST_SOURCES)  # tests of one program may share a source
    get_filename_component(source ${source} ABSOLUTE)
    if(NOT source IN_LIST there)
      target_sources(${target} PRIVATE ${source})
      set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${name})
    endif()
  endforeach()
  target_link_libraries(${target} PRIVATE ${TEST_USES})
  target_compile_definitions(${target} PRIVATE ${TEST_DEFINES})
  if(TEST_NEEDS)
    add_dependencies(${target} ${TEST_NEEDS})
  endif()
endfunction()

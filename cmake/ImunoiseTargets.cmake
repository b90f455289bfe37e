# How every target of the house is built: a function for rooms, one for drivers, the common flags.

find_program(IMUNOISE_CCACHE ccache)
if(IMUNOISE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # It takes what a source includes from the compiler, and does not preprocess it once more.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_DEPEND=1 ${IMUNOISE_CCACHE})
endif()

add_library(imunoise_flags INTERFACE)
target_include_directories(imunoise_flags INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(imunoise_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Wold-style-cast
  -Woverloaded-virtual -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(imunoise_flags INTERFACE -Wno-restrict)  # false alarms in std::string (GCC bug 105651)
endif()
if(CMAKE_UNITY_BUILD)
  # All sources of a room at once: half the time of eight by eight, most of which is headers and templates.
  set(CMAKE_UNITY_BUILD_BATCH_SIZE 0)
  # Joined sources see each other's names; each by itself is held to these warnings. A local that hides
  # a local does so in joined sources, too.
  target_compile_options(imunoise_flags INTERFACE
    -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wshadow=local -Wno-subobject-linkage>)
endif()
if(IMUNOISE_WERROR)
  target_compile_options(imunoise_flags INTERFACE -Werror)
endif()
if(IMUNOISE_SANITIZE)
  target_compile_options(imunoise_flags INTERFACE
    -fsanitize=${IMUNOISE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(imunoise_flags INTERFACE -fsanitize=${IMUNOISE_SANITIZE})
  target_compile_definitions(imunoise_flags INTERFACE IMUNOISE_SANITIZED)
  # With sanitizers, optimising takes more time than all other compiling. It pays where numbers are worked out or
  # fuzzers run, nowhere else.
  target_compile_options(imunoise_flags INTERFACE
    "$<IF:$<OR:$<BOOL:$<TARGET_PROPERTY:IMUNOISE_MATRICES>>,$<BOOL:$<TARGET_PROPERTY:IMUNOISE_PARSES>>>,-O2,-O0>")
endif()
if(IMUNOISE_SANITIZE MATCHES "address")
  # Eigen allocates in another way where it sees AddressSanitizer; matrices pass between rooms built with
  # it and without.
  target_compile_definitions(imunoise_flags INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=0)
endif()
if(IMUNOISE_SANITIZE MATCHES "undefined")
  # Checks of every pointer make templates of matrices several times slower; AddressSanitizer and Eigen's own
  # assertions watch their bounds.
  target_compile_options(imunoise_flags INTERFACE
    "$<$<BOOL:$<TARGET_PROPERTY:IMUNOISE_MATRICES>>:-fno-sanitize=null,object-size,pointer-overflow,alignment>")
endif()

# imunoise_room(NAME SOURCES ... USES ...): a static library imunoise_NAME, alias imunoise::NAME.
# USES lists what its headers or sources include: the link graph is the layering.
function(imunoise_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;USES" ${ARGN})
  add_library(imunoise_${name} STATIC ${ROOM_SOURCES})
  add_library(imunoise::${name} ALIAS imunoise_${name})
  # A driver or the Python module, shared objects, may contain it.
  set_target_properties(imunoise_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_link_libraries(imunoise_${name} PUBLIC imunoise_flags ${ROOM_USES})
  if(name MATCHES "^(recording|drivers)_|^core_(support|process|model|effect|integrity|stillness)$|^study_(batch|cache|calibration_file|file)$|^daemon_(access|config)$")
    set_target_properties(imunoise_${name} PROPERTIES IMUNOISE_PARSES ON)  # bytes from outside
  elseif(name MATCHES "^core_")
    set_target_properties(imunoise_${name} PROPERTIES IMUNOISE_MATRICES ON)
  endif()
endfunction()

# imunoise_plugin(NAME SOURCES ... USES ...): the driver lib/imunoise/drivers/imunoise-NAME.so of the
# build tree, target imunoise_plugin_NAME.
function(imunoise_plugin name)
  cmake_parse_arguments(PLUGIN "" "" "SOURCES;USES" ${ARGN})
  set(target imunoise_plugin_${name})
  add_library(${target} MODULE ${PLUGIN_SOURCES})
  target_link_libraries(${target} PRIVATE imunoise_flags imunoise::driver ${PLUGIN_USES})
  # Plugins show one function; what they contain of ours does not meet the program's own copy.
  target_link_options(${target} PRIVATE -Wl,--exclude-libs,ALL)
  set_target_properties(${target} PROPERTIES
    PREFIX "" OUTPUT_NAME imunoise-${name} CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/imunoise/drivers
    INSTALL_RPATH "$ORIGIN/..")
  add_dependencies(imunoise_plugins ${target})
  install(TARGETS ${target} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/imunoise/drivers)
endfunction()

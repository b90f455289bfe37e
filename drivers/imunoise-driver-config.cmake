# find_package(imunoise-driver): the headers that a driver outside of imunoise's tree is built against.
#
#   imunoise::driver                  link a driver to it
#   imunoise_add_driver(NAME SOURCES) makes imunoise-NAME.so, target NAME
get_filename_component(_imunoise_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

if(NOT TARGET imunoise::driver)
  add_library(imunoise::driver INTERFACE IMPORTED)
  set_target_properties(imunoise::driver PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${_imunoise_prefix}/include/imunoise"
    INTERFACE_COMPILE_FEATURES cxx_std_20)
endif()

function(imunoise_add_driver name)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE imunoise::driver)
  set_target_properties(${name} PROPERTIES
    PREFIX "" OUTPUT_NAME imunoise-${name} CXX_VISIBILITY_PRESET hidden C_VISIBILITY_PRESET hidden)
endfunction()

# A table of what a room has several of (log formats, cloud messages), one source each: of every source
# src/<prefix>_<name>.cpp the function <type> <prefix>_<name>() is declared and called by a generated source that defines
# `std::vector<TYPE> FUNCTION()`. Sources register themselves by being there, in any link order.
#
#   loopmark_table(io PREFIX format TYPE DriveLogFormat FUNCTION all_log_formats NAMESPACE loopmark::io HEADER x.hpp)
function(loopmark_table ROOM)
  cmake_parse_arguments(TABLE "" "PREFIX;TYPE;FUNCTION;NAMESPACE;HEADER" "" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/${TABLE_PREFIX}_*.cpp)
  set(declared "")
  set(called "")
  foreach(source IN LISTS sources)
    get_filename_component(name ${source} NAME_WE)
    string(APPEND declared "${TABLE_TYPE} ${name}();\n")
    string(APPEND called "${name}(), ")
  endforeach()
  set(text "// Made by cmake/LoopmarkTable.cmake.\n#include \"${TABLE_HEADER}\"\n\nnamespace ${TABLE_NAMESPACE} {\n\n")
  string(APPEND text "${declared}std::vector<${TABLE_TYPE}> ${TABLE_FUNCTION}();\n")
  string(APPEND text "std::vector<${TABLE_TYPE}> ${TABLE_FUNCTION}() { return {${called}}; }\n\n}\n")
  set(file ${CMAKE_CURRENT_BINARY_DIR}/${TABLE_PREFIX}_table.cpp)
  file(CONFIGURE OUTPUT ${file} CONTENT "${text}" @ONLY)
  target_sources(loopmark_${ROOM} PRIVATE ${file})
  target_include_directories(loopmark_${ROOM} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src)
endfunction()

# Installation, the package that find_package(loopmark) finds, and the Debian packages.
include(CMakePackageConfigHelpers)

# What stands behind a linked target: the arguments of find_dependency (none: the linker finds it), and the Debian package with its headers.
# A target that no row matches ends the configuration, so that the installed package cannot miss a dependency.
set(LOOPMARK_DEPENDENCIES
  "^Eigen3::|Eigen3 3.4|libeigen3-dev"
  "^TBB::|TBB|libtbb-dev"
  "^Threads::|Threads|"
  "^Ceres::|Ceres 2.1|libceres-dev"
  "^nanoflann::|nanoflann|libnanoflann-dev"
  "^nlohmann_json::|nlohmann_json|nlohmann-json3-dev"
  "^yaml-cpp|yaml-cpp|libyaml-cpp-dev"
  "^PNG::|PNG|libpng-dev"
  "^ZLIB::|ZLIB|zlib1g-dev"
  "^lz4$||liblz4-dev"
  "^BZip2::|BZip2|libbz2-dev"
  "^SQLite::|SQLite3|libsqlite3-dev"
  "^zstd::|zstd|libzstd-dev"
  "^hwy::|hwy|libhwy-dev"
  "^kissfft::|kissfft COMPONENTS float|libkissfft-dev"
  "^cpp-httplib$||libcpp-httplib-dev"
  "^embree|embree 3|libembree-dev"
  "octomap|octomap|liboctomap-dev"
  "octomath|octomap|liboctomap-dev"
  "^mrpt::([a-z]+)|mrpt-\\1|libmrpt-\\1-dev"
  "pcl_|PCL|libpcl-dev")

set(find_lines "")
set(debian_dependencies "")
get_property(linked GLOBAL PROPERTY LOOPMARK_LINKED)
list(REMOVE_DUPLICATES linked)
foreach(target IN LISTS linked)
  set(known FALSE)
  foreach(row IN LISTS LOOPMARK_DEPENDENCIES)
    string(REPLACE "|" ";" row "${row}")
    list(GET row 0 pattern)
    if(target MATCHES "${pattern}")
      set(name "${CMAKE_MATCH_1}")
      list(GET row 1 arguments)
      list(GET row 2 debian)
      string(REPLACE "\\1" "${name}" arguments "${arguments}")
      string(REPLACE "\\1" "${name}" debian "${debian}")
      if(arguments)
        list(APPEND find_lines "find_dependency(${arguments})")
      endif()
      list(APPEND debian_dependencies ${debian})
      set(known TRUE)
      break()
    endif()
  endforeach()
  if(NOT known)
    message(FATAL_ERROR "${target} is linked by a room but stands in no row of cmake/LoopmarkInstall.cmake")
  endif()
endforeach()
list(REMOVE_DUPLICATES find_lines)
list(REMOVE_DUPLICATES debian_dependencies)
list(JOIN find_lines "\n" LOOPMARK_FIND_DEPENDENCIES)
list(JOIN debian_dependencies ", " LOOPMARK_DEBIAN_DEPENDENCIES)

# loopmark::loopmark is all rooms at once.
get_property(rooms GLOBAL PROPERTY LOOPMARK_ROOMS)
add_library(loopmark_all INTERFACE)
set_target_properties(loopmark_all PROPERTIES EXPORT_NAME loopmark)
add_library(loopmark::loopmark ALIAS loopmark_all)
set(targets loopmark_all)
foreach(room IN LISTS rooms)
  target_link_libraries(loopmark_all INTERFACE loopmark_${room})
  list(APPEND targets loopmark_${room})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/libs/${room}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    COMPONENT development)
endforeach()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/loopmark)
install(TARGETS ${targets} EXPORT loopmark-targets ARCHIVE COMPONENT development)
install(EXPORT loopmark-targets NAMESPACE loopmark:: DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/loopmark-config.cmake.in
  ${PROJECT_BINARY_DIR}/loopmark-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/loopmark-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/loopmark-config.cmake ${PROJECT_BINARY_DIR}/loopmark-config-version.cmake
  DESTINATION ${package_dir} COMPONENT development)

install(TARGETS loopmark RUNTIME COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/loopmark/config
  COMPONENT program FILES_MATCHING PATTERN "*.yaml")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libloopmark-dev
  RENAME copyright COMPONENT development)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DOCDIR}
  COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

# Manual pages and completion of commands, from what the program says of itself.
find_package(Python3 QUIET COMPONENTS Interpreter)
if(Python3_FOUND)
  set(manual_dir ${PROJECT_BINARY_DIR}/manual)
  add_custom_command(OUTPUT ${manual_dir}/completions/loopmark
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/scripts/make_manual.py $<TARGET_FILE:loopmark> ${manual_dir}
    DEPENDS loopmark ${PROJECT_SOURCE_DIR}/scripts/make_manual.py ${PROJECT_SOURCE_DIR}/CHANGELOG.md
    COMMENT "Writing manual pages and completion")
  add_custom_target(loopmark_manual ALL DEPENDS ${manual_dir}/completions/loopmark)
  install(DIRECTORY ${manual_dir}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
  install(FILES ${manual_dir}/completions/loopmark DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    COMPONENT program)
  install(FILES ${manual_dir}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
endif()

set(CPACK_PACKAGE_NAME loopmark)
set(CPACK_PACKAGE_VENDOR "loopmark contributors")
set(CPACK_PACKAGE_CONTACT "loopmark contributors <loopmark@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME loopmark)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libloopmark-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${LOOPMARK_DEBIAN_DEPENDENCIES}")
include(CPack)

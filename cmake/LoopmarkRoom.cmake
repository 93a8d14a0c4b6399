# One room of the house: a static library libs/<room> with its own include/loopmark/<room>/ and src/, and the
# test program tests/<room>/*_test.cpp beside it.
#
#   loopmark_room(NAME DEPS core cloud PUBLIC Eigen3::Eigen PRIVATE TBB::tbb TEST_LIBS ...)
#
# DEPS are rooms and may stand in public headers; PRIVATE libraries stay inside src/.
function(loopmark_room NAME)
  cmake_parse_arguments(ROOM "" "" "DEPS;PUBLIC;PRIVATE;TEST_LIBS" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/src/*.cpp)
  list(TRANSFORM ROOM_DEPS PREPEND loopmark_ OUTPUT_VARIABLE deps)
  set(target loopmark_${NAME})
  if(sources)
    add_library(${target} STATIC ${sources})
    set(scope PUBLIC)
    target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:loopmark_warnings> ${ROOM_PRIVATE})
  else()
    add_library(${target} INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(loopmark::${NAME} ALIAS ${target})
  target_include_directories(${target} ${scope}
    $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} ${scope} ${deps} ${ROOM_PUBLIC})
  target_compile_features(${target} ${scope} cxx_std_20)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${NAME})
  set_property(GLOBAL APPEND PROPERTY LOOPMARK_ROOMS ${NAME})
  set_property(GLOBAL APPEND PROPERTY LOOPMARK_LINKED ${ROOM_PUBLIC} ${ROOM_PRIVATE})
  loopmark_test_program(${NAME} LIBS ${target} ${ROOM_TEST_LIBS})
endfunction()

# The test program test_<name> of tests/<name>/*_test.cpp, if there are any.
function(loopmark_test_program NAME)
  cmake_parse_arguments(TEST "" "" "LIBS" ${ARGN})
  file(GLOB tests CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tests/${NAME}/*_test.cpp)
  if(NOT LOOPMARK_BUILD_TESTS OR NOT tests)
    return()
  endif()
  add_executable(test_${NAME} ${tests})
  target_link_libraries(test_${NAME} PRIVATE loopmark_warnings ${TEST_LIBS} GTest::gmock GTest::gtest_main)
  target_include_directories(test_${NAME} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(test_${NAME} PRIVATE
    LOOPMARK_SHARED_DIR="${LOOPMARK_SHARED_DIR}" LOOPMARK_TEST_DATA_DIR="${PROJECT_BINARY_DIR}/test_data"
    LOOPMARK_SOURCE_DIR="${PROJECT_SOURCE_DIR}" LOOPMARK_BINARY="$<TARGET_FILE_DIR:loopmark>/loopmark")
  gtest_discover_tests(test_${NAME} TEST_PREFIX ${NAME}. DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 600)
endfunction()

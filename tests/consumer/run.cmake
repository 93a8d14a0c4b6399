# Installs the build in BUILD_DIR below WORK_DIR, then configures, builds and runs the project in CONSUMER_DIR.
file(REMOVE_RECURSE ${WORK_DIR})

function(run_step)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

run_step(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/prefix)
run_step(${CMAKE_COMMAND} -S ${CONSUMER_DIR} -B ${WORK_DIR}/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_C_COMPILER=${C_COMPILER} -DCMAKE_CXX_COMPILER=${CXX_COMPILER})
run_step(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run_step(${WORK_DIR}/prefix/bin/loopmark --quiet simulate --length 60 --sensor vlp16 -o ${WORK_DIR}/log)
run_step(${WORK_DIR}/build/consumer ${WORK_DIR})
if(NOT output MATCHES "mapped [1-9].*placed [1-9].*standing_still: P")
  message(FATAL_ERROR "the consumer printed: ${output}")
endif()
run_step(${WORK_DIR}/prefix/bin/loopmark --version)
message("${output}")

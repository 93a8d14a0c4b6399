# The script and the style of the pages that the program writes: web/src with its npm packages, bundled by esbuild and
# embedded in the program. Where the tools or the packages are missing the program builds all the same; its pages then
# hold words only and say what they lack.
option(LOOPMARK_WEB "Bundle the pages' script (needs node, npm, esbuild and, once, the network)" ON)

# Puts the packages of web/package-lock.json into the build folder, unless they are there. Sets `problem` in the caller.
function(loopmark_npm_packages FOLDER)
  set(source ${PROJECT_SOURCE_DIR}/web)
  set(omit --omit=dev)
  if(LOOPMARK_BUILD_TESTS)
    set(omit "")
  endif()
  file(SHA256 ${source}/package-lock.json wanted)
  string(APPEND wanted "${omit}")
  set(stamp ${FOLDER}/packages.stamp)
  if(EXISTS ${stamp})
    file(READ ${stamp} there)
    if(there STREQUAL wanted)
      return()
    endif()
  endif()
  file(COPY ${source}/package.json ${source}/package-lock.json ${source}/.npmrc DESTINATION ${FOLDER})
  message(STATUS "Fetching the npm packages of the pages")
  execute_process(COMMAND ${LOOPMARK_NPM} ci --ignore-scripts --prefer-offline --fetch-retries=1 --fetch-timeout=30000
      --loglevel=error ${omit}
    WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE failed OUTPUT_FILE ${FOLDER}/npm.log ERROR_FILE ${FOLDER}/npm.log TIMEOUT 300)
  if(failed)
    message(STATUS "npm failed: see ${FOLDER}/npm.log")
    set(problem "npm could not fetch the packages of web/package-lock.json when the program was built" PARENT_SCOPE)
    return()
  endif()
  file(WRITE ${stamp} "${wanted}")
endfunction()

# Adds the bundle, or what explains its absence, to a target.
function(loopmark_web_bundle TARGET)
  set(folder ${PROJECT_BINARY_DIR}/web)
  set(problem "")
  if(LOOPMARK_WEB)
    foreach(tool IN ITEMS node npm esbuild)
      string(TOUPPER LOOPMARK_${tool} variable)
      find_program(${variable} ${tool})
      if(NOT ${variable})
        set(problem "${tool} was not found when the program was built")
      endif()
    endforeach()
    if(NOT problem)
      file(MAKE_DIRECTORY ${folder})
      loopmark_npm_packages(${folder})
    endif()
  else()
    set(problem "the program was built with LOOPMARK_WEB=OFF")
  endif()
  set_property(GLOBAL PROPERTY LOOPMARK_WEB_PROBLEM "${problem}")
  set(embedded ${folder}/bundle_data.cpp)
  set(embed ${PROJECT_SOURCE_DIR}/cmake/embed_bundle.cmake)
  if(problem)
    message(STATUS "Pages will hold words only: ${problem}")
    add_custom_command(OUTPUT ${embedded} DEPENDS ${embed} VERBATIM
      COMMAND ${CMAKE_COMMAND} -DOUTPUT=${embedded} "-DPROBLEM=${problem}" -P ${embed})
  else()
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/web/src/*.ts ${PROJECT_SOURCE_DIR}/web/src/*.css)
    add_custom_command(OUTPUT ${embedded} DEPENDS ${sources} ${embed} ${folder}/packages.stamp VERBATIM
      COMMAND ${CMAKE_COMMAND} -E rm -rf ${folder}/src
      COMMAND ${CMAKE_COMMAND} -E copy_directory ${PROJECT_SOURCE_DIR}/web/src ${folder}/src
      COMMAND ${LOOPMARK_ESBUILD} src/main.ts src/page.css --bundle --minify --target=es2020 --format=iife
        --charset=utf8 --log-level=warning --outdir=out
      COMMAND ${CMAKE_COMMAND} -DOUTPUT=${embedded} -DFOLDER=${folder} -P ${embed}
      WORKING_DIRECTORY ${folder} COMMENT "Bundling the pages' script")
    install(FILES ${folder}/licences.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME licences-of-pages.txt
      COMPONENT program)
  endif()
  target_sources(${TARGET} PRIVATE ${embedded})
endfunction()

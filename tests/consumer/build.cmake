# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=... -DFOLDER=... -DSETTINGS=file that sets ARGUMENTS [-DINSTALL_FROM=build folder] -P build.cmake
# Configures, builds and tests the project SOURCE in FOLDER; with INSTALL_FROM after installing that build, moving it to
# FOLDER/prefix, and with nothing else known of it.
cmake_minimum_required(VERSION 3.25)
include(${SETTINGS})
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${FOLDER}/prefix)
if(INSTALL_FROM)
  run(${CMAKE_COMMAND} --install ${INSTALL_FROM} --prefix ${FOLDER}/installed_here)
  file(RENAME ${FOLDER}/installed_here ${FOLDER}/prefix)
  list(APPEND ARGUMENTS -DCMAKE_PREFIX_PATH=${FOLDER}/prefix)
  if(EXISTS ${FOLDER}/prefix/bin/vdbfuse)
    run(${FOLDER}/prefix/bin/vdbfuse --version)
  endif()
endif()
run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${FOLDER}/build --fresh ${ARGUMENTS})
run(${CMAKE_COMMAND} --build ${FOLDER}/build)
run(${CMAKE_CTEST_COMMAND} --test-dir ${FOLDER}/build --output-on-failure --no-tests=error)
message(STATUS "${output}")

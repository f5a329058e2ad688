# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# cmake -DLAYERS=... -P check_layer_refuses.cmake
# Stops unless vdbfuse_check_layer(), which every vdbfuse_module() calls at configure time, refuses what it must.
if(DEFINED USER)
  include(${LAYERS})
  vdbfuse_check_layer(${USER} ${USED})
  return()
endif()

function(expect USER USED MESSAGE)
  execute_process(COMMAND ${CMAKE_COMMAND} -DLAYERS=${LAYERS} -DUSER=${USER} -DUSED=${USED} -P ${CMAKE_SCRIPT_MODE_FILE}
                  RESULT_VARIABLE result ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  string(FIND "${output}" "${MESSAGE}" position)
  if(MESSAGE STREQUAL "" AND NOT result EQUAL 0)
    message(FATAL_ERROR "${USER} may use ${USED}, but: ${output}")
  elseif(NOT MESSAGE STREQUAL "" AND (result EQUAL 0 OR position EQUAL -1))
    message(FATAL_ERROR "${USER} uses ${USED}\nexpected: ${MESSAGE}\nfound (${result}): ${output}")
  endif()
endfunction()

expect(base fusion "module 'base' (floor 0) must not use 'fusion' (floor 4)")
expect(io octree "module 'io' (floor 3) must not use 'octree' (floor 3)")
expect(fusion nowhere "module 'nowhere' is not in the table of floors")
expect(fusion base "")

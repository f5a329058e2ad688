# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# cmake -DCHECK=check_includes.cmake -DFOLDER=... -P check_includes_finds.cmake
# Plants violations in a tiny tree and stops unless the check names each of them, and nothing else.
file(REMOVE_RECURSE ${FOLDER})
file(WRITE ${FOLDER}/layers.cmake [[
set(VDBFUSE_LAYERS 0:low 1:left 1:right)
function(vdbfuse_floor MODULE OUT)
  foreach(entry IN LISTS VDBFUSE_LAYERS)
    if(entry MATCHES "^([0-9]+):${MODULE}$")
      set(${OUT} ${CMAKE_MATCH_1} PARENT_SCOPE)
    endif()
  endforeach()
endfunction()
]])
file(WRITE ${FOLDER}/depends.cmake "set(VDBFUSE_DEPENDS_left low)\n")

# Runs the check on one file with one line; sets OUTPUT, with all white space made single blanks, and RESULT.
function(run_check FILE LINE)
  file(REMOVE_RECURSE ${FOLDER}/tree)
  file(WRITE ${FOLDER}/tree/${FILE} "// first line [; ]\n${LINE}\n")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -DROOT=${FOLDER}/tree -DLAYERS=${FOLDER}/layers.cmake -DDEPENDS=${FOLDER}/depends.cmake -P
            ${CHECK} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  set(RESULT ${result} PARENT_SCOPE)
  set(OUTPUT "${output}" PARENT_SCOPE)
endfunction()

function(expect_refusal FILE LINE MESSAGE)
  run_check(${FILE} "${LINE}")
  string(FIND "${OUTPUT}" "${FILE}:2: ${MESSAGE}" position)
  if(RESULT EQUAL 0 OR position EQUAL -1)
    message(FATAL_ERROR "${FILE} with ${LINE}\nexpected: ${MESSAGE}\nfound (${RESULT}): ${OUTPUT}")
  endif()
endfunction()

function(expect_acceptance FILE LINE)
  run_check(${FILE} "${LINE}")
  if(NOT RESULT EQUAL 0)
    message(FATAL_ERROR "${FILE} with ${LINE}\nexpected nothing, found: ${OUTPUT}")
  endif()
endfunction()

expect_refusal(lib/low/a.cpp "#include \"vdbfuse/left/b.h\"" "'low' (floor 0) includes 'left' (floor 1)")
expect_refusal(lib/low/a.cpp "#include \"left/b.h\"" "'low' (floor 0) includes 'left' (floor 1)")
expect_refusal(lib/left/a.cpp "  # include <vdbfuse/right/b.h>" "'left' (floor 1) includes 'right' (floor 1)")
expect_refusal(include/vdbfuse/right/a.h "#include \"vdbfuse/low/b.h\"" "'right' includes 'low', which is not in")
expect_refusal(include/vdbfuse/left/a.h "#include <openvdb/openvdb.h>" "a public header includes <openvdb/openvdb.h>")
expect_refusal(lib/left/a.cpp "#include \"nowhere/b.h\"" "'nowhere' is no module")
expect_acceptance(lib/left/a.cpp "#include \"vdbfuse/low/b.h\"")
expect_acceptance(lib/left/a.cpp "#include \"left/b.h\"")
expect_acceptance(lib/left/a.cpp "#include <openvdb/openvdb.h>")
expect_acceptance(include/vdbfuse/left/a.h "#include <Eigen/Core>")
expect_acceptance(include/vdbfuse/left/a.h "#include <vector>")
expect_acceptance(include/vdbfuse/left/a.h "#include <stdint.h>")

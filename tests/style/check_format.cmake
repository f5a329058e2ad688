# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# cmake -DROOT=... -DCLANG_FORMAT=... -P check_format.cmake
# Stops unless clang-format would leave every C++ file as it is.
file(GLOB_RECURSE files LIST_DIRECTORIES false ${ROOT}/include/*.h ${ROOT}/lib/*.h ${ROOT}/lib/*.cpp ${ROOT}/tools/*.h
     ${ROOT}/tools/*.cpp ${ROOT}/tests/*.h ${ROOT}/tests/*.cpp ${ROOT}/examples/*.cpp)
execute_process(COMMAND ${CLANG_FORMAT} --dry-run -Werror --style=file ${files} RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "run: clang-format -i on the files named above")
endif()

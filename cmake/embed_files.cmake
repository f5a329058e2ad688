# SPDX-License-Identifier: Apache-2.0
cmake_minimum_required(VERSION 3.25)
# cmake -DOUT=x.cpp -DHEADER=x.h -DNAMESPACE=n -DENTRIES="function=file+file|function=|..." -P embed_files.cmake
# Writes a C++ file whose functions (std::string_view f(), declared in HEADER) return what is in the files, one after
# the other; an entry without files becomes empty text.
string(REPLACE "|" ";" entries "${ENTRIES}")
set(text "// Made by cmake/embed_files.cmake.\n#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n")
foreach(entry IN LISTS entries)
  string(REGEX MATCH "^([A-Za-z0-9_]+)=(.*)$" matched "${entry}")
  if(NOT matched)
    message(FATAL_ERROR "expected function=file+file, found '${entry}'")
  endif()
  set(function ${CMAKE_MATCH_1})
  string(REPLACE "+" ";" files "${CMAKE_MATCH_2}")
  set(bytes "")
  foreach(file IN LISTS files)
    file(READ "${file}" hex HEX)
    string(APPEND bytes "${hex}0a")
  endforeach()
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND text "static constexpr unsigned char k_${function}[] = {${bytes}0};\n"
         "std::string_view ${function}() {\n"
         "  return {reinterpret_cast<const char*>(k_${function}), sizeof k_${function} - 1};\n}\n")
endforeach()
file(WRITE "${OUT}" "${text}}  // namespace ${NAMESPACE}\n")

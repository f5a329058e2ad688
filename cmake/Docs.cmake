# SPDX-License-Identifier: Apache-2.0
# The target vdbfuse_docs: all pages and public headers as HTML in build/docs/html; a warning is an error.
find_package(Doxygen)
if(NOT DOXYGEN_FOUND)
  return()
endif()
configure_file(${PROJECT_SOURCE_DIR}/cmake/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
add_custom_target(vdbfuse_docs COMMAND Doxygen::doxygen ${PROJECT_BINARY_DIR}/Doxyfile VERBATIM
                  COMMENT "Pages and headers to docs/html")

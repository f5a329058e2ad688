# SPDX-License-Identifier: Apache-2.0
# Sets VDBFUSE_VERSION and VDBFUSE_SOVERSION to what include/vdbfuse/base/version.h says.
set(version_header ${CMAKE_CURRENT_LIST_DIR}/../include/vdbfuse/base/version.h)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${version_header})
foreach(name VDBFUSE_VERSION VDBFUSE_SOVERSION)
  file(STRINGS ${version_header} line REGEX "#define ${name} ")
  if(NOT line MATCHES "\"([0-9.]+)\"")
    message(FATAL_ERROR "${version_header} does not define ${name} as a version")
  endif()
  set(${name} ${CMAKE_MATCH_1})
endforeach()

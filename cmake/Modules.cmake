# SPDX-License-Identifier: Apache-2.0
include(Layers)
include(Precompile)

# Flags of everything we compile; nothing of it reaches a project that adds us as a subdirectory.
add_library(vdbfuse_flags INTERFACE)
target_compile_features(vdbfuse_flags INTERFACE cxx_std_20)
target_compile_options(vdbfuse_flags INTERFACE -Wall -Wextra -Wshadow -Wpedantic
                                               $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor>
                                               $<$<BOOL:${VDBFUSE_WERROR}>:-Werror>)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 warns of std::string's own code at -O3 (its bugs 105329, 105651), by more names when it comes precompiled.
  target_compile_options(vdbfuse_flags INTERFACE -Wno-restrict
                                                 $<$<BOOL:${VDBFUSE_PRECOMPILE}>:-Wno-stringop-overflow>
                                                 $<$<BOOL:${VDBFUSE_PRECOMPILE}>:-Wno-stringop-overread>
                                                 $<$<BOOL:${VDBFUSE_PRECOMPILE}>:-Wno-array-bounds>)
endif()
if(VDBFUSE_SANITIZE)
  target_compile_options(vdbfuse_flags INTERFACE -fsanitize=${VDBFUSE_SANITIZE} -fno-omit-frame-pointer
                                                 -fno-sanitize-recover=all)
  # g++ 12 takes std::regex's own members for uninitialized when it instruments them.
  target_compile_options(vdbfuse_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(vdbfuse_flags INTERFACE -fsanitize=${VDBFUSE_SANITIZE})
endif()

# The core library: every module adds its sources to it.
add_library(vdbfuse)
add_library(vdbfuse::vdbfuse ALIAS vdbfuse)
set_target_properties(vdbfuse PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${VDBFUSE_SOVERSION}
                                         POSITION_INDEPENDENT_CODE ON)
if(NOT BUILD_SHARED_LIBS)
  # What CMake defines for shared libraries: the same commands, so that a compiler cache serves both kinds.
  target_compile_definitions(vdbfuse PRIVATE vdbfuse_EXPORTS)
endif()
target_compile_features(vdbfuse PUBLIC cxx_std_20)
target_include_directories(
  vdbfuse
  PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
  PRIVATE ${PROJECT_SOURCE_DIR}/lib)
target_link_libraries(vdbfuse PUBLIC Eigen3::Eigen Threads::Threads PRIVATE $<BUILD_INTERFACE:vdbfuse_flags>)
vdbfuse_precompile(vdbfuse)

# vdbfuse_module(NAME [DEPENDS module...] SOURCES file... [LINK target...])
# Adds a module's sources to the core library and checks its dependencies against the floors.
function(vdbfuse_module NAME)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "DEPENDS;SOURCES;LINK")
  foreach(used IN LISTS arg_DEPENDS)
    vdbfuse_check_layer(${NAME} ${used})
  endforeach()
  set_property(GLOBAL PROPERTY VDBFUSE_DEPENDS_${NAME} ${arg_DEPENDS})
  list(TRANSFORM arg_SOURCES PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/)
  target_sources(vdbfuse PRIVATE ${arg_SOURCES})
  target_link_libraries(vdbfuse PRIVATE ${arg_LINK})
endfunction()

# vdbfuse_library_module(NAME [DEPENDS module...] SOURCES file... [LINK target...] [PUBLIC_LINK target...])
# A module in a library of its own, vdbfuse_NAME (vdbfuse::NAME), so that who does not use it does not load what it
# needs. Always shared: the core library opens it when it is asked for.
function(vdbfuse_library_module NAME)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "DEPENDS;SOURCES;LINK;PUBLIC_LINK")
  foreach(used IN LISTS arg_DEPENDS)
    vdbfuse_check_layer(${NAME} ${used})
  endforeach()
  set_property(GLOBAL PROPERTY VDBFUSE_DEPENDS_${NAME} ${arg_DEPENDS})
  add_library(vdbfuse_${NAME} SHARED ${arg_SOURCES})
  add_library(vdbfuse::${NAME} ALIAS vdbfuse_${NAME})
  set_target_properties(
    vdbfuse_${NAME} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${VDBFUSE_SOVERSION} EXPORT_NAME ${NAME}
                               LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
  target_include_directories(vdbfuse_${NAME} PRIVATE ${PROJECT_SOURCE_DIR}/lib)
  target_link_libraries(vdbfuse_${NAME} PUBLIC vdbfuse::vdbfuse ${arg_PUBLIC_LINK}
                        PRIVATE $<BUILD_INTERFACE:vdbfuse_flags> ${arg_LINK})
endfunction()

# vdbfuse_module_tests(NAME SOURCES file... [LINK target...])
# One test program a module; ctest names each test by its sentence.
function(vdbfuse_module_tests NAME)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LINK")
  include(GoogleTest)
  add_executable(vdbfuse_test_${NAME} ${arg_SOURCES})
  target_link_libraries(vdbfuse_test_${NAME} PRIVATE vdbfuse::vdbfuse vdbfuse_flags GTest::gtest_main GTest::gmock
                                                     ${arg_LINK})
  target_include_directories(vdbfuse_test_${NAME} PRIVATE ${PROJECT_SOURCE_DIR}/tests ${PROJECT_SOURCE_DIR}/lib)
  target_compile_definitions(vdbfuse_test_${NAME} PRIVATE VDBFUSE_SHARED_DATA="${PROJECT_SOURCE_DIR}/../shared/data")
  vdbfuse_optimise_less(vdbfuse_test_${NAME})
  vdbfuse_precompile_tests(vdbfuse_test_${NAME})
  gtest_discover_tests(vdbfuse_test_${NAME} PROPERTIES LABELS unit DISCOVERY_TIMEOUT 60)
endfunction()

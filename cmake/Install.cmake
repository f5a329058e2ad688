# SPDX-License-Identifier: Apache-2.0
# cmake --install: libraries, public headers, the tool, a CMake package, so that find_package(vdbfuse CONFIG) gives
# vdbfuse::vdbfuse and, where it was built, vdbfuse::pcl, and vdbfuse.pc for pkg-config. Nothing in them knows where it
# lies: the folder may be moved as a whole.
# Components: runtime, development, tool, pcl, pcl_development, python; each is a Debian package (Packages.cmake). What names none
# belongs to the tool.
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME tool)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/vdbfuse)

# Libraries find each other beside themselves; the packages' ones, in /usr, as all others do.
function(vdbfuse_install_rpath TARGET FOLDER)
  if(NOT VDBFUSE_PACKAGES)
    file(RELATIVE_PATH to_libraries /${FOLDER} /${CMAKE_INSTALL_LIBDIR})
    cmake_path(APPEND origin "$ORIGIN" ${to_libraries})
    set_target_properties(${TARGET} PROPERTIES INSTALL_RPATH "${origin}")
  endif()
endfunction()

# vdbfuse_install_library(TARGET EXPORT COMPONENT DEVELOPMENT): with its link without a version, and its export.
function(vdbfuse_install_library TARGET EXPORT COMPONENT DEVELOPMENT)
  vdbfuse_install_rpath(${TARGET} ${CMAKE_INSTALL_LIBDIR})
  install(
    TARGETS ${TARGET} EXPORT ${EXPORT}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${COMPONENT} NAMELINK_COMPONENT ${DEVELOPMENT}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${DEVELOPMENT})
  install(EXPORT ${EXPORT} NAMESPACE vdbfuse:: DESTINATION ${package_dir} COMPONENT ${DEVELOPMENT})
endfunction()

vdbfuse_install_library(vdbfuse vdbfuseTargets runtime development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/vdbfuse DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.h" PATTERN pcl EXCLUDE)
if(TARGET vdbfuse_pcl)
  vdbfuse_install_library(vdbfuse_pcl vdbfusePclTargets pcl pcl_development)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/vdbfuse/pcl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vdbfuse
          COMPONENT pcl_development)
endif()
if(TARGET vdbfuse_tool)
  vdbfuse_install_rpath(vdbfuse_tool ${CMAKE_INSTALL_BINDIR})
  install(TARGETS vdbfuse_tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tool)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/share/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tool
          FILES_MATCHING PATTERN "*.1")
  install(FILES ${PROJECT_BINARY_DIR}/share/vdbfuse.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
          RENAME vdbfuse COMPONENT tool)
  install(FILES ${PROJECT_BINARY_DIR}/share/_vdbfuse DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
          COMPONENT tool)
endif()

if(TARGET vdbfuse_python)
  # Where Debian's python3 looks: /usr/lib/python3 is for packages, /usr/local/lib/python3.11 for everybody.
  set(python_version "")
  if(NOT VDBFUSE_PACKAGES)
    set(python_version .${Python3_VERSION_MINOR})
  endif()
  set(python_dir lib/python3${python_version}/dist-packages/vdbfuse)
  vdbfuse_install_rpath(vdbfuse_python ${python_dir})
  get_target_property(python_files vdbfuse_python VDBFUSE_FILES)
  install(TARGETS vdbfuse_python LIBRARY DESTINATION ${python_dir} COMPONENT python)
  install(FILES ${python_files} DESTINATION ${python_dir} COMPONENT python)
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/vdbfuseConfig.cmake.in ${PROJECT_BINARY_DIR}/vdbfuseConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may break its users.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vdbfuseConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vdbfuseConfig.cmake ${PROJECT_BINARY_DIR}/vdbfuseConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT development)

# pkg-config. A static library hands on everything it was built with (--static), under the names that the linker knows.
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH prefix_from_pc /${pkgconfig_dir} /)
string(REGEX REPLACE "/$" "" prefix_from_pc ${prefix_from_pc})
set(private_libraries "")
if(NOT BUILD_SHARED_LIBS)
  set(private_libraries -lopenvdb -ltbb -lflann_cpp -llz4 -lembree3 -lmeshoptimizer -lhwy -lspng -lturbojpeg -ltiff
                        -lOpenEXR -lImath -lz -lzip -lpugixml -lstdc++ -lm -ldl)
  list(JOIN private_libraries " " private_libraries)
endif()
configure_file(${PROJECT_SOURCE_DIR}/cmake/vdbfuse.pc.in ${PROJECT_BINARY_DIR}/vdbfuse.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/vdbfuse.pc DESTINATION ${pkgconfig_dir} COMPONENT development)
if(VDBFUSE_THREE_DIR)  # a part of the library, then
  install(FILES ${PROJECT_SOURCE_DIR}/lib/report/page/three_licence.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}
          COMPONENT runtime)
endif()

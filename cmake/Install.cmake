# SPDX-License-Identifier: Apache-2.0
# cmake --install: libraries, public headers, the tool, and a CMake package, so that find_package(vdbfuse CONFIG)
# gives vdbfuse::vdbfuse and, where it was built, vdbfuse::pcl.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/vdbfuse)
file(RELATIVE_PATH lib_from_bin /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBDIR})

set_target_properties(vdbfuse PROPERTIES INSTALL_RPATH "$ORIGIN")
install(TARGETS vdbfuse EXPORT vdbfuseTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/vdbfuse DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING
        PATTERN "*.h" PATTERN pcl EXCLUDE)
install(EXPORT vdbfuseTargets NAMESPACE vdbfuse:: DESTINATION ${package_dir})

if(TARGET vdbfuse_pcl)
  set_target_properties(vdbfuse_pcl PROPERTIES INSTALL_RPATH "$ORIGIN")
  install(TARGETS vdbfuse_pcl EXPORT vdbfusePclTargets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/vdbfuse/pcl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/vdbfuse)
  install(EXPORT vdbfusePclTargets NAMESPACE vdbfuse:: DESTINATION ${package_dir})
endif()
if(TARGET vdbfuse_tool)
  set_target_properties(vdbfuse_tool PROPERTIES INSTALL_RPATH "$ORIGIN/${lib_from_bin}")
  install(TARGETS vdbfuse_tool RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/vdbfuseConfig.cmake.in ${PROJECT_BINARY_DIR}/vdbfuseConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor version may break its users.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vdbfuseConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vdbfuseConfig.cmake ${PROJECT_BINARY_DIR}/vdbfuseConfigVersion.cmake
        DESTINATION ${package_dir})
if(VDBFUSE_THREE_DIR)  # a part of the library, then
  install(FILES ${PROJECT_SOURCE_DIR}/lib/report/page/three_licence.txt DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()

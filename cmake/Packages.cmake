# SPDX-License-Identifier: Apache-2.0
# Debian packages of what Install.cmake installs, one a component, by: cmake --workflow --preset package
# They lie in build-package/: libvdbfuse, libvdbfuse-dev, vdbfuse, and, with PCL, libvdbfuse-pcl and libvdbfuse-pcl-dev,
# with Python, python3-vdbfuse.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "vdbfuse maintainers <maintainers@vdbfuse.invalid>" CACHE STRING "Maintainer of the packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
                                                WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

# What a program needs is found by what it is linked to; of each other's packages the same version.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY "=")
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)

string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # or that of SOURCE_DATE_EPOCH
configure_file(${PROJECT_SOURCE_DIR}/cmake/debian/changelog.in ${PROJECT_BINARY_DIR}/debian/changelog @ONLY)
find_program(VDBFUSE_GZIP gzip REQUIRED)
execute_process(COMMAND ${VDBFUSE_GZIP} -9nkf ${PROJECT_BINARY_DIR}/debian/changelog COMMAND_ERROR_IS_FATAL ANY)

# package(COMPONENT NAME SECTION SUMMARY TEXT [AFTER component...] [DEPENDS package...] [SUGGESTS package...])
# TEXT: lines of up to 79 characters.
function(package COMPONENT NAME SECTION SUMMARY TEXT)
  cmake_parse_arguments(PARSE_ARGV 5 arg "" "" "AFTER;DEPENDS;SUGGESTS")
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian/copyright ${PROJECT_BINARY_DIR}/debian/changelog.gz
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${NAME} COMPONENT ${COMPONENT})
  list(JOIN arg_DEPENDS ", " depends)
  list(JOIN arg_SUGGESTS ", " suggests)
  string(TOUPPER ${COMPONENT} key)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${COMPONENT} PARENT_SCOPE)
  set(CPACK_COMPONENT_${key}_DEPENDS ${arg_AFTER} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_NAME ${NAME} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SECTION ${SECTION} PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_DESCRIPTION "depth maps to watertight surfaces, ${SUMMARY}\n${TEXT}\n${about}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_DEPENDS "${depends}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${key}_PACKAGE_SUGGESTS "${suggests}" PARENT_SCOPE)
  if(SECTION STREQUAL "libs")
    set(CPACK_DEBIAN_${key}_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/triggers PARENT_SCOPE)
  endif()
endfunction()

set(CPACK_COMPONENTS_ALL "")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # it would come before each package's own
set(about ".
vdbfuse asks what every depth map says about every place, visible or hidden,
and finds the surface as the global minimum of an energy by a graph cut on an
octree. Fusion of truncated signed distances is there, too.")

package(runtime libvdbfuse libs "shared library" "What programs that use vdbfuse are linked to." SUGGESTS
        libvdbfuse-pcl)
package(development libvdbfuse-dev libdevel "for development"
        "Headers, a CMake package, a pkg-config file and examples." AFTER runtime DEPENDS "libeigen3-dev (>= 3.4)")
package(tool vdbfuse graphics "command line tool"
        "Reads what depth cameras, laser scanners and multi-view stereo write, or
photographs, and makes meshes of it; simulates scans and measures results." AFTER runtime SUGGESTS libvdbfuse-pcl)
if(TARGET vdbfuse_pcl)
  package(pcl libvdbfuse-pcl libs "bridge to PCL"
          "The Point Cloud Library's part: with it vdbfuse reads PCD files." AFTER runtime)
  package(pcl_development libvdbfuse-pcl-dev libdevel "bridge to PCL, for development"
          "Converts clouds and polygon meshes of the Point Cloud Library." AFTER development pcl DEPENDS libpcl-dev
          pkg-config)
endif()
if(TARGET vdbfuse_python)
  math(EXPR next_python "${Python3_VERSION_MINOR} + 1")
  package(python python3-vdbfuse python "for Python 3"
          "Takes depth maps as arrays of numpy, views from generators and data sets on
disk, and gives meshes as arrays." AFTER runtime DEPENDS "python3 (>= 3.${Python3_VERSION_MINOR})"
          "python3 (<< 3.${next_python})" python3-numpy SUGGESTS python3-matplotlib)
  # Compiled when installed, so that what Python makes of it goes with it.
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/python/postinst
                                                ${PROJECT_SOURCE_DIR}/cmake/debian/python/prerm)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples/python/
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/python3-vdbfuse/examples COMPONENT python FILES_MATCHING PATTERN "*.py"
          PATTERN "README.md")
endif()

# Manual pages are compressed in a package.
install(CODE "file(GLOB pages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man*/*.[0-9]\")
if(pages)
  execute_process(COMMAND \"${VDBFUSE_GZIP}\" -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()" COMPONENT tool)

# The examples, as a project that finds the installed package.
file(GLOB examples ${PROJECT_SOURCE_DIR}/examples/[0-9]*.cpp)
install(FILES ${examples} ${PROJECT_SOURCE_DIR}/examples/CMakeLists.txt ${PROJECT_SOURCE_DIR}/examples/README.md
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libvdbfuse-dev/examples COMPONENT development)
install(PROGRAMS ${PROJECT_SOURCE_DIR}/examples/10_evidence.sh ${PROJECT_SOURCE_DIR}/examples/11_ballooning.sh
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/libvdbfuse-dev/examples COMPONENT development)
include(CPack)

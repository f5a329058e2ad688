# SPDX-License-Identifier: Apache-2.0
# Every third-party package the project uses, found once. TBB comes first: OpenVDB's module defines TBB::tbb
# itself, and a later find_package(TBB CONFIG) would stop with "targets already defined".
# Global, so that a project that adds us as a subdirectory can link a static vdbfuse.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
find_package(TBB CONFIG REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 CONFIG REQUIRED)
find_package(PkgConfig REQUIRED)

# Debian keeps OpenVDB's find module in its multiarch library folder.
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
# It sets BUILD_SHARED_LIBS, which is ours to choose: only its targets leave the block.
block(SCOPE_FOR VARIABLES)
  find_package(OpenVDB REQUIRED)
endblock()

# flann's CMake target misses lz4; its pkg-config file would drag in MPI and HDF5.
find_package(flann CONFIG REQUIRED)
find_library(VDBFUSE_LZ4_LIBRARY lz4 REQUIRED)

find_package(hwy CONFIG REQUIRED)
find_package(embree 3 CONFIG REQUIRED)
find_package(meshoptimizer CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
pkg_check_modules(SPNG REQUIRED IMPORTED_TARGET GLOBAL spng)
find_package(libjpeg-turbo CONFIG REQUIRED)
find_package(TIFF REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(pugixml CONFIG REQUIRED)
pkg_check_modules(LIBZIP REQUIRED IMPORTED_TARGET GLOBAL libzip)

if(VDBFUSE_WITH_PCL)
  # find_package(PCL) drags in VTK and fails beside OpenVDB; the pkg-config targets work.
  pkg_check_modules(PCL_COMMON REQUIRED IMPORTED_TARGET GLOBAL pcl_common)
  pkg_check_modules(PCL_IO REQUIRED IMPORTED_TARGET GLOBAL pcl_io)
endif()
if(VDBFUSE_WITH_PYTHON)
  # The system's: its numpy and pybind11 are Debian's, another one first in the path does not have them.
  set(Python3_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python interpreter")
  find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter Development.Module NumPy)
  find_package(pybind11 2.10 CONFIG REQUIRED)
endif()
if(VDBFUSE_BUILD_TOOL)
  find_package(CLI11 CONFIG REQUIRED)
  find_package(tomlplusplus CONFIG REQUIRED)
endif()
if(VDBFUSE_BUILD_TESTS)
  find_package(GTest CONFIG REQUIRED)
  find_package(assimp CONFIG REQUIRED)
endif()

# A compiler cache, where there is one, makes clean builds cheap. It keeps files that use precompiled headers only if
# CCACHE_SLOPPINESS is pch_defines,time_macros (its manual, "Precompiled headers").
find_program(VDBFUSE_CCACHE ccache)
if(VDBFUSE_CCACHE AND PROJECT_IS_TOP_LEVEL AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${VDBFUSE_CCACHE})
endif()

# SPDX-License-Identifier: Apache-2.0
# The floors. A module may use modules of lower floors only: never upwards, never sideways. The configure step
# refuses a dependency that breaks this, tests/style refuses an #include that does.
#
#   floor:module  what it holds
set(VDBFUSE_LAYERS
    0:base        # errors, parallel loops, progress, seeded random numbers
    1:geometry    # rigid transforms, projections, boxes, images
    1:mincut      # network, solver, certificate
    2:sensor      # depth map, view, lazy sequence, noise models
    2:mesh        # triangles, topology, closest point, winding number
    2:volume      # OpenVDB grids, traversal, files
    3:io          # files: images, arrays, meshes, text
    3:stereo      # depth maps from photographs
    3:octree      # cells, grading, graph, labels
    3:evaluation  # accuracy, completeness, topology of a mesh against the truth
    3:synth       # synthetic scanner
    3:pcl         # bridge to the Point Cloud Library, a library of its own
    4:formats     # data sets of depth maps and of photographs, one pair of files a format
    4:fusion      # reliability, rho, sigma, TSDF
    4:surface     # field, mesh extraction
    4:report      # pictures, slices, pages
    5:pipeline    # the whole line in one function; the live Scanner
    6:capi        # the library for C
    6:python)     # the Python package, a library of its own

# Sets OUT to the floor of MODULE; stops if the module is not in the table.
function(vdbfuse_floor MODULE OUT)
  foreach(entry IN LISTS VDBFUSE_LAYERS)
    if(entry MATCHES "^([0-9]+):${MODULE}$")
      set(${OUT} ${CMAKE_MATCH_1} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "module '${MODULE}' is not in the table of floors in cmake/Layers.cmake")
endfunction()

# Stops unless USED lies on a lower floor than USER.
function(vdbfuse_check_layer USER USED)
  vdbfuse_floor(${USER} user_floor)
  vdbfuse_floor(${USED} used_floor)
  if(NOT used_floor LESS user_floor)
    message(FATAL_ERROR "module '${USER}' (floor ${user_floor}) must not use '${USED}' (floor ${used_floor}): "
                        "a module uses lower floors only")
  endif()
endfunction()

# Sets OUT to whether MODULE is to be built: all are, unless VDBFUSE_MODULES names some; those of PCL and
# of Python can be left out.
function(vdbfuse_is_wanted MODULE OUT)
  set(wanted TRUE)
  if(VDBFUSE_MODULES AND NOT MODULE IN_LIST VDBFUSE_MODULES)
    set(wanted FALSE)
  elseif((MODULE STREQUAL "pcl" AND NOT VDBFUSE_WITH_PCL) OR (MODULE STREQUAL "python" AND NOT VDBFUSE_WITH_PYTHON))
    set(wanted FALSE)
  endif()
  set(${OUT} ${wanted} PARENT_SCOPE)
endfunction()

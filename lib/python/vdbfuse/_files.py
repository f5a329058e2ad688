# SPDX-License-Identifier: Apache-2.0
"""Data sets and meshes on disk."""
import os

import numpy as np

from . import _core
from ._progress import function_of


def read(path, *, progress=None, **options):
    """A folder or file of depth maps in any of the formats of `vdbfuse formats`, as a DataSet: cameras and poses now,
    images when they are needed.

    Options, as of the command line: format, depth_scale, depth_kind, baseline, intrinsics (fx, fy, cx, cy), min_depth,
    max_depth, masks (a folder), splat_step (degrees), fix_convention ("auto", or a list such as "inverse,opengl"), views
    (the first ones only).
    """
    return _core.read(os.fspath(path), function_of(progress), **options)


def write(folder, data, format="numpy", *, depth_scale=None, progress=None):
    """Writes a DataSet into a new folder: "numpy", "rgbd", "tum", "colmap", "mvsnet", "open3d", "transforms", "ptx".

    depth_scale: length of one step of formats that store whole numbers. None: what their other readers expect.
    """
    _core.write(os.fspath(folder), data, format, depth_scale, function_of(progress))


def mesh(vertices, triangles):
    """A Mesh from (V, 3) numbers and (T, 3) whole numbers, for evaluate(), trim(), save()."""
    points = np.asarray(vertices)
    corners = np.asarray(triangles)
    for name, array, kinds in (("vertices", points, "fui"), ("triangles", corners, "ui")):
        if array.dtype.kind not in kinds:
            raise TypeError(f"{name}: expected {'numbers' if 'f' in kinds else 'whole numbers'}, found {array.dtype}")
        if array.ndim != 2 or array.shape[1] != 3:
            raise ValueError(f"{name}: expected (N, 3), found shape {array.shape}")
    if corners.size and (corners.min() < 0 or corners.max() >= len(points)):
        raise ValueError(f"triangles: expected numbers of {len(points)} vertices, found others")
    return _core.mesh_from_arrays(points, corners)


def read_mesh(path):
    """A Mesh from a .ply, .obj or .stl file."""
    return _core.read_mesh(os.fspath(path))

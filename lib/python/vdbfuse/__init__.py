# SPDX-License-Identifier: Apache-2.0
"""Depth maps to surfaces.

    import vdbfuse
    vdbfuse.fuse(depths, intrinsics, poses).save("mesh.ply")

fuse() takes arrays of numpy, views one by one from a generator or a function, or a data set that read() or stereo() made,
and gives a watertight Mesh: what every depth map says about every place, visible or hidden, and a global minimum cut
(method="tsdf": truncated signed distances, open where nothing was measured). TSDF and Scanner take views live. judge()
says what each pixel is worth, evaluate() how far a mesh is from the truth.

Conventions. Lengths are in the unit of the poses. Poses are world_from_camera (they take points of the camera to points of
the world) unless they are given as camera_from_world=. Camera axes: x right, y down, z forward (axes="opencv"), or x right,
y up, z backward (axes="opengl"). Pixel centres lie at integers: (0, 0) is the middle of the first pixel, cx = (W - 1) / 2
the middle of the image. Depths are z, unless depth_kind says "range", "disparity" or "inverse"; 0, negative and non-finite
numbers mean that nothing was measured. Triangles are counter-clockwise seen from outside.

Errors are Python's own: TypeError and ValueError name the argument, OSError the file and what was expected and found there,
RuntimeError says why there is no result. Ctrl-C stops every long call; other threads run meanwhile.
"""
from ._core import DataSet, JudgedView, Judgement, Mesh, View
from ._core import version as __version__
from ._evaluate import evaluate
from ._files import mesh, read, read_mesh, write
from ._fuse import fuse, judge
from ._live import Preview, Scanner, TSDF
from ._stereo import stereo
from ._views import data_set, view

__all__ = ["DataSet", "JudgedView", "Judgement", "Mesh", "Preview", "Scanner", "TSDF", "View", "data_set", "evaluate", "fuse",
           "judge", "mesh", "read", "read_mesh", "stereo", "view", "write"]

for _class in (DataSet, JudgedView, Judgement, Mesh, View):
    _class.__module__ = "vdbfuse"
del _class

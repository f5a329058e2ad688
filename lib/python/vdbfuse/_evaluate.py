# SPDX-License-Identifier: Apache-2.0
import os

import numpy as np

from . import _core
from ._files import mesh as mesh_of
from ._files import read_mesh
from ._progress import function_of


def _mesh(name, value):
    """Of a Mesh, a path, a pair of arrays, or what has vertices and triangles (a mesh of Open3D)."""
    if isinstance(value, _core.Mesh):
        return value
    if isinstance(value, (str, os.PathLike)):
        return read_mesh(value)
    if hasattr(value, "vertices") and hasattr(value, "triangles"):
        return mesh_of(np.asarray(value.vertices), np.asarray(value.triangles))
    if isinstance(value, (tuple, list)) and len(value) == 2:
        return mesh_of(*value)
    raise TypeError(f"{name}: expected a mesh, a path or (vertices, triangles), found {type(value).__name__}")


def evaluate(mesh, truth, tau=None, *, deep=None, regions=None, samples=200000, progress=None):
    """How far a mesh is from the truth: a dict with the members of `vdbfuse evaluate --json`.

    mesh, truth: Mesh, path, (vertices, triangles), or a mesh of Open3D, in the same coordinates.
    tau: one or several distances for precision, recall and fscore (lists, one entry a tau), the first also for completeness.
        None: 1 % of the diagonal of the truth's bounding box.
    deep: a distance: also the volume lost and invented further than this from the true surface.
    regions: a JSON file of places known to be inside or outside.
    """
    taus = [] if tau is None else [float(t) for t in np.atleast_1d(tau)]
    return _core.evaluate(_mesh("mesh", mesh), _mesh("truth", truth), taus, deep, regions, samples, function_of(progress))

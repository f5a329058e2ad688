# SPDX-License-Identifier: Apache-2.0
"""fuse() and judge()."""
import os
import re
import warnings

from . import _core
from ._files import read
from ._progress import function_of
from ._views import data_set

_UNITS = {"": 0, "b": 0, "k": 10, "kib": 10, "m": 20, "mib": 20, "g": 30, "gib": 30, "t": 40, "tib": 40}
_DECIMAL = {"kb": 3, "mb": 6, "gb": 9, "tb": 12}
_OF_ARRAYS = {"world_from_camera", "camera_from_world", "axes", "masks", "colors", "distortion", "names"}


def _bytes(memory):
    """8589934592, or "8GiB"."""
    if not isinstance(memory, str):
        return memory
    match = re.fullmatch(r"\s*([0-9.]+)\s*([A-Za-z]*)\s*", memory)
    unit = match[2].lower() if match else None
    if unit in _UNITS:
        return int(float(match[1]) * (1 << _UNITS[unit]))
    if unit in _DECIMAL:
        return int(float(match[1]) * 10 ** _DECIMAL[unit])
    raise ValueError(f"memory: expected bytes or a size like '8GiB', found {memory!r}")


def _split(options, names):
    """Those of these names, and the others."""
    return ({name: value for name, value in options.items() if name in names},
            {name: value for name, value in options.items() if name not in names})


def _data_of(depths, intrinsics, poses, confidences, progress, options):
    """The DataSet, and the options that are left."""
    if isinstance(depths, (str, os.PathLike)):
        reading, options = _split(options, set(_core.read_option_names()))
        depths = read(depths, progress=progress, **reading)
    if isinstance(depths, _core.DataSet):
        mine, options = _split(options, _OF_ARRAYS)
        if not all(value is None for value in (intrinsics, poses, confidences, *mine.values())):
            raise TypeError("depths: a data set has cameras, poses and images of its own")
        return depths, options
    mine, options = _split(options, _OF_ARRAYS | set(_core.depth_option_names()))
    return data_set(depths, intrinsics, poses, confidences, **mine), options


def _warn_of_convention(data, progress):
    hint = _core.convention_hint(data, progress)
    if hint is not None:
        warnings.warn(hint + "; for arrays: camera_from_world=, axes='opengl', depth_kind=", stacklevel=3)


def fuse(depths, intrinsics=None, poses=None, confidences=None, voxel=None, *, progress=None, check=True, **options):
    """Depth maps to a surface. The same mesh, byte by byte, as `vdbfuse fuse` makes of the same views.

    depths, intrinsics, poses, confidences: as of data_set(), which lists the keywords that go with them
        (world_from_camera=, camera_from_world=, axes=, masks=, colors=, depth_scale=, ...). Or depths is a DataSet, or the
        path of one, alone; with a path go the keywords of read().
    voxel: edge of the finest cells, unit of the poses; half of it costs about four times. None: from the data.
    progress: a function of (step, share in [0, 1]), called on the calling thread; or tqdm.
    check: whether a few views are compared first; a warning says when another convention of poses or depths would make
        them agree much better.

    Options have the names of the command line's, with _ for - (`vdbfuse fuse --help` explains them); most used:
    method: "visibility" (watertight), or "tsdf" (Curless and Levoy: open where nothing was measured).
    resolution: in place of voxel, longest side of the domain / voxel.
    bbox: x0, y0, z0, x1, y1, z1 in the world. None: where reliable views agree.
    border: what lies beyond: "auto", "outside", "solid", "free".
    thickness: how far behind a measured surface solid is expected, "auto", "off" or a length.
    trim: cut away what fewer views than this agree on (0.3: what was invented). min_component: least diagonal of a piece.
    simplify: triangles to be left, about. color: "auto" or "none". grids: True keeps rho, sigma, support and the field.
    sensor, noise, noise_scale, outliers: where they are known better than from the data.
    memory: bytes that may be used, or "8GiB"; views that do not fit lie in a file. threads: 0 is all.
    truncation, weights, carve, min_weight, close_gaps, trim_rim: of method "tsdf".

    Raises TypeError, ValueError, OSError, MemoryError; RuntimeError when there is no surface; what `progress` or the source
    of the views raises.
    """
    progress = function_of(progress)
    data, options = _data_of(depths, intrinsics, poses, confidences, progress, options)
    if "memory" in options:
        options["memory"] = _bytes(options["memory"])
    if check:
        _warn_of_convention(data, progress)
    return _core.fuse(data, progress, voxel=voxel, **options)


def judge(depths, intrinsics=None, poses=None, confidences=None, *, progress=None, **options):
    """What each pixel is worth: a Judgement, a sequence of JudgedView with the probability of each depth to be wrong.

    Arguments as of fuse(); options: bbox, noise, sensor, noise_scale, outliers, no_reliability, no_denial, no_return,
    memory, threads.
    """
    progress = function_of(progress)
    data, options = _data_of(depths, intrinsics, poses, confidences, progress, options)
    if "memory" in options:
        options["memory"] = _bytes(options["memory"])
    return _core.judge(data, progress, **options)

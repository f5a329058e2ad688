# SPDX-License-Identifier: Apache-2.0
import os

import numpy as np

from . import _arrays, _cameras, _core
from ._progress import function_of


def _photograph(where, value, mask):
    """(grey, color, mask), one of the first two None."""
    array = np.asarray(value)
    if array.ndim == 3 and array.shape[2] in (3, 4):
        color = _arrays.color(where, array)
        return None, color, _arrays.mask(f"{where}: mask", mask, color.shape[:2])
    if array.ndim != 2 or 0 in array.shape:
        raise ValueError(f"{where}: expected (H, W) or (H, W, 3), found shape {array.shape}")
    if array.dtype not in (np.uint8, np.float32, np.float64):
        raise TypeError(f"{where}: expected uint8, or float32 in [0, 1], found {array.dtype}")
    grey = np.ascontiguousarray(array, np.float32)
    if array.dtype == np.uint8:
        grey = grey / np.float32(255)
    return grey, None, _arrays.mask(f"{where}: mask", mask, grey.shape)


def stereo(images, intrinsics=None, poses=None, *, world_from_camera=None, camera_from_world=None, axes="opencv", masks=None,
           names=None, progress=None, **options):
    """Depth maps with confidences from photographs with known cameras: a DataSet for fuse().

    images: path of a folder or file in any of the formats of `vdbfuse stereo`, alone; or a list of (H, W) or (H, W, 3) uint8
        arrays, or (H, W) float32 in [0, 1], without lens distortion, with intrinsics and poses as of data_set().
    Options, as of the command line: neighbours, min_angle, max_angle (degrees), window, hypotheses, min_confidence,
    surface_sweeps, no_cross_check, mode ("fast", "paper"), bbox, min_depth, max_depth, threads; for a path also format,
    masks (a folder), views (the first ones only).
    """
    progress = function_of(progress)
    if isinstance(images, (str, os.PathLike)):
        if not all(value is None for value in (intrinsics, poses, world_from_camera, camera_from_world, names)):
            raise TypeError("images: a path has cameras and poses of its own")
        if masks is not None:
            options["masks"] = masks
        return _core.stereo_from_path(os.fspath(images), progress, **options)
    matrices, inverse, opengl = _cameras.poses(world_from_camera, camera_from_world, axes, poses)
    images = list(images)
    outlines = [None] * len(images) if masks is None else list(masks)
    for name, found in (("images", len(images)), ("masks", len(outlines))):
        if found != len(matrices):
            raise ValueError(f"{name}: expected one for each of {len(matrices)} poses, found {found}")
    names = [f"image {i}" for i in range(len(images))] if names is None else [str(name) for name in names]
    arrays = [_photograph(f"image {i}", image, mask) for i, (image, mask) in enumerate(zip(images, outlines))]
    return _core.stereo_from_arrays(arrays, names, _cameras.cameras(intrinsics, None, len(images)), matrices, inverse, opengl,
                                    progress, **options)

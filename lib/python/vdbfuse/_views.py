# SPDX-License-Identifier: Apache-2.0
"""Views from arrays: lists, arrays, functions of an index, generators."""
from collections.abc import Iterator

from . import _arrays, _cameras, _core

_IN_MEMORY = 64 << 20  # bytes of views of generators; the rest lies in a file


class _Images:
    """One kind of image of all views, by index or in order."""

    def __init__(self, name, source):
        self.name, self.source = name, source
        self.comes_once = isinstance(source, Iterator)
        if source is not None and not self.comes_once and not callable(source) and not hasattr(source, "__getitem__"):
            raise TypeError(f"{name}: expected a list or an array, a function of the view's number, or a generator, found "
                            f"{type(source).__name__}")

    def require_count(self, count):
        if hasattr(self.source, "__len__") and len(self.source) != count:
            raise ValueError(f"{self.name}: expected one for each of {count} poses, found {len(self.source)}")

    def __call__(self, index):
        if self.source is None:
            return None
        if self.comes_once:
            try:
                return next(self.source)
            except StopIteration:
                raise ValueError(f"{self.name}: ended after {index} views, there are more poses") from None
        return self.source(index) if callable(self.source) else self.source[index]

    def require_end(self, count):
        nothing = object()
        if self.comes_once and next(self.source, nothing) is not nothing:
            raise ValueError(f"{self.name}: goes on after {count} views, there are no more poses")


def _shapes(depths, count):
    """(H, W) of each view: of a list each has its own, else all have that of the first."""
    own = count if isinstance(depths.source, (list, tuple)) else 1
    shapes = [_arrays.depth_as_it_is(f"view {i}: depth", depths(i)).shape for i in range(own)]
    return shapes * count if own == 1 else shapes


def _names(names, count):
    if names is None:
        return [f"view {index}" for index in range(count)]
    names = [str(name) for name in names]
    if len(names) != count:
        raise ValueError(f"names: expected one for each of {count} poses, found {len(names)}")
    return names


def _keep(images, names, cameras, poses, inverse, opengl, reading):
    """Takes views in order, each once."""
    store = _core.ViewStore(_IN_MEMORY)
    for index, name in enumerate(names):
        arrays = _arrays.view(f"view {index}", *(kind(index) for kind in images))
        store.add(_core.make_view(name, arrays, cameras[index], poses[index], inverse, opengl, reading))
    for kind in images:
        kind.require_end(len(names))
    return store.data_set(opengl)


def _load_on_demand(images, names, cameras, poses, inverse, opengl, reading):
    depths, confidences, colors, masks = images

    def load(index, with_color):
        return _arrays.view(f"view {index}", depths(index), confidences(index), colors(index) if with_color else None,
                            masks(index))
    shapes = _shapes(depths, len(names))
    return _core.on_demand(load, names, shapes, cameras, poses, inverse, opengl, reading)


def data_set(depths, intrinsics, poses=None, confidences=None, *, world_from_camera=None, camera_from_world=None,
             axes="opencv", masks=None, colors=None, distortion=None, names=None, **depth_options):
    """Depth maps in memory, or that a function or generator gives, as a DataSet.

    depths: (N, H, W), or a list of (H, W), float32 (lengths) or uint16 (0.001 of a length, 65535 is invalid); or a function
        of the view's number, called whenever the view is needed (from several threads, one at a time); or a generator,
        whose views are taken once and kept small, in memory up to 64 MiB, then in a file without a name in $TMPDIR or
        /var/tmp. A function's views must all have the size of the first.
    intrinsics: fx, fy, cx, cy, or a (3, 3) matrix, in pixels whose centres lie at integers; one for all or one each.
    poses: (N, 4, 4) or (N, 3, 4) world_from_camera; or by name, one way or the other.
    axes: of the camera: "opencv" (x right, y down, z forward) or "opengl" (x right, y up, z backward).
    confidences: (H, W) numbers of any scale and direction; what they are worth is learned from the data.
    masks: (H, W), 0 where the pixel looks past the object.
    colors: (H', W', 3) uint8 of the same view, of any size.
    distortion: k1, k2, p1, p2, k3 of Brown and Conrady, in the order of OpenCV.
    depth_options: depth_scale (stored number times this is a length), depth_kind ("z", "range", "disparity", "inverse"),
        baseline (of disparity), min_depth, max_depth (others are left out).
    confidences, masks and colors come in the same forms as depths.
    """
    images = [_Images("depths", depths), _Images("confidences", confidences), _Images("colors", colors),
              _Images("masks", masks)]
    if depths is None:
        raise TypeError("depths: expected arrays, a function or a generator, found None")
    matrices, inverse, opengl = _cameras.poses(world_from_camera, camera_from_world, axes, poses)
    count = len(matrices)
    if count == 0:
        raise ValueError("poses: expected at least one, found none")
    for kind in images:
        kind.require_count(count)
    make = _keep if any(kind.comes_once for kind in images) else _load_on_demand
    return make(images, _names(names, count), _cameras.cameras(intrinsics, distortion, count), matrices, inverse, opengl,
                _core.Reading(**depth_options))


def view(depth, intrinsics, pose=None, confidence=None, *, world_from_camera=None, camera_from_world=None, axes="opencv",
         mask=None, color=None, distortion=None, name="view", **depth_options):
    """One depth map with its camera and pose, for TSDF and Scanner. Arguments as of data_set(), for one view."""
    matrix, inverse, opengl = _cameras.one_pose(world_from_camera, camera_from_world, axes, pose)
    camera = _cameras.cameras(intrinsics, distortion, 1)[0]
    return _core.make_view(name, _arrays.view(name, depth, confidence, color, mask), camera, matrix, inverse, opengl,
                           _core.Reading(**depth_options))

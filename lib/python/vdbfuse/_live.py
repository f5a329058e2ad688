# SPDX-License-Identifier: Apache-2.0
"""Views as they come from a sensor: TSDF and Scanner."""
import os
from typing import NamedTuple

import numpy as np

from . import _cameras, _core
from ._fuse import _bytes
from ._progress import function_of
from ._views import view


def _view(depth, *camera_and_pose, **keywords):
    """A View as it is, or one made of arrays."""
    if not isinstance(depth, _core.View):
        return view(depth, *camera_and_pose, **keywords)
    if camera_and_pose or keywords:
        raise TypeError("view: has a camera, a pose and images of its own")
    return depth


class TSDF:
    """A truncated signed distance (Curless and Levoy 1996), a view at a time.

        volume = vdbfuse.TSDF(voxel=0.005)
        for depth, pose in frames:
            volume.integrate(depth, (fx, fy, cx, cy), pose)
        volume.mesh().save("mesh.ply")

    One thread may integrate while another asks for the mesh.
    """

    def __init__(self, voxel, **options):
        """voxel: edge, unit of the poses. truncation: length; None: 4 voxels. colors: True keeps a mean colour. storage:
        "single" (8 bytes a voxel) or "half" (4). weights: what pixels are weighted by, some of "confidence", "noise",
        "incidence", "silhouette" (all, unless given), or "none". carve: each view empties the space before what it
        measured. min_weight: voxels with this weight or less are unknown to mesh(). sensor: whose noise weighs the depths.
        bbox: x0, y0, z0, x1, y1, z1.
        """
        self._volume = _core.Integrator(voxel=voxel, **options)

    @classmethod
    def load(cls, path, **options):
        """A volume that save() wrote, to go on with; its voxels and truncation count."""
        volume = cls.__new__(cls)
        volume._volume = _core.Integrator.load(os.fspath(path), **options)
        return volume

    def integrate(self, depth, *camera_and_pose, **keywords):
        """Takes a View in, or integrate(depth, intrinsics, pose, confidence=None, **keywords) as of view(). Returns a dict:
        leaves (blocks of 8³ voxels) that changed, of them created, voxels near and before the surface.
        """
        return self._volume.integrate(_view(depth, *camera_and_pose, **keywords))

    def remove(self, depth, *camera_and_pose, **keywords):
        """Takes a view out that was integrated with the same arguments."""
        return self._volume.remove(_view(depth, *camera_and_pose, **keywords))

    def mesh(self):
        """The surface as a Mesh: an open rim where space is unknown, weights as support."""
        return self._volume.mesh()

    def changed_blocks(self):
        """What changed of it since the last call, cheaply: list of (origin, Mesh), one a block of 32³ voxels that is new or
        replaces the one of the same origin; an empty Mesh: there is no surface in it any more.
        """
        return self._volume.changed_blocks()

    def save(self, path):
        """The volume as OpenVDB's .vdb."""
        self._volume.save(os.fspath(path))

    @property
    def memory_bytes(self):
        """Bytes of the volume."""
        return self._volume.memory_bytes

    @property
    def leaves(self):
        """Blocks of 8³ voxels."""
        return self._volume.leaves

    def __repr__(self):
        return f"<vdbfuse.TSDF: {self.leaves} blocks of 8x8x8 voxels, {self.memory_bytes / 2**20:.1f} MiB>"


class Preview(NamedTuple):
    """What changed of a Scanner's preview since the one before."""

    changed: list  #: of (origin, Mesh): new blocks and new contents of old ones
    removed: list  #: origins of blocks that have no surface any more
    newest: int  #: number of the latest view that is part of it; 0: none


class Scanner:
    """A live scan: views as a sensor gives them, a preview of the surface all the while, poses that are corrected later, and
    the watertight surface of all views whenever it is asked for. All methods may be called from any thread.
    """

    def __init__(self, voxel, **options):
        """voxel: of the preview, unit of the poses; with it go truncation, colors, storage, weights, min_weight, sensor and
        bbox as of TSDF. min_depth, max_depth: depths that are looked at. queue: views that may wait. when_full:
        "drop-oldest", "drop-newest" or "wait". memory: bytes of views that are kept in memory (or "2GiB"), others lie in a
        file without a name.
        """
        if "memory" in options:
            options["memory"] = _bytes(options["memory"])
        self._scanner = _core.Scanner(voxel=voxel, **options)

    def push(self, depth, *camera_and_pose, **keywords):
        """Takes a View, or push(depth, intrinsics, pose, confidence=None, **keywords) as of view(), and returns at once:
        the view's number, or None where it was dropped because the queue is full.
        """
        return self._scanner.push(_view(depth, *camera_and_pose, **keywords))

    def remove(self, number):
        """Takes a view out again."""
        self._scanner.remove(number)

    def correct_poses(self, poses, *, axes="opencv", direction="world_from_camera"):
        """Better poses, as a loop closure gives them: a dict of the views' numbers and (4, 4) or (3, 4) matrices."""
        if direction not in ("world_from_camera", "camera_from_world"):
            raise ValueError(f"direction: expected 'world_from_camera' or 'camera_from_world', found {direction!r}")
        if not poses:
            return
        matrices, inverse, opengl = _cameras.poses(axes=axes, **{
            "world_from_camera": None, "camera_from_world": None, direction: [np.asarray(m) for m in poses.values()]})
        self._scanner.correct_poses(list(poses), matrices, inverse, opengl)

    def wait(self, *, progress=None):
        """Until the views pushed before are part of the preview, and no correction waits."""
        self._scanner.wait(function_of(progress))

    def preview(self):
        """What changed since the last call, as a Preview; costs what changed."""
        return Preview(*self._scanner.preview())

    def mesh(self):
        """The whole preview as one Mesh."""
        return self._scanner.mesh()

    def status(self):
        """dict of counts: pushed, integrated, dropped, waiting, corrections, kept, kept_bytes, preview_bytes."""
        return self._scanner.status()

    def views(self, *, distance=0.0, angle=0.0):
        """The views that are kept as a DataSet; a view is left out while the sensor has moved no further than distance and
        turned by no more than angle (radians) since the last one that was not.
        """
        return self._scanner.views(distance, angle)

    def finish(self, *, key_distance=0.0, key_angle=0.0, progress=None, **options):
        """wait(), then fuse(views(distance=key_distance, angle=key_angle), **options): a watertight Mesh. The scan may go on
        meanwhile and afterwards.
        """
        if "memory" in options:
            options["memory"] = _bytes(options["memory"])
        return self._scanner.finish(key_distance, key_angle, function_of(progress), **options)

    def __repr__(self):
        status = self.status()
        return f"<vdbfuse.Scanner: {status['kept']} views, {status['waiting']} waiting>"

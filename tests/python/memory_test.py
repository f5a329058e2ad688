# SPDX-License-Identifier: Apache-2.0
"""Nothing leaks, nothing is copied that need not be, and views that stream by do not pile up."""
import ctypes
import gc
import os
import subprocess
import sys
import weakref

import numpy as np
import vdbfuse
from scenes import INTRINSICS, sphere

HERE = os.path.dirname(os.path.abspath(__file__))


class _HeapInfo(ctypes.Structure):
    """struct mallinfo2 of the C library."""

    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks", "fsmblks",
                                                     "uordblks", "fordblks", "keepcost")]


def bytes_in_use():
    """Of the heap: what was allocated and not freed, whatever the allocator keeps beside it."""
    gc.collect()
    mallinfo = ctypes.CDLL(None).mallinfo2
    mallinfo.restype = _HeapInfo
    info = mallinfo()
    return info.uordblks + info.hblkhd


def everything_once(depths, poses):
    """One use of everything, failures too."""
    colors = np.zeros((*depths.shape, 3), np.uint8)
    mesh = vdbfuse.fuse(lambda i: depths[i], INTRINSICS, poses, voxel=0.1, colors=colors, check=False, grids=True,
                        progress=lambda step, share: None)
    assert mesh.vertices.sum() != 0 and mesh.slice("surface", longest=32)[0].size > 0
    vdbfuse.judge((d for d in depths), INTRINSICS, poses)[0].outlier.sum()
    volume = vdbfuse.TSDF(voxel=0.1)
    volume.integrate(depths[0], INTRINSICS, poses[0])
    volume.changed_blocks()
    scanner = vdbfuse.Scanner(voxel=0.1, when_full="wait")
    scanner.push(depths[0], INTRINSICS, poses[0])
    scanner.wait()
    try:
        vdbfuse.fuse(lambda i: depths[i] if i < 3 else 1 / 0, INTRINSICS, poses)
    except ZeroDivisionError:
        pass


def test_nothing_leaks_in_200_runs():
    depths, poses = sphere(10)
    for _ in range(25):  # tables and thread pools fill up
        everything_once(depths, poses)
    objects, begin = len(gc.get_objects()), bytes_in_use()
    for _ in range(200):
        everything_once(depths, poses)
    growth, more = bytes_in_use() - begin, len(gc.get_objects()) - objects
    print(f"{growth / 1024:.0f} KiB more in use after 200 runs, {more} more objects")
    assert more < 100  # less than one in two runs
    assert growth < 100 * 1024  # half a kilobyte a run; one depth map is 27


def test_sources_are_let_go_of():
    class Frames:
        def __init__(self, depths):
            self.depths = depths

        def __call__(self, index):
            return self.depths[index]
    depths, poses = sphere(10)
    frames = Frames(depths)
    watched = weakref.ref(frames)
    data = vdbfuse.data_set(frames, INTRINSICS, poses)
    mesh = vdbfuse.fuse(data, voxel=0.1, check=False)
    del frames, data
    gc.collect()
    assert watched() is None and len(mesh.triangles) > 0


def peak_of(program, *arguments):
    """MiB of a process of its own, at most, and what its program printed."""
    text = subprocess.run([sys.executable, "-B", "-c", PREAMBLE + program, *map(str, arguments)], check=True,
                          capture_output=True, text=True).stdout
    return float(text.split()[-1])


PREAMBLE = f"""
import resource, sys
sys.path.insert(0, {HERE!r})
import numpy as np
import vdbfuse, scenes
count = int(sys.argv[1])
width, height = 160, 120
camera = (150.0, 150.0, (width - 1) / 2, (height - 1) / 2)
poses = scenes.poses_around(count)
random = np.random.default_rng(1)
def frames():
    for pose in poses:
        depth = scenes.sphere_depth(pose, camera, width, height)
        yield np.where(depth > 0, depth + 0.002 * random.standard_normal(depth.shape), 0).astype(np.float32)
def say():
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""

TSDF = """
volume = vdbfuse.TSDF(voxel=0.01)
for depth, pose in zip(frames(), poses):
    volume.integrate(depth, camera, pose)
assert len(volume.mesh().triangles) > 1000
say()
"""

TAKE = """
assert len(vdbfuse.data_set(frames(), camera, poses)) == count
say()
"""

FUSE = """
mesh = vdbfuse.fuse(frames(), camera, poses, voxel=0.02, memory="340MiB", check=False)
assert mesh.topology()["closed"]
assert count < 1000 or mesh.report["memory"]["view_window_bytes"] > 0  # they did not fit
say()
"""


def test_a_thousand_frames_integrated_from_a_generator_take_no_more_than_250():
    few, many = peak_of(TSDF, 250), peak_of(TSDF, 1000)
    print(f"TSDF: {few:.0f} MiB with 250 frames, {many:.0f} MiB with 1000")
    assert many < 1.1 * few


def test_a_thousand_frames_taken_from_a_generator_lie_in_a_file():
    few, many = peak_of(TAKE, 1000), peak_of(TAKE, 2500)
    more = 1500 * 160 * 120 * 4 / 2**20
    print(f"data_set: {few:.0f} MiB with 1000 frames, {many:.0f} MiB with 2500, which are {more:.0f} MiB more of depths")
    assert many - few < more / 4


def test_a_thousand_frames_fused_from_a_generator_stay_within_the_memory_given():
    peak = peak_of(FUSE, 1000)
    print(f"fuse: {peak:.0f} MiB with 1000 frames, memory='340MiB'")
    assert peak < 340 + 100  # and what Python, numpy and the store take

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Depth maps and confidences of a network to a mesh, a frame at a time.

    python3 03_network_depth.py FOLDER OUT.ply [VOXEL]

FOLDER: depth/NAME.npy and confidence/NAME.npy (H x W), intrinsics.npy (3 x 3, for all or one each) and extrinsics.npy
(N x 3 x 4, camera_from_world), in the order of the names. The scale of the confidence does not matter, nor whether high is
good: what it is worth is learned from the views themselves.
"""
import sys
from pathlib import Path

import numpy as np
import vdbfuse

folder, out = Path(sys.argv[1]), sys.argv[2]
voxel = float(sys.argv[3]) if len(sys.argv) > 3 else None
names = sorted(path.name for path in (folder / "depth").glob("*.npy"))


def stream(kind):
    """One frame in memory; with a network, this is where it runs."""
    for name in names:
        yield np.load(folder / kind / name)


mesh = vdbfuse.fuse(stream("depth"), np.load(folder / "intrinsics.npy"),
                    camera_from_world=np.load(folder / "extrinsics.npy"), confidences=stream("confidence"), voxel=voxel,
                    trim=0.3, progress=lambda step, share: print(f"\r{step} {share:4.0%}\033[K", end="", file=sys.stderr))
print(file=sys.stderr)
mesh.save(out)
found = mesh.report["calibration"]
print(f"{out}: {len(mesh.triangles)} triangles; {found['outlier_share']:.1%} of the depths were wrong, noise "
      f"{found['noise_scale']:.3g} at depth {found['median_depth']:.3g}, confidence: {found['confidence_direction']}")

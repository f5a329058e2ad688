#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Depth rendered by a radiance field, or by Gaussians, to a mesh: cameras of transforms.json, depth maps in NPY.

    python3 02_radiance_field.py FOLDER OUT.ply [RESOLUTION] [--range]

FOLDER: transforms.json with fl_x, fl_y, cx, cy and frames of transform_matrix and depth_file_path (H x W floats in the unit of
the poses). --range: they are distances along the rays, as many renderers give them, not z.
"""
import json
import sys
from pathlib import Path

import numpy as np
import vdbfuse

arguments = [argument for argument in sys.argv[1:] if argument != "--range"]
folder, out = Path(arguments[0]), arguments[1]
resolution = int(arguments[2]) if len(arguments) > 2 else 256
kind = "range" if "--range" in sys.argv else "z"

scene = json.loads((folder / "transforms.json").read_text())
frames = scene["frames"]
# Their pixel centres lie at .5, ours at integers.
camera = (scene["fl_x"], scene["fl_y"], scene["cx"] - 0.5, scene["cy"] - 0.5)
poses = np.array([frame["transform_matrix"] for frame in frames], np.float64)


def depth(index):
    """Loaded when it is needed, not kept."""
    return np.squeeze(np.load(folder / frames[index]["depth_file_path"])).astype(np.float32)


# What a field renders where nothing is, far away and without agreement, is judged by the other views and falls out.
mesh = vdbfuse.fuse(depth, camera, poses, axes="opengl", depth_kind=kind, resolution=resolution)
mesh.save(out)
print(f"{out}: {len(mesh.triangles)} triangles, closed: {mesh.topology()['closed']}, "
      f"{mesh.report['calibration']['outlier_share']:.1%} of the depths were wrong")

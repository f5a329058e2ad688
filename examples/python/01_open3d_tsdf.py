#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A TSDF of Open3D, replaced line by line: its lines are the comments.

    python3 01_open3d_tsdf.py FOLDER OUT.ply [VOXEL]

FOLDER: frames of a depth camera, or any other data set that `vdbfuse formats` lists.
"""
import sys

import vdbfuse

folder, out = sys.argv[1:3]
voxel = float(sys.argv[3]) if len(sys.argv) > 3 else 0.01
data = vdbfuse.read(folder)

# volume = o3d.pipelines.integration.ScalableTSDFVolume(voxel_length=voxel, sdf_trunc=4 * voxel, color_type=RGB8)
volume = vdbfuse.TSDF(voxel=voxel, truncation=4 * voxel, colors=True)

for view in data:
    # extrinsic, depth in metres (or in millimetres as uint16), color: as you have them for Open3D
    extrinsic, depth, color = view.camera_from_world, view.depth, view.color

    # camera = o3d.camera.PinholeCameraIntrinsic(width, height, fx, fy, cx, cy)
    camera = view.intrinsics  # or (fx, fy, cx, cy)

    # rgbd = o3d.geometry.RGBDImage.create_from_color_and_depth(o3d.geometry.Image(color), o3d.geometry.Image(depth),
    #                                                           depth_scale=1, depth_trunc=4, convert_rgb_to_intensity=False)
    # volume.integrate(rgbd, camera, extrinsic)
    volume.integrate(depth, camera, camera_from_world=extrinsic, color=color, max_depth=4)

# mesh = volume.extract_triangle_mesh()
mesh = volume.mesh()

# o3d.io.write_triangle_mesh(out, mesh)
mesh.save(out)
topology = mesh.topology()
print(f"{out}: {len(mesh.triangles)} triangles, {topology['components']} components, {topology['open_edges']} open edges")

# What Open3D has no line for: the watertight surface of the same frames, without the floaters.
closed = vdbfuse.fuse(data, voxel=voxel)
closed.save(out.replace(".ply", ".closed.ply"))
topology = closed.topology()
print(f"closed: {len(closed.triangles)} triangles, {topology['components']} components, {topology['open_edges']} open edges, "
      f"{closed.report['invented_area_share']:.0%} of the area invented")

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Open3D's truncated distance fields on the scans that surface_benchmark wrote.

  tests/benchmark/surface_benchmark --out OUTDIR
  /usr/bin/python3 tests/benchmark/peer_tsdf.py OUTDIR/ball-exact OUTDIR/ball-noise OUTDIR/ball-outliers

Needs python3-open3d and python3-numpy. Voxel 5 mm, truncation 4 voxels. Bias and RMS of the vertices' distance from
the sphere of radius 0.5 where it was measured (z > 0.05), as in surface_benchmark.
"""
import re
import sys
from pathlib import Path

import numpy
import open3d

VOXEL, RADIUS, MEASURED_FROM = 0.005, 0.5, 0.05


def read_pfm(path):
    with open(path, "rb") as file:
        kind, size, scale = file.readline().strip(), file.readline().split(), float(file.readline())
        assert kind == b"Pf", path
        width, height = map(int, size)
        values = numpy.frombuffer(file.read(), "<f4" if scale < 0 else ">f4").reshape(height, width)
    return numpy.ascontiguousarray(numpy.flipud(values)).astype(numpy.float32)


def read_camera(path):
    numbers = [float(x) for x in re.findall(r"[-+0-9.eE]+(?=\s|$)", Path(path).read_text()) if re.search(r"\d", x)]
    return numpy.array(numbers[:16]).reshape(4, 4), numpy.array(numbers[16:25]).reshape(3, 3)


def views(scan):
    for camera in sorted(Path(scan, "cams").glob("*_cam.txt")):
        name = camera.name.removesuffix("_cam.txt")
        yield read_pfm(Path(scan, "depth_est", name + ".pfm")), *read_camera(camera)


def legacy(scan):
    volume = open3d.pipelines.integration.ScalableTSDFVolume(
        voxel_length=VOXEL, sdf_trunc=4 * VOXEL, color_type=open3d.pipelines.integration.TSDFVolumeColorType.NoColor)
    for depth, extrinsic, k in views(scan):
        height, width = depth.shape
        camera = open3d.camera.PinholeCameraIntrinsic(width, height, k[0, 0], k[1, 1], k[0, 2], k[1, 2])
        image = open3d.geometry.RGBDImage()
        image.depth = open3d.geometry.Image(depth)
        image.color = open3d.geometry.Image(numpy.zeros((height, width, 3), numpy.uint8))
        volume.integrate(image, camera, extrinsic)
    return volume.extract_triangle_mesh()


def tensor(scan):
    core = open3d.core
    grid = open3d.t.geometry.VoxelBlockGrid(("tsdf", "weight"), (core.float32, core.float32), ((1), (1)), VOXEL, 8, 20000)
    for depth, extrinsic, k in views(scan):
        image = open3d.t.geometry.Image(core.Tensor(depth))
        intrinsic, pose = core.Tensor(k), core.Tensor(extrinsic)
        blocks = grid.compute_unique_block_coordinates(image, intrinsic, pose, 1.0, 5.0, 4.0)
        grid.integrate(blocks, image, intrinsic, pose, 1.0, 5.0, 4.0)
    return grid.extract_triangle_mesh(weight_threshold=1.0).to_legacy()


def row(scan, name, mesh):
    points = numpy.asarray(mesh.vertices)
    errors = 1000 * (numpy.linalg.norm(points[points[:, 2] > MEASURED_FROM], axis=1) - RADIUS)
    components = len(mesh.cluster_connected_triangles()[1])
    triangles = numpy.sort(numpy.asarray(mesh.triangles), axis=1)
    edges = numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [0, 2]]])
    open_edges = int((numpy.unique(edges, axis=0, return_counts=True)[1] == 1).sum())
    print(f"| {Path(scan).name} | {name} | {errors.mean():.3f} | {numpy.sqrt((errors ** 2).mean()):.3f} | {components} "
          f"| {open_edges} |", flush=True)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("| sphere, voxel 5 mm | method | bias mm | RMS mm | components | open edges |\n|---|---|---|---|---|---|")
    for scan in sys.argv[1:]:
        row(scan, "Open3D legacy", legacy(scan))
        row(scan, "Open3D tensor", tensor(scan))


if __name__ == "__main__":
    main()

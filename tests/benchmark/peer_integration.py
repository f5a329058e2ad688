#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""TSDF integration beside Open3D's tensor VoxelBlockGrid (8³ blocks), in one run.

  /usr/bin/python3 tests/benchmark/peer_integration.py FOLDER [--runs 3] [--frames 100]
                   [--program build/tests/benchmark/tsdf_benchmark]

FOLDER: depth maps as frame-N.depth.png (millimetres) and frame-N.pose.txt (camera to world), such as kitchen-rgbd.
Truncation 4 voxels, allocation included, decoding excluded, voxels of 10 and 5 mm, 1 and 2 threads. Both take turns;
medians over the runs. Needs python3-open3d, python3-numpy, python3-pil. Memory: of the first 50 frames.
"""
import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

TRUNCATION = 4.0  # voxels


def frames_of(folder, count):
    import numpy
    from PIL import Image
    paths = sorted(Path(folder).glob("*.depth.png"), key=lambda p: int("".join(c for c in p.name if c.isdigit())))
    for path in paths[:count]:
        depth = numpy.array(Image.open(path)).astype(numpy.uint16)
        depth[depth == 65535] = 0
        pose = numpy.loadtxt(str(path).replace(".depth.png", ".pose.txt"))
        yield depth, numpy.linalg.inv(pose)


def peer(folder, count, voxel, camera):
    """Seconds a frame of Open3D; runs in a process of its own, which has its number of threads."""
    import numpy
    import open3d
    core = open3d.core
    grid = open3d.t.geometry.VoxelBlockGrid(("tsdf", "weight"), (core.float32, core.float32), ((1), (1)), voxel, 8, 50000)
    fx, fy, cx, cy = camera
    k = core.Tensor(numpy.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]], dtype=numpy.float64))
    frames = [(open3d.t.geometry.Image(core.Tensor(depth)), core.Tensor(extrinsic))
              for depth, extrinsic in frames_of(folder, count)]
    begin = time.perf_counter()
    for image, extrinsic in frames:
        blocks = grid.compute_unique_block_coordinates(image, k, extrinsic, 1000.0, 100.0, TRUNCATION)
        grid.integrate(blocks, image, k, extrinsic, 1000.0, 100.0, TRUNCATION)
    print((time.perf_counter() - begin) / len(frames))


def peer_milliseconds(args, voxel, threads):
    command = [sys.executable, __file__, args.folder, "--peer", str(voxel), "--frames", str(args.frames),
               "--camera", *map(str, args.camera)]
    environment = dict(os.environ, OMP_NUM_THREADS=str(threads))
    return 1000 * float(subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout)


def our_rows(args, voxel, threads, frames):
    command = [args.program, "speed", args.folder, "--frames", str(frames), "--voxel", str(voxel), "--threads", str(threads), "--json"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    return {row["setting"]: row for row in map(json.loads, lines)}


def speed(args):
    print("| voxel | threads | setting | ms a frame | Open3D tensor | ratio |\n|---|---|---|---|---|---|")
    ours = {}
    for voxel in (0.01, 0.005):
        for threads in (1, 2):
            peers, rows = [], []
            for _ in range(args.runs):
                peers.append(peer_milliseconds(args, voxel, threads))
                rows.append(our_rows(args, voxel, threads, args.frames))
            theirs = statistics.median(peers)
            for setting in rows[0]:
                mine = ours[voxel, threads, setting] = statistics.median(row[setting]["ms"] for row in rows)
                print(f"| {1000 * voxel:g} mm | {threads} | {setting} | {mine:.2f} | {theirs:.1f} | {theirs / mine:.2f} |",
                      flush=True)
    print("\n| voxel | setting | one thread / two | carving / not |\n|---|---|---|---|")
    for voxel in (0.01, 0.005):
        for setting in dict.fromkeys(key[2] for key in ours):
            plain = setting.replace(", carving", "")
            print(f"| {1000 * voxel:g} mm | {setting} | {ours[voxel, 1, setting] / ours[voxel, 2, setting]:.2f} | "
                  f"{ours[voxel, 1, setting] / ours[voxel, 1, plain]:.2f} |")


def memory(args):
    print("\n| voxel | setting | leaves | MB of the grid, 50 frames |\n|---|---|---|---|")
    for voxel in (0.01, 0.005):
        for setting, row in our_rows(args, voxel, 1, 50).items():
            print(f"| {1000 * voxel:g} mm | {setting} | {row['leaves']} | {row['megabytes']:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--camera", type=float, nargs=4, default=[585.0, 585.0, 320.0, 240.0], metavar=("FX", "FY", "CX", "CY"))
    parser.add_argument("--program", default="build/tests/benchmark/tsdf_benchmark")
    parser.add_argument("--peer", type=float, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.peer:
        peer(args.folder, args.frames, args.peer, args.camera)
    else:
        speed(args)
        memory(args)


if __name__ == "__main__":
    main()

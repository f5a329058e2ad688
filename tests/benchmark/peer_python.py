#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Beside Debian's python3-open3d, through Python on both sides, in one run.

  PYTHONPATH=build/python /usr/bin/python3 tests/benchmark/peer_python.py FRAMES [--runs 3] [--tool build/bin/vdbfuse]
             [--scene figure] [--views 48] [--size 640x480]

FRAMES: depth maps as frame-N.depth.png (millimetres) and frame-N.pose.txt (camera to world), such as kitchen-rgbd.
First table: TSDF integration of FRAMES, decoded before, truncation 4 voxels; the time counts what Python hands over, too.
Second: a scan of `vdbfuse synth SCENE --hard`, whose truth is known, at one voxel size: TSDF of all pixels and of those with a
confidence above one half, and the visibility result. Each side runs in processes of its own, so that peaks are its own; they
take turns; medians over the runs (Open3D's legacy volume: one, at the larger voxel). Memory is the peak on top of libraries
and frames. Needs python3-open3d, python3-numpy, python3-pil.
"""
import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy

CAMERA = (585.0, 585.0, 320.0, 240.0)  # of the frames
VOXELS = (0.01, 0.005)
ENOUGH = 50000  # blocks of the tensor grid: it need not grow, but takes their memory at once


def frames_of(folder):
    from PIL import Image
    paths = sorted(Path(folder).glob("*.depth.png"), key=lambda p: int("".join(c for c in p.name if c.isdigit())))
    depths = numpy.stack([numpy.array(Image.open(path)).astype(numpy.uint16) for path in paths])
    depths[depths == 65535] = 0
    poses = [numpy.loadtxt(str(path).replace(".depth.png", ".pose.txt")) for path in paths]
    return {"depths": depths, "extrinsics": numpy.linalg.inv(poses), "camera": numpy.array(CAMERA)}


# What the processes do: each takes the frames and a voxel size, and returns a mesh (vertices, triangles).

def open3d_tensor(a, voxel, blocks=ENOUGH):
    import open3d
    core = open3d.core
    grid = open3d.t.geometry.VoxelBlockGrid(("tsdf", "weight"), (core.float32, core.float32), ((1), (1)), voxel, 8, blocks)
    fx, fy, cx, cy = a["camera"]
    k = core.Tensor(numpy.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]))
    scale = 1000.0 if a["depths"].dtype == numpy.uint16 else 1.0
    for depth, extrinsic in zip(a["depths"], a["extrinsics"]):
        image, pose = open3d.t.geometry.Image(core.Tensor(depth)), core.Tensor(extrinsic)
        blocks = grid.compute_unique_block_coordinates(image, k, pose, scale, 100.0, 4.0)
        grid.integrate(blocks, image, k, pose, scale, 100.0, 4.0)
    yield len(a["depths"])
    mesh = grid.extract_triangle_mesh(weight_threshold=1.0).to_legacy()
    yield numpy.asarray(mesh.vertices), numpy.asarray(mesh.triangles)


def open3d_legacy(a, voxel):
    import open3d
    integration = open3d.pipelines.integration
    volume = integration.ScalableTSDFVolume(voxel, 4 * voxel, integration.TSDFVolumeColorType.NoColor)
    height, width = a["depths"].shape[1:]
    camera = open3d.camera.PinholeCameraIntrinsic(width, height, *a["camera"])
    black = open3d.geometry.Image(numpy.zeros((height, width, 3), numpy.uint8))
    scale = 1000.0 if a["depths"].dtype == numpy.uint16 else 1.0
    for depth, extrinsic in zip(a["depths"], a["extrinsics"]):
        image = open3d.geometry.RGBDImage.create_from_color_and_depth(black, open3d.geometry.Image(depth), scale, 100.0, False)
        volume.integrate(image, camera, extrinsic)
    yield len(a["depths"])
    mesh = volume.extract_triangle_mesh()
    yield numpy.asarray(mesh.vertices), numpy.asarray(mesh.triangles)


def vdbfuse_tsdf(a, voxel, **options):
    import vdbfuse
    volume = vdbfuse.TSDF(voxel=voxel, truncation=4 * voxel, **options)
    for depth, extrinsic in zip(a["depths"], a["extrinsics"]):
        volume.integrate(depth, a["camera"], camera_from_world=extrinsic)
    yield len(a["depths"])
    mesh = volume.mesh()
    yield mesh.vertices, mesh.triangles


def vdbfuse_visibility(a, voxel):
    import vdbfuse
    mesh = vdbfuse.fuse(a["depths"], a["camera"], camera_from_world=a["extrinsics"], confidences=a["confidences"], voxel=voxel)
    yield len(a["depths"])
    yield mesh.vertices, mesh.triangles


SIDES = {
    "Open3D tensor": open3d_tensor,
    "Open3D tensor, from 1000 blocks": lambda a, voxel: open3d_tensor(a, voxel, 1000),
    "Open3D legacy": open3d_legacy,
    "vdbfuse.TSDF": vdbfuse_tsdf,
    "vdbfuse.TSDF, half, weights none": lambda a, voxel: vdbfuse_tsdf(a, voxel, storage="half", weights="none"),
    "vdbfuse.fuse": vdbfuse_visibility,
}


def memory_mib(name):
    """VmHWM (the peak) or VmRSS (now) of this process."""
    with open("/proc/self/status", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith(name)) / 1024


def forget_peak():
    with open("/proc/self/clear_refs", "w", encoding="ascii") as file:
        file.write("5")


def work(side, scan, voxel, out):
    """In a process of its own: prints the figures, writes the mesh where `out` says."""
    with numpy.load(scan) as file:
        arrays = dict(file)
    __import__("open3d" if side.startswith("Open3D") else "vdbfuse")
    forget_peak()
    before = memory_mib("VmRSS")
    begin = time.perf_counter()
    steps = SIDES[side](arrays, voxel)
    frames = next(steps)
    seconds, memory = time.perf_counter() - begin, memory_mib("VmHWM") - before
    if out:
        vertices, triangles = next(steps)
        numpy.savez(out, vertices=vertices, triangles=triangles)
    total = time.perf_counter() - begin
    print(json.dumps({"seconds": seconds, "total": total, "frames": frames, "memory": memory}))


def figures(side, scan, voxel, out=""):
    command = [sys.executable, __file__, "--work", side, str(scan), str(voxel), str(out)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return json.loads(done.stdout.splitlines()[-1])


def median(rows, name):
    return statistics.median(row[name] for row in rows)


def integration(args, folder):
    scan = folder / "frames.npz"
    numpy.savez(scan, **frames_of(args.frames))
    sides = [side for side in SIDES if side != "vdbfuse.fuse"]
    print("| TSDF integration, voxel | through Python | frames a second | of Open3D tensor | memory MiB |\n|---|---|---|---|---|")
    for voxel in VOXELS:
        rows = {side: [] for side in sides}
        for run in range(args.runs):
            for side in sides:
                if side == "Open3D legacy" and (run > 0 or voxel < max(VOXELS)):
                    continue  # it takes minutes
                rows[side].append(figures(side, scan, voxel))
        measured = [side for side in sides if rows[side]]
        rate = {side: rows[side][0]["frames"] / median(rows[side], "seconds") for side in measured}
        for side in measured:
            print(f"| {1000 * voxel:g} mm | {side} | {rate[side]:.1f} | {rate[side] / rate[sides[0]]:.2f} | "
                  f"{median(rows[side], 'memory'):.0f} |", flush=True)


def hard_scan(args, folder):
    """The arrays of a scan with the mistakes of a stereo matcher, all pixels and the confident ones."""
    import vdbfuse
    subprocess.run([args.tool, "synth", args.scene, folder / "hard", "--hard", "--views", str(args.views), "--size", args.size],
                   check=True, capture_output=True)
    data = vdbfuse.read(folder / "hard")
    views = list(data)
    k = views[0].intrinsics
    arrays = {"depths": numpy.stack([view.depth for view in views]), "camera": k[[0, 1, 0, 1], [0, 1, 2, 2]],
              "extrinsics": numpy.linalg.inv(data.world_from_camera),
              "confidences": numpy.stack([view.confidence for view in views])}
    numpy.savez(folder / "all.npz", **arrays)
    arrays["depths"] = numpy.where(arrays["confidences"] > 0.5, arrays["depths"], 0).astype(numpy.float32)
    numpy.savez(folder / "confident.npz", **arrays)


def surfaces(args, folder):
    import vdbfuse
    hard_scan(args, folder)
    cases = [("Open3D tensor", "all"), ("Open3D tensor", "confident"), ("vdbfuse.TSDF", "all"), ("vdbfuse.TSDF", "confident"),
             ("vdbfuse.fuse", "all")]
    print(f"\n| synth {args.scene} --hard, {args.views} views {args.size}, voxel {args.voxel:g} | pixels | seconds | memory MiB "
          "| components | F at 1 % | closed |\n|---|---|---|---|---|---|---|")
    rows = {case: [] for case in cases}
    for _ in range(args.runs):
        for case in cases:
            rows[case].append(figures(case[0], folder / f"{case[1]}.npz", args.voxel, folder / f"{case[0]} {case[1]}.npz"))
    for case in cases:
        with numpy.load(folder / f"{case[0]} {case[1]}.npz") as mesh:
            score = vdbfuse.evaluate((mesh["vertices"], mesh["triangles"]), folder / "hard" / "truth.ply", tau=0.01)
        print(f"| {case[0]} | {case[1]} | {median(rows[case], 'total'):.1f} | {median(rows[case], 'memory'):.0f} | "
              f"{score['components']} | {100 * score['fscore'][0]:.1f} % | {'yes' if score['closed'] else 'no'} |", flush=True)


def main():
    if sys.argv[1:2] == ["--work"]:
        side, scan, voxel, out = sys.argv[2:6]
        return work(side, scan, float(voxel), out)
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("frames")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--tool", default="build/bin/vdbfuse")
    parser.add_argument("--scene", default="figure")
    parser.add_argument("--views", type=int, default=48)
    parser.add_argument("--size", default="640x480")
    parser.add_argument("--voxel", type=float, default=0.005, help="of the second table")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(dir="/var/tmp") as folder:
        integration(args, Path(folder))
        surfaces(args, Path(folder))


if __name__ == "__main__":
    main()

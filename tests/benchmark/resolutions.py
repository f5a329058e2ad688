#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time, memory and cells of `vdbfuse fuse` from 128 to 1024, by step, beside what was estimated beforehand.

  tests/benchmark/resolutions.py build/bin/vdbfuse OUTDIR [--mesh armadillo.ply] [--scan FOLDER ...]
                                 [--resolutions 128,256,512,1024]

Without --scan it makes 72 views of 1280x960 with 10 % outliers: of the scene `figure` and of every --mesh.
Peak memory is that of the whole process as the system counts it, reading included. Prints a table as Markdown and
writes it, the JSON of every run and a slice through the octree at 512 (cells drawn as in Fig. 3 of the 2007 paper)
into OUTDIR.
"""
import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path

MIB = 1 << 20


def run(command):
    """Wall seconds and peak resident bytes of a process."""
    start = time.monotonic()
    process = subprocess.Popen([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    words = process.stderr.read().decode(errors="replace")
    _, status, usage = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))}: {words.strip().splitlines()[-1:]}")
    return time.monotonic() - start, usage.ru_maxrss * 1024


def make_scans(tool, folder, meshes):
    scans = []
    for scene in ["figure", *meshes]:
        scan = folder / (Path(scene).stem + "-72")
        if not scan.exists():
            run([tool, "synth", scene, scan, "--views", 72, "--size", "1280x960", "--outliers", 0.1])
        scans.append(scan)
    return scans


def dense_cells(report):
    box, voxel = report["options"]["bbox"], report["grid"]["voxel"]
    cells = 1.0
    for axis in range(3):
        cells *= (box[3 + axis] - box[axis]) / voxel
    return cells


def row(scan, resolution, report, seconds, peak):
    grid, estimated = report["grid"], report["memory"]["estimated_bytes"]
    steps = " ".join(f"{s['name']} {s['seconds']:.1f}" for s in report["steps"])
    levels = " ".join(str(n) for n in grid["levels"])
    return (f"| {scan.name} | {resolution} | {seconds:.1f} | {peak / MIB:.0f} | {estimated / MIB:.0f} "
            f"({100 * (estimated / peak - 1):+.0f} %) | {grid['cells']} ({100 * grid['cells'] / dense_cells(report):.2g} %) "
            f"| {levels} | {report['mesh']['components']} / {report['mesh']['open_edges']} | {steps} |")


def growth(rows):
    lines = []
    for (scan, low, seconds, peak, cells), (other, high, more_seconds, more_peak, more_cells) in zip(rows, rows[1:]):
        if scan == other:
            lines.append(f"{scan.name}, {low} to {high}: time x {more_seconds / seconds:.2f}, "
                         f"memory x {more_peak / peak:.2f}, cells x {more_cells / cells:.2f}")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", type=Path)
    parser.add_argument("outdir", type=Path)
    parser.add_argument("--mesh", action="append", default=[])
    parser.add_argument("--scan", action="append", type=Path, default=[])
    parser.add_argument("--resolutions", default="128,256,512,1024")
    arguments = parser.parse_args()
    arguments.outdir.mkdir(parents=True, exist_ok=True)
    lines = ["| scan | resolution | s | MiB | estimated MiB | cells (of the dense grid) | by level, finest first "
             "| components / open edges | steps, s |", "|---|---|---|---|---|---|---|---|---|"]
    rows = []
    for scan in arguments.scan or make_scans(arguments.tool, arguments.outdir, arguments.mesh):
        for resolution in map(int, arguments.resolutions.split(",")):
            name = arguments.outdir / f"{scan.name}-{resolution}"
            grids = ["--save-grids", f"{name}.vdb"] if resolution == 512 else []
            seconds, peak = run([arguments.tool, "fuse", scan, f"{name}.ply", "--resolution", resolution,
                                 "--json", f"{name}.json", "--overwrite"])
            report = json.loads(Path(f"{name}.json").read_text())
            lines.append(row(scan, resolution, report, seconds, peak))
            rows.append((scan, resolution, seconds, peak, report["grid"]["cells"]))
            print(lines[-1], flush=True)
            if grids:  # a run of its own: keeping grids costs memory
                run([arguments.tool, "fuse", scan, f"{name}.ply", "--resolution", resolution, "--overwrite", *grids])
                run([arguments.tool, "render", f"{name}.vdb", f"{name}-cells.png", "--slice", "y=0", "--grid",
                     "sigma", "--cells", "--size", "1600x1600", "--overwrite"])
    text = "\n".join(lines + [""] + growth(rows)) + "\n"
    (arguments.outdir / "resolutions.md").write_text(text)
    print("\n" + text)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: Apache-2.0
"""Runs of every subcommand that takes long or writes, for the tests of interrupts and of full disks."""

import os
import pathlib
import subprocess


class Run:
    """A command line; `outputs` are the names that it writes into the folder it runs in."""

    def __init__(self, name, arguments, outputs):
        self.name, self.arguments, self.outputs = name, arguments, outputs


def make_inputs(tool, folder):
    """Scans, photographs, a mesh and grids in `folder`."""
    size = "320x240"

    def call(*arguments):
        subprocess.run([tool, *arguments, "--quiet"], cwd=folder, check=True)

    call("synth", "figure", "scan", "--arc", "ring", "--views", "12", "--size", size, "--outliers", "0.05",
         "--textured")
    call("synth", "figure", "photographs", "--arc", "ring", "--views", "8", "--size", size,
         "--textured", "--images-only")
    call("fuse", "scan", "mesh.ply", "--resolution", "128", "--save-grids", "grids.vdb")


def runs(inputs):
    scan, photographs = str(inputs / "scan"), str(inputs / "photographs")
    mesh, grids = str(inputs / "mesh.ply"), str(inputs / "grids.vdb")
    resolution = "96"
    return [
        Run("fuse", ["fuse", scan, "out.ply", "--resolution", resolution, "--save-grids", "out.vdb", "--json",
                     "out.json", "--save-config", "out.toml"], ["out.ply", "out.vdb", "out.json", "out.toml"]),
        Run("fuse tsdf", ["fuse", scan, "out.obj", "--method", "tsdf", "--resolution", resolution], ["out.obj"]),
        Run("fuse simplify", ["fuse", scan, "out.glb", "--resolution", resolution, "--simplify", "5000"],
            ["out.glb"]),
        Run("fuse photographs", ["fuse", photographs, "out.stl", "--resolution", resolution], ["out.stl"]),
        Run("fuse --explain", ["fuse", scan, "--explain", "--save-config", "out.toml"], ["out.toml"]),
        Run("stereo", ["stereo", photographs, "out", "--json", "out.json"], ["out", "out.json"]),
        Run("judge", ["judge", scan, "out", "--json", "out.json"], ["out", "out.json"]),
        Run("convert", ["convert", scan, "out", "--to", "rgbd"], ["out"]),
        Run("synth", ["synth", "figure", "out", "--views", "16"], ["out"]),
        Run("evaluate", ["evaluate", mesh, scan + "/truth.ply", "--deep", "0.01", "--json", "out.json"],
            ["out.json"]),
        Run("compare", ["compare", scan, "out", "--reference", scan + "/truth.ply", "--resolution", resolution, "--json",
                        "out.json"], ["out", "out.json"]),
        Run("render", ["render", mesh, "out.png", "--turntable", "16"], ["out.png"]),
        Run("render slice", ["render", grids, "out.png", "--slice", "z=0", "--cells", "--size", "2000x2000"],
            ["out.png"]),
        Run("info", ["info", scan, "--json", "out.json"], ["out.json"]),
    ]


def contents(folder):
    """Everything in a folder, hidden files too: path to bytes."""
    folder = pathlib.Path(folder)
    return {str(p.relative_to(folder)): p.read_bytes() if p.is_file() else None for p in sorted(folder.rglob("*"))}


def put_older_results(run, folder):
    """What was there before the run, and must be there after it failed."""
    for name in run.outputs:
        path = pathlib.Path(folder) / name
        if path.suffix:
            path.write_text("older result\n")
        else:
            path.mkdir()
            (path / "older").write_text("older result\n")


def command(tool, run):
    """`run` with the flag that lets it replace older results. Evaluate replaces its file as it is."""
    return [tool, *run.arguments, "--overwrite"]


def environment(scratch):
    return dict(os.environ, VDBFUSE_PROGRESS="json", TMPDIR=str(scratch))

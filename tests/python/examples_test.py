# SPDX-License-Identifier: Apache-2.0
"""Each script of examples/python on a small synthetic scan."""
import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import vdbfuse

EXAMPLES = Path(os.environ["VDBFUSE_SOURCE"]) / "examples" / "python"


def run(name, *arguments):
    done = subprocess.run([sys.executable, "-B", EXAMPLES / name, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def scan(tmp_path_factory):
    folder = tmp_path_factory.mktemp("examples") / "scan"
    subprocess.run([os.environ["VDBFUSE_TOOL"], "synth", "figure", folder, "--hard", "--views", "24", "--size", "160x120",
                    "--textured"], check=True, capture_output=True)
    return folder


def score(path, scan):
    return vdbfuse.evaluate(path, scan / "truth.ply", tau=0.02, samples=20000)


def test_a_tsdf_of_open3d_is_replaced_line_by_line(scan, tmp_path):
    assert "0 open edges" in run("01_open3d_tsdf.py", scan, tmp_path / "mesh.ply", 0.015)
    assert vdbfuse.read_mesh(tmp_path / "mesh.ply").colors is not None
    floaters, closed = score(tmp_path / "mesh.ply", scan), score(tmp_path / "mesh.closed.ply", scan)
    assert closed["closed"] and closed["components"] < 4 < floaters["components"]
    assert closed["fscore"][0] > max(0.85, floaters["fscore"][0])


def write_radiance_field(scan, folder, kind):
    """What renderers write: OpenGL's axes, pixel centres at .5, arrays of floats."""
    data = vdbfuse.read(scan)
    folder.mkdir()
    k = data[0].intrinsics
    frames = []
    for view in data:
        depth = view.depth
        if kind == "range":
            y, x = np.mgrid[0:depth.shape[0], 0:depth.shape[1]]
            depth = depth * np.sqrt(1 + ((x - k[0, 2]) / k[0, 0]) ** 2 + ((y - k[1, 2]) / k[1, 1]) ** 2)
        np.save(folder / f"{view.name}.npy", depth[..., np.newaxis])
        frames.append({"depth_file_path": f"{view.name}.npy",
                       "transform_matrix": (view.world_from_camera @ np.diag([1, -1, -1, 1])).tolist()})
    scene = {"fl_x": k[0, 0], "fl_y": k[1, 1], "cx": k[0, 2] + 0.5, "cy": k[1, 2] + 0.5, "frames": frames}
    (folder / "transforms.json").write_text(json.dumps(scene))


@pytest.mark.parametrize("kind", ["z", "range"])
def test_depth_of_a_radiance_field_becomes_a_mesh(scan, tmp_path, kind):
    write_radiance_field(scan, tmp_path / "field", kind)
    flags = ["--range"] if kind == "range" else []
    assert "closed: True" in run("02_radiance_field.py", tmp_path / "field", tmp_path / "mesh.ply", 64, *flags)
    assert score(tmp_path / "mesh.ply", scan)["fscore"][0] > 0.8


def test_depth_and_confidence_of_a_network_become_a_mesh(scan, tmp_path):
    data = vdbfuse.read(scan)
    for kind in ("depth", "confidence"):
        (tmp_path / kind).mkdir()
    for index, view in enumerate(data):
        np.save(tmp_path / "depth" / f"{index:04}.npy", view.depth)
        np.save(tmp_path / "confidence" / f"{index:04}.npy", 1 + 5 * view.confidence)
    np.save(tmp_path / "intrinsics.npy", data[0].intrinsics)
    np.save(tmp_path / "extrinsics.npy", np.linalg.inv(data.world_from_camera)[:, :3])
    assert "confidence: high is good" in run("03_network_depth.py", tmp_path, tmp_path / "mesh.ply", 0.015)
    assert score(tmp_path / "mesh.ply", scan)["precision"][0] > 0.9


@pytest.mark.skipif(importlib.util.find_spec("matplotlib") is None, reason="python3-matplotlib is not installed")
def test_slices_and_mesh_are_drawn(scan, tmp_path):
    out = Path(os.environ.get("VDBFUSE_PICTURES", tmp_path)) / "slices.png"
    assert "certified cut: True" in run("04_slices_and_mesh.py", scan, out, 64)
    assert out.read_bytes().startswith(b"\x89PNG") and out.stat().st_size > 50000

# SPDX-License-Identifier: Apache-2.0
"""What Python makes is what the command line tool makes, byte by byte."""
import filecmp
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import vdbfuse

DATA = Path(os.environ["VDBFUSE_DATA"])


def tool(*arguments):
    subprocess.run([os.environ["VDBFUSE_TOOL"], *map(str, arguments)], check=True, capture_output=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("tool")


@pytest.fixture(scope="module")
def hard(folder):
    """A scan with the mistakes of a stereo matcher, its confidences and pictures."""
    tool("synth", "figure", folder / "hard", "--hard", "--views", 16, "--size", "200x150", "--textured")
    return folder / "hard"


def same_mesh(mesh, path):
    mesh.save(path.with_suffix(".python.ply"))
    return filecmp.cmp(path.with_suffix(".python.ply"), path, shallow=False)


def arrays_of(data):
    views = list(data)
    return ([view.depth for view in views], [view.intrinsics for view in views],
            np.stack([view.world_from_camera for view in views]), [view.confidence for view in views])


def test_two_lines_on_a_hard_scan(hard, folder):
    tool("fuse", hard, folder / "hard.ply", "--resolution", 64)
    mesh = vdbfuse.fuse(vdbfuse.read(hard), resolution=64)
    assert mesh.colors is not None and same_mesh(mesh, folder / "hard.ply")
    assert same_mesh(vdbfuse.fuse(hard, resolution=64), folder / "hard.ply")


def test_arrays_make_the_same_mesh_as_files(hard, folder):
    tool("convert", hard, folder / "numpy", "--to", "numpy")
    tool("fuse", folder / "numpy", folder / "arrays.ply", "--resolution", 64)
    with np.load(next((folder / "numpy").glob("*.npz"))) as arrays:
        a = dict(arrays)
    for form in (a["depth"], list(a["depth"]), iter(a["depth"]), lambda i: a["depth"][i]):
        mesh = vdbfuse.fuse(form, a["intrinsics"], a["world_from_camera"], a["confidence"], colors=a["color"], resolution=64)
        assert same_mesh(mesh, folder / "arrays.ply")


def test_every_option_reaches_the_pipeline(hard, folder):
    tool("fuse", hard, folder / "options.ply", "--resolution", 48, "--views", 12, "--mu", 1.5, "--border", "free", "--trim", 0.3,
         "--thickness", "off", "--min-component", 0.05, "--simplify", 3000, "--noise", "logistic", "--rule", "paper",
         "--no-denial", "--completion", "none", "--max-depth", 2.5, "--threads", 1, "--visibility-prior", 0.4, "--lambda", 20)
    mesh = vdbfuse.fuse(hard, resolution=48, views=12, mu=1.5, border="free", trim=0.3, thickness="off", min_component=0.05,
                        simplify=3000, noise="logistic", rule="paper", no_denial=True, completion="none", max_depth=2.5,
                        threads=1, visibility_prior=0.4, lambda_=20)
    assert same_mesh(mesh, folder / "options.ply")


def test_method_tsdf_is_the_same(hard, folder):
    tool("fuse", hard, folder / "tsdf.ply", "--resolution", 64, "--method", "tsdf", "--carve", "--weights", "confidence,noise",
         "--truncation", 0.1, "--close-gaps", 1)
    mesh = vdbfuse.fuse(hard, resolution=64, method="tsdf", carve=True, weights=["confidence", "noise"], truncation=0.1,
                        close_gaps=1)
    assert same_mesh(mesh, folder / "tsdf.ply")


def test_the_report_has_the_members_of_the_json(hard, folder):
    tool("fuse", hard, folder / "report.ply", "--resolution", 48, "--json", folder / "report.json")
    theirs = json.loads((folder / "report.json").read_text())
    mine = vdbfuse.fuse(hard, resolution=48).report
    for part in ("calibration", "energy", "cut", "completion"):
        for name, value in theirs[part].items():
            assert mine[part][name] == value, (part, name)
    for name in ("voxel", "active", "leaves", "cells", "levels"):
        assert mine["grid"][name] == theirs["grid"][name]
    assert [step["name"] for step in mine["steps"]] == [step["name"] for step in theirs["steps"]]


def test_evaluation_has_the_members_of_the_json(hard, folder):
    tool("fuse", hard, folder / "evaluated.ply", "--resolution", 48)
    tool("evaluate", folder / "evaluated.ply", hard / "truth.ply", "--tau", "0.01,0.02", "--deep", 0.02, "--json",
         folder / "evaluated.json")
    theirs = json.loads((folder / "evaluated.json").read_text())
    mine = vdbfuse.evaluate(folder / "evaluated.ply", hard / "truth.ply", tau=(0.01, 0.02), deep=0.02)
    for name in theirs.keys() - {"version", "command", "options"}:
        assert mine[name] == theirs[name], name


def test_a_judgement_is_the_same(hard, folder):
    tool("judge", hard, folder / "judged")
    judged = vdbfuse.judge(hard)
    judged.save(folder / "judged.python")
    files = sorted(path.relative_to(folder / "judged") for path in (folder / "judged").rglob("*.png"))
    assert len(files) == 32
    assert filecmp.cmpfiles(folder / "judged", folder / "judged.python", files, shallow=False)[0] == files
    theirs = json.loads((folder / "judged" / "judgement.json").read_text())
    mine = judged.report
    assert all(mine[name] == theirs[name] for name in theirs if name != "input")


def test_data_sets_written_are_read_back(hard, folder):
    data = vdbfuse.read(hard)
    vdbfuse.write(folder / "written", data)
    again = vdbfuse.read(folder / "written")
    assert again.format == "numpy" and "float" in again.reading["stored"]
    for a, b in zip(data, again):
        assert np.array_equal(a.depth, b.depth) and np.array_equal(a.color, b.color)
        assert np.allclose(a.world_from_camera, b.world_from_camera)
    with pytest.raises(OSError, match="written"):
        vdbfuse.write(folder / "written", data)
    with pytest.raises(ValueError, match="format"):
        vdbfuse.write(folder / "other", data, "kitti")


def test_another_convention_can_be_taken(hard, folder):
    depths, intrinsics, poses, _ = arrays_of(vdbfuse.read(hard))
    np.savez(folder / "inverse.npz", depth=np.stack(depths), intrinsics=np.stack(intrinsics),
             world_from_camera=np.linalg.inv(poses))
    for convention in ("auto", "inverse"):
        data = vdbfuse.read(folder / "inverse.npz", fix_convention=convention)
        assert np.allclose(data.world_from_camera, poses, atol=1e-6) and "inverse" in data.notes[-1]
    with pytest.raises(ValueError, match="fix_convention: expected 'none', 'auto', or a list of"):
        vdbfuse.read(folder / "inverse.npz", fix_convention="upside-down")


def test_photographs_become_the_same_surface(folder):
    tool("synth", "figure", folder / "photographs", "--arc", "ring", "--views", 12, "--size", "160x120", "--textured",
         "--images-only")
    tool("fuse", folder / "photographs", folder / "photographs.ply", "--resolution", 48)
    data = vdbfuse.stereo(folder / "photographs")
    assert len(data) == 12 and data[0].confidence is not None and len(data.report[0]["partners"]) > 0
    assert same_mesh(vdbfuse.fuse(data, resolution=48), folder / "photographs.ply")
    views = list(data)
    arrays = vdbfuse.stereo([view.color for view in views], [view.intrinsics for view in views],
                            [view.world_from_camera for view in views], min_depth=0.8, max_depth=2.2)
    assert len(arrays) == 12 and (arrays[0].depth > 0).mean() > 0.1
    with pytest.raises(ValueError, match="images: expected one for each of 12 poses, found 3"):
        vdbfuse.stereo([view.color for view in views[:3]], views[0].intrinsics, [view.world_from_camera for view in views])


@pytest.mark.skipif(not (DATA / "kitchen-rgbd").is_dir(), reason="no kitchen-rgbd in $VDBFUSE_DATA")
def test_two_lines_on_a_kitchen(folder):
    kitchen = DATA / "kitchen-rgbd"
    tool("fuse", kitchen, folder / "kitchen.ply", "--views", 30, "--voxel", 0.03, "--max-depth", 4)
    mesh = vdbfuse.fuse(vdbfuse.read(kitchen, views=30, max_depth=4), voxel=0.03)
    assert same_mesh(mesh, folder / "kitchen.ply")

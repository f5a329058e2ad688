# SPDX-License-Identifier: Apache-2.0
import threading

import numpy as np
import pytest
import vdbfuse
from scenes import INTRINSICS, radius_error, sphere

VOXEL = 0.04


@pytest.fixture(scope="module")
def scan():
    return sphere()


def integrated(scan, **options):
    volume = vdbfuse.TSDF(voxel=VOXEL, **options)
    for depth, pose in zip(*scan):
        volume.integrate(depth, INTRINSICS, pose)
    return volume


def pushed(scan, **options):
    scanner = vdbfuse.Scanner(voxel=VOXEL, when_full="wait", **options)
    numbers = [scanner.push(depth, INTRINSICS, pose) for depth, pose in zip(*scan)]
    return scanner, numbers


def test_views_integrated_one_by_one_give_the_sphere(scan):
    volume = vdbfuse.TSDF(voxel=VOXEL)
    reports = [volume.integrate(depth, INTRINSICS, pose) for depth, pose in zip(*scan)]
    assert reports[0]["leaves"] == reports[0]["created"] > 0 and reports[0]["voxels"] > 0
    assert radius_error(volume.mesh()) < VOXEL / 2
    assert volume.leaves > 0 and volume.memory_bytes > 8 * 512 * volume.leaves
    assert "blocks of 8x8x8 voxels" in repr(volume)


def test_a_view_taken_out_leaves_no_trace(scan):
    depths, poses = scan
    volume, without = integrated(scan), integrated((depths[:-1], poses[:-1]))
    volume.remove(depths[-1], INTRINSICS, poses[-1])
    assert np.allclose(volume.mesh().vertices, without.mesh().vertices, atol=1e-5)


def test_a_volume_on_disk_goes_on(scan, tmp_path):
    depths, poses = scan
    half = integrated((depths[:7], poses[:7]))
    half.save(tmp_path / "half.vdb")
    volume = vdbfuse.TSDF.load(tmp_path / "half.vdb")
    for depth, pose in zip(depths[7:], poses[7:]):
        volume.integrate(depth, INTRINSICS, pose)
    assert np.array_equal(volume.mesh().vertices, integrated(scan).mesh().vertices)


def test_a_volume_keeps_colors(scan):
    depths, poses = scan
    volume = vdbfuse.TSDF(voxel=VOXEL, colors=True, storage="half", weights="none")
    for depth, pose in zip(depths, poses):
        volume.integrate(depth, INTRINSICS, pose, color=np.full((*depth.shape, 3), (10, 200, 30), np.uint8))
    assert np.abs(volume.mesh().colors.astype(int) - (10, 200, 30)).max() <= 1


def test_blocks_are_those_that_changed(scan):
    depths, poses = scan
    volume = integrated((depths[:7], poses[:7]))
    first = volume.changed_blocks()
    assert sum(len(mesh.triangles) for _, mesh in first) > 0 and all(len(origin) == 3 for origin, _ in first)
    assert volume.changed_blocks() == []
    volume.integrate(depths[8], INTRINSICS, poses[8])
    assert 0 < len(volume.changed_blocks()) <= len(first) + 8


def test_a_view_is_made_once_and_used_often(scan):
    depths, poses = scan
    view = vdbfuse.view(np.round(1000 * depths[0]).astype(np.uint16), INTRINSICS, camera_from_world=np.linalg.inv(poses[0]))
    assert np.allclose(view.depth, depths[0], atol=5e-4) and np.allclose(view.world_from_camera, poses[0])
    volume = vdbfuse.TSDF(voxel=VOXEL)
    assert volume.integrate(view)["created"] > 0
    with pytest.raises(TypeError, match="view: has a camera, a pose and images of its own"):
        volume.integrate(view, INTRINSICS)


def test_the_scanner_ends_with_the_watertight_surface_of_all_views(scan):
    scanner, numbers = pushed(scan)
    assert numbers == list(range(1, len(numbers) + 1))
    mesh = scanner.finish(voxel=VOXEL)
    assert mesh.topology()["closed"]
    expected = vdbfuse.fuse(scanner.views(), voxel=VOXEL)
    assert np.array_equal(mesh.vertices, expected.vertices) and mesh.report["cut"]["certified"]


def test_the_preview_is_the_volume(scan):
    scanner, numbers = pushed(scan)
    scanner.wait()
    preview = scanner.preview()
    assert preview.newest == numbers[-1] and preview.removed == [] and len(preview.changed) > 0
    assert np.array_equal(scanner.mesh().vertices, integrated(scan).mesh().vertices)
    assert scanner.preview().changed == []
    status = scanner.status()
    assert status["integrated"] == status["kept"] == len(numbers) and status["waiting"] == 0
    assert f"{len(numbers)} views" in repr(scanner)


def test_poses_corrected_later_count(scan):
    depths, poses = scan
    moved = poses.copy()
    moved[5, :3, 3] += 0.2
    scanner, numbers = pushed((depths, moved))
    scanner.correct_poses({numbers[5]: poses[5]})
    scanner.wait()
    assert np.allclose(scanner.views().world_from_camera[5], poses[5])
    scanner.correct_poses({numbers[2]: np.linalg.inv(poses[2])}, direction="camera_from_world")
    scanner.remove(numbers[0])
    scanner.wait()
    assert len(scanner.views()) == len(poses) - 1
    with pytest.raises(ValueError, match="there is none with number 99"):
        scanner.remove(99)
    with pytest.raises(ValueError, match=r"poses\[0\]: .*expected a rotation"):
        scanner.correct_poses({numbers[1]: np.diag([2.0, 1, 1, 1])})


def test_key_views_are_enough(scan):
    scanner, _ = pushed(scan)
    scanner.wait()
    assert len(scanner.views(distance=100.0, angle=10.0)) == 1
    with pytest.raises(ValueError, match="key_views"):
        scanner.views(distance=-1.0)


def test_one_thread_integrates_while_another_makes_meshes(scan):
    volume = vdbfuse.TSDF(voxel=VOXEL)
    meshes, done = [], threading.Event()

    def look():
        while not done.is_set():
            meshes.append(len(volume.mesh().triangles))
    viewer = threading.Thread(target=look)
    viewer.start()
    for depth, pose in zip(*scan):
        volume.integrate(depth, INTRINSICS, pose)
    done.set()
    viewer.join()
    assert meshes == sorted(meshes) or max(meshes) > 0
    assert np.array_equal(volume.mesh().vertices, integrated(scan).mesh().vertices)


def test_options_that_cannot_be():
    with pytest.raises(ValueError, match="voxel: expected a positive number, found 0"):
        vdbfuse.TSDF(voxel=0)
    with pytest.raises(ValueError, match="when_full: expected one of 'drop-oldest', 'drop-newest', 'wait'"):
        vdbfuse.Scanner(voxel=1, when_full="panic")
    with pytest.raises(OSError, match="nothing.vdb"):
        vdbfuse.TSDF.load("nothing.vdb")

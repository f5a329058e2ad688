# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
import vdbfuse
from scenes import FLIP, INTRINSICS, radius_error, sphere, sphere_depth

VOXEL = 0.04


@pytest.fixture(scope="module")
def scan():
    return sphere()


@pytest.fixture(scope="module")
def ball(scan):
    depths, poses = scan
    return vdbfuse.fuse(depths, INTRINSICS, poses, voxel=VOXEL)


def same(a, b):
    return np.array_equal(a.vertices, b.vertices) and np.array_equal(a.triangles, b.triangles) and \
        np.array_equal(a.normals, b.normals) and np.array_equal(a.support, b.support)


def test_a_sphere_comes_out_closed_and_round(ball):
    assert ball.topology()["closed"] and ball.topology()["components"] == 1
    assert radius_error(ball) < VOXEL / 4
    assert ball.volume == pytest.approx(4 / 3 * np.pi * 0.125, rel=0.02)


def test_arrays_have_the_promised_shapes_and_types(ball):
    vertices, triangles = len(ball.vertices), len(ball.triangles)
    assert ball.vertices.shape == (vertices, 3) and ball.vertices.dtype == np.float32
    assert ball.triangles.shape == (triangles, 3) and ball.triangles.dtype == np.uint32
    assert ball.normals.shape == (vertices, 3) and ball.support.shape == (vertices,)
    assert ball.confidence.min() >= 0 and ball.confidence.max() <= 1
    assert ball.colors is None
    assert f"{vertices} vertices, {triangles} triangles" in repr(ball)


def test_arrays_are_views_that_keep_the_mesh_alive(scan):
    depths, poses = scan
    mesh = vdbfuse.fuse(depths, INTRINSICS, poses, voxel=0.1)
    assert mesh.vertices.base is mesh
    assert np.shares_memory(mesh.vertices, mesh.vertices)
    vertices, expected = mesh.vertices, mesh.vertices.copy()
    del mesh
    assert np.array_equal(vertices, expected)
    with pytest.raises(ValueError, match="read-only"):
        vertices[0] = 0


def test_the_report_says_what_was_found_out(ball):
    report = ball.report
    assert report["grid"]["voxel"] == VOXEL and len(report["grid"]["bbox"]) == 6
    assert report["cut"]["certified"] and report["energy"]["metric"] == "faces"
    assert [step["name"] for step in report["steps"]][-1] in ("surface", "colour")
    assert report["calibration"]["confidence_direction"] == "none"
    assert report["memory"]["budget_bytes"] > 0


def test_the_form_of_the_depths_does_not_matter(scan, ball):
    depths, poses = scan
    for form in (list(depths), tuple(depths), lambda i: depths[i], (d for d in depths), iter(list(depths)),
                 depths[..., np.newaxis], depths.astype(np.float64)):
        assert same(vdbfuse.fuse(form, INTRINSICS, poses, voxel=VOXEL), ball)


def test_rows_may_lie_anywhere(scan, ball):
    depths, poses = scan
    wide = np.zeros((len(depths), depths.shape[1], 2 * depths.shape[2]), np.float32)
    wide[..., ::2] = depths
    upside_down = np.ascontiguousarray(depths[:, ::-1])
    for form in (wide[..., ::2], upside_down[:, ::-1], np.asfortranarray(depths), depths.astype(">f4")):
        assert same(vdbfuse.fuse(form, INTRINSICS, poses, voxel=VOXEL), ball)


def test_the_form_of_cameras_and_poses_does_not_matter(scan, ball):
    depths, poses = scan
    fx, fy, cx, cy = INTRINSICS
    k = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    forms = [(k, poses), ([INTRINSICS] * len(poses), poses), (np.stack([k] * len(poses)), poses[:, :3]),
             (INTRINSICS, list(poses))]
    for intrinsics, matrices in forms:
        assert same(vdbfuse.fuse(depths, intrinsics, matrices, voxel=VOXEL), ball)


def test_poses_go_either_way_by_name(scan, ball):
    depths, poses = scan
    assert same(vdbfuse.fuse(depths, INTRINSICS, world_from_camera=poses, voxel=VOXEL), ball)
    mesh = vdbfuse.fuse(depths, INTRINSICS, camera_from_world=np.linalg.inv(poses), voxel=VOXEL)
    assert len(mesh.triangles) == pytest.approx(len(ball.triangles), rel=0.01)
    assert radius_error(mesh) < VOXEL / 4


def test_axes_of_opengl_are_turned(scan, ball):
    depths, poses = scan
    assert same(vdbfuse.fuse(depths, INTRINSICS, poses @ FLIP, axes="opengl", voxel=VOXEL), ball)


def test_whole_numbers_are_thousandths(scan):
    depths, poses = scan
    millimetres = np.round(1000 * depths).astype(np.uint16)
    mesh = vdbfuse.fuse(millimetres, INTRINSICS, poses, voxel=VOXEL)
    assert radius_error(mesh) < VOXEL / 4
    tenths = np.round(10000 * depths).astype(np.uint16)
    assert radius_error(vdbfuse.fuse(tenths, INTRINSICS, poses, voxel=VOXEL, depth_scale=0.0001)) < VOXEL / 4


def test_inverse_depth_and_disparity_are_understood(scan, ball):
    depths, poses = scan
    with np.errstate(divide="ignore"):
        inverse = np.where(depths > 0, 1 / depths, 0)
    assert radius_error(vdbfuse.fuse(inverse, INTRINSICS, poses, voxel=VOXEL, depth_kind="inverse")) < VOXEL / 4
    disparity = inverse * INTRINSICS[0] * 0.1
    assert radius_error(vdbfuse.fuse(disparity, INTRINSICS, poses, voxel=VOXEL, depth_kind="disparity",
                                     baseline=0.1)) < VOXEL / 4


def test_views_may_differ_in_size(scan):
    depths, poses = scan
    half = (45.0, 45.0, 23.5, 17.5)
    images = [sphere_depth(pose, half, 48, 36) if i % 2 else depth for i, (depth, pose) in enumerate(zip(depths, poses))]
    cameras = [half if i % 2 else INTRINSICS for i in range(len(poses))]
    assert radius_error(vdbfuse.fuse(images, cameras, poses, voxel=VOXEL)) < VOXEL / 3


def test_colors_reach_the_mesh(scan):
    depths, poses = scan
    colors = np.full((*depths.shape, 3), (200, 100, 50), np.uint8)
    for form in (colors, (c for c in colors)):
        mesh = vdbfuse.fuse(depths, INTRINSICS, poses, voxel=VOXEL, colors=form)
        assert mesh.colors.shape == (len(mesh.vertices), 3)
        assert np.abs(mesh.colors.astype(int) - (200, 100, 50)).max() <= 1
    assert vdbfuse.fuse(depths, INTRINSICS, poses, voxel=VOXEL, colors=colors, color="none").colors is None


def test_masks_empty_the_space_beside_the_object(scan, ball):
    depths, poses = scan
    noisy = depths.copy()
    noisy[depths == 0] = 2.5  # a wall all around that moves along with the camera
    mesh = vdbfuse.fuse(noisy, INTRINSICS, poses, voxel=VOXEL, masks=depths > 0)
    assert radius_error(mesh) < VOXEL / 2


def test_wrong_pixels_with_low_confidence_are_found_out(scan):
    depths, poses = scan
    random = np.random.default_rng(1)
    wrong = (random.random(depths.shape) < 0.2) & (depths > 0)
    noisy = np.where(wrong, random.uniform(0.5, 2.5, depths.shape), depths).astype(np.float32)
    confidences = np.where(wrong, 0.1, 0.9) + 0.05 * random.standard_normal(depths.shape)
    mesh = vdbfuse.fuse(noisy, INTRINSICS, poses, confidences, voxel=VOXEL)
    assert mesh.report["calibration"]["confidence_direction"] == "high is good"
    assert mesh.report["calibration"]["outlier_share"] == pytest.approx(0.2, abs=0.05)
    assert radius_error(mesh) < VOXEL / 2


def test_method_tsdf_leaves_unseen_parts_open(scan):
    depths, poses = scan
    mesh = vdbfuse.fuse(depths[:3], INTRINSICS, poses[:3], method="tsdf", voxel=VOXEL)
    assert mesh.topology()["open_edges"] > 0
    assert mesh.report["truncation"] >= 4 * VOXEL and "cut" not in mesh.report


def test_poses_the_wrong_way_round_are_warned_of(scan):
    depths, poses = sphere(8)
    poses = poses.copy()
    poses[:, :3, 3] += (0.4, 0.1, 0.2)  # not symmetric about the origin
    with pytest.warns(UserWarning, match="camera_from_world"), pytest.raises(RuntimeError, match="the result is empty"):
        vdbfuse.fuse(depths, INTRINSICS, np.linalg.inv(poses), voxel=0.1, bbox=(-9, -9, -9, 9, 9, 9))


def test_grids_can_be_kept_cut_and_saved(scan, tmp_path):
    depths, poses = scan
    mesh = vdbfuse.fuse(depths, INTRINSICS, poses, voxel=VOXEL, grids=True)
    assert {"surface", "rho", "sigma", "support"} <= set(mesh.grids)
    values, (left, right, bottom, top) = mesh.slice("surface", "z", 0.0, 200)
    assert max(values.shape) == 200 and left < -0.5 < 0.5 < right and bottom < -0.5 < 0.5 < top
    y, x = np.mgrid[0:values.shape[0], 0:values.shape[1]]
    radius = np.hypot(left + (x + 0.5) * (right - left) / values.shape[1], top - (y + 0.5) * (top - bottom) / values.shape[0])
    known = np.isfinite(values)
    assert ((values > 0) == (radius > 0.5))[known].mean() > 0.95
    sigma, _ = mesh.slice("sigma")
    assert np.nanmin(sigma) < 0 < np.nanmax(sigma)
    mesh.save_grids(tmp_path / "grids.vdb")
    assert (tmp_path / "grids.vdb").stat().st_size > 1000


def test_grids_that_were_not_kept_are_said_so(ball):
    assert ball.grids == []
    with pytest.raises(ValueError, match=r"fuse\(\.\.\., grids=True\)"):
        ball.slice()


def test_trim_and_simplify_give_new_meshes(ball):
    fewer = ball.simplify(500)
    assert len(fewer.triangles) <= 500 < len(ball.triangles) and fewer.topology()["closed"]
    trimmed = ball.trim(float(np.median(ball.support)))
    assert 0 < len(trimmed.triangles) < len(ball.triangles) and not trimmed.topology()["closed"]


def test_a_mesh_saved_is_read_back(ball, tmp_path):
    ball.save(tmp_path / "ball.ply")
    again = vdbfuse.read_mesh(tmp_path / "ball.ply")
    assert np.array_equal(again.vertices, ball.vertices) and np.array_equal(again.triangles, ball.triangles)
    assert np.array_equal(again.support, ball.support)


def test_a_data_set_is_a_sequence_of_views(scan):
    depths, poses = scan
    data = vdbfuse.data_set(depths, INTRINSICS, poses, names=[f"n{i}" for i in range(len(poses))])
    assert len(data) == len(poses) and data.names[3] == "n3"
    assert np.array_equal(data[2].depth, depths[2]) and data[-1].name == "n13"
    assert np.allclose(data.world_from_camera, poses)
    assert np.allclose(data[2].world_from_camera @ data[2].camera_from_world, np.eye(4))
    assert data[0].intrinsics[0, 0] == 90 and data[0].projection == "pinhole" and data[0].shape == (72, 96)
    assert data[0].color is None and data[0].confidence is None and data[0].mask is None
    assert sum(1 for _ in data.first(5)) == 5
    with pytest.raises(IndexError):
        data[14]


def test_a_mesh_is_compared_with_the_truth(ball):
    result = vdbfuse.evaluate(ball, ball, tau=[0.01, 0.02])
    assert result["fscore"] == pytest.approx([1, 1]) and result["iou"] == pytest.approx(1) and result["closed"]
    arrays = vdbfuse.evaluate((ball.vertices, ball.triangles.astype(np.int32)), ball, tau=0.01, samples=1000)
    assert arrays["fscore"] == pytest.approx([1])


def test_each_pixel_is_judged(scan):
    depths, poses = scan
    random = np.random.default_rng(1)
    wild = (random.random(depths.shape) < 0.1) & (depths > 0)
    judged = vdbfuse.judge(np.where(wild, random.uniform(0.5, 2.5, depths.shape), depths), INTRINSICS, poses)
    assert len(judged) == len(poses)
    outlier = judged[5].outlier
    assert outlier.shape == depths[5].shape and outlier.dtype == np.float32
    assert np.median(outlier[wild[5]]) > 0.9 and np.median(outlier[(depths[5] > 0) & ~wild[5]]) < 0.1
    assert judged.report["views"][5]["name"] == "view 5" and "outliers" in str(judged)
    assert 0 < judged[5].weight <= 1 and judged[5].incidence.shape == outlier.shape


def test_a_judgement_saved_takes_the_place_of_judging(scan, ball, tmp_path):
    depths, poses = scan
    vdbfuse.judge(depths, INTRINSICS, poses).save(tmp_path / "judged")
    mesh = vdbfuse.fuse(depths, INTRINSICS, poses, voxel=VOXEL, judgement=tmp_path / "judged")
    assert len(mesh.triangles) == pytest.approx(len(ball.triangles), rel=0.02)
    with pytest.raises(OSError, match="holds something already"):
        vdbfuse.judge(depths, INTRINSICS, poses).save(tmp_path / "judged")

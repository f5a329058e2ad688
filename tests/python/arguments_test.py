# SPDX-License-Identifier: Apache-2.0
"""What is wrong is said in Python's own exceptions, and nothing crashes."""
import numpy as np
import pytest
import vdbfuse
from scenes import INTRINSICS, sphere

N = 4


@pytest.fixture(scope="module")
def scan():
    return sphere(N)


def refuse(error, match, *arguments, **keywords):
    with pytest.raises(error, match=match):
        vdbfuse.fuse(*arguments, check=False, **keywords)


def test_depths_of_a_wrong_shape(scan):
    depths, poses = scan
    refuse(ValueError, r"view 0: depth: expected \(H, W\), found shape \(72, 96, 3\)", np.stack([depths] * 3, -1), INTRINSICS,
           poses)
    refuse(ValueError, r"view 0: depth: expected \(H, W\), found shape \(96,\)", depths[:, 0], INTRINSICS, poses)
    refuse(ValueError, r"view 0: depth: expected \(H, W\), found shape \(0, 96\)", depths[:, :0], INTRINSICS, poses)


def test_depths_of_a_wrong_type(scan):
    depths, poses = scan
    for kind in (np.int64, np.int16, np.uint8, bool, np.complex64):
        refuse(TypeError, f"view 0: depth: expected float32 or uint16 .*, found {np.dtype(kind)}", depths.astype(kind),
               INTRINSICS, poses)
    refuse(TypeError, "view 1: depth: expected float32 or uint16 .*, found <U3", [depths[0], [["abc"]], *depths[2:]], INTRINSICS,
           poses)
    refuse(TypeError, "depths: expected a list or an array, .* found int", 7, INTRINSICS, poses)
    refuse(TypeError, "depths: expected arrays, .* found None", None, INTRINSICS, poses)


def test_views_of_a_function_have_the_size_of_the_first(scan):
    depths, poses = scan
    refuse(ValueError, "stored: expected 96x72 pixels, found 96x40", lambda i: depths[i][:40] if i == 2 else depths[i],
           INTRINSICS, poses)


def test_numbers_of_views_that_differ(scan):
    depths, poses = scan
    refuse(ValueError, "depths: expected one for each of 3 poses, found 4", depths, INTRINSICS, poses[:3])
    refuse(ValueError, "confidences: expected one for each of 4 poses, found 1", depths, INTRINSICS, poses, depths[:1])
    refuse(ValueError, "intrinsics: expected one for all or one for each of 4 views, found 3", depths, [INTRINSICS] * 3, poses)
    refuse(ValueError, "names: expected one for each of 4 poses, found 1", depths, INTRINSICS, poses, names=["a"])
    refuse(ValueError, "poses: expected at least one, found none", depths[:0], INTRINSICS, np.zeros((0, 4, 4)))


def test_generators_that_end_too_early_or_too_late(scan):
    depths, poses = scan
    refuse(ValueError, "depths: ended after 3 views, there are more poses", (d for d in depths[:3]), INTRINSICS, poses)
    refuse(ValueError, "depths: goes on after 3 views, there are no more poses", (d for d in depths), INTRINSICS, poses[:3])


def test_images_that_do_not_fit_their_depth(scan):
    depths, poses = scan
    small = depths[:, :40]
    refuse(ValueError, r"view 0: confidence: expected the depth's \(72, 96\), found shape \(40, 96\)", iter(depths), INTRINSICS,
           poses, small)
    refuse(ValueError, r"view \d: mask: expected the depth's \(72, 96\), found shape \(40, 96\)", depths, INTRINSICS, poses,
           masks=small > 0)
    refuse(TypeError, "view 0: color: expected uint8, found float32", iter(depths), INTRINSICS, poses, colors=depths)
    refuse(ValueError, r"view 0: color: expected \(H, W, 3\), found shape \(72, 96\)", iter(depths), INTRINSICS, poses,
           colors=depths.astype(np.uint8))
    refuse(TypeError, "view 0: mask: expected bool or whole numbers, .* found float32", iter(depths), INTRINSICS, poses,
           masks=depths)


def test_poses_that_are_no_rotation(scan):
    depths, poses = scan
    bent, mirrored = poses.copy(), poses.copy()
    bent[2, 0, 0] += 0.3
    mirrored[1, :3, 0] *= -1
    refuse(ValueError, r"poses\[2\]: .*expected a rotation", depths, INTRINSICS, bent)
    refuse(ValueError, r"poses\[1\]: .*a matrix that mirrors", depths, INTRINSICS, mirrored)
    refuse(ValueError, r"poses\[0\]: expected 0 0 0 1 in the last row; is the matrix transposed\?", depths, INTRINSICS,
           poses.transpose(0, 2, 1))
    for form in (iter(depths), depths):
        refuse(ValueError, r"(poses\[3\]|view 3): .*expected a rotation", form, INTRINSICS, _scaled(poses, 3))


def _scaled(poses, index):
    scaled = poses.copy()
    scaled[index, :3, :3] *= 2
    return scaled


def test_poses_of_a_wrong_shape_or_given_twice(scan):
    depths, poses = scan
    refuse(ValueError, r"poses: expected \(N, 4, 4\) or \(N, 3, 4\), found shape \(4, 4, 3\)", depths, INTRINSICS, poses[..., :3])
    refuse(ValueError, "poses: expected matrices of one shape, found several", depths, INTRINSICS, [*poses[:3], np.eye(3)])
    refuse(TypeError, "poses: expected them once", depths, INTRINSICS)
    refuse(TypeError, "poses: expected them once", depths, INTRINSICS, poses, camera_from_world=poses)
    refuse(ValueError, "axes: expected 'opencv' or 'opengl', found 'blender'", depths, INTRINSICS, poses, axes="blender")


def test_nan_in_cameras_and_poses(scan):
    depths, poses = scan
    wrong = poses.copy()
    wrong[1, 0, 3] = np.nan
    refuse(ValueError, "poses: expected finite numbers, found NaN or infinity", depths, INTRINSICS, wrong)
    refuse(ValueError, "camera_from_world: expected finite numbers", depths, INTRINSICS, camera_from_world=wrong)
    refuse(ValueError, "intrinsics: expected finite numbers", depths, (90, np.inf, 47, 35), poses)


def test_nan_and_infinity_in_depths_are_no_measurements(scan):
    depths, poses = sphere(14)
    holes = np.where(depths > 0, depths, np.nan)
    holes[3, 0] = np.inf
    expected = vdbfuse.fuse(depths, INTRINSICS, poses, voxel=0.1)
    assert np.array_equal(vdbfuse.fuse(holes, INTRINSICS, poses, voxel=0.1).vertices, expected.vertices)


def test_depths_that_measured_nothing(scan):
    depths, poses = scan
    refuse(ValueError, "no view has a valid pixel|views", np.full_like(depths, np.nan), INTRINSICS, poses)


def test_cameras_that_are_none(scan):
    depths, poses = scan
    refuse(TypeError, "intrinsics: expected fx, fy, cx, cy or a 3x3 matrix, found None", depths, None, poses)
    refuse(TypeError, "intrinsics: expected numbers, found str", depths, "pinhole", poses)
    refuse(ValueError, r"intrinsics: expected \(4,\), .*, found shape \(3,\)", depths, (90, 47, 35), poses)
    refuse(ValueError, "focal", depths, (-90, 90, 47, 35), poses)
    refuse(ValueError, "intrinsics: expected a camera without skew", depths, [[90, 1, 47], [0, 90, 35], [0, 0, 1]], poses)
    refuse(ValueError, "distortion: expected up to five", depths, INTRINSICS, poses, distortion=[0] * 8)


def test_options_that_do_not_exist_name_the_nearest(scan):
    depths, poses = scan
    refuse(TypeError, r"fuse\(\) has no option 'resolutoin'; did you mean 'resolution'\?", depths, INTRINSICS, poses,
           resolutoin=64)
    refuse(TypeError, r"fuse\(\) has no option 'zzz'$", depths, INTRINSICS, poses, zzz=1)
    with pytest.raises(TypeError, match=r"judge\(\) has no option 'voxel'"):
        vdbfuse.judge(depths, INTRINSICS, poses, voxel=1)
    with pytest.raises(TypeError, match=r"TSDF\(\) has no option 'truncaton'; did you mean 'truncation'\?"):
        vdbfuse.TSDF(voxel=0.1, truncaton=1)
    with pytest.raises(TypeError, match=r"Scanner\(\) has no option 'que'; did you mean 'queue'\?"):
        vdbfuse.Scanner(voxel=0.1, que=1)
    with pytest.raises(TypeError, match=r"read\(\) has no option 'dept_scale'; did you mean 'depth_scale'\?"):
        vdbfuse.read("nowhere", dept_scale=1)


@pytest.mark.parametrize("option, value, error, match", [
    ("voxel", -1, ValueError, "voxel: expected a positive number, found -1"),
    ("voxel", "small", TypeError, "voxel: expected a number, found 'small'"),
    ("voxel", float("nan"), ValueError, "voxel: expected a number, found nan"),
    ("voxel", True, TypeError, "voxel: expected a number, found True"),
    ("resolution", 6.5, TypeError, "resolution: expected a whole number, found 6.5"),
    ("resolution", 10**12, ValueError, "resolution: expected a whole number of 32 bits"),
    ("method", "magic", ValueError, "method: expected one of 'visibility', 'tsdf', found 'magic'"),
    ("method", 3, TypeError, "method: expected a str, found 3"),
    ("grids", "yes", TypeError, "grids: expected True or False, found 'yes'"),
    ("bbox", (0, 0, 0, 1, 1), ValueError, "bbox: expected 6 numbers"),
    ("bbox", "abc", TypeError, "bbox: expected a list of numbers"),
    ("bbox", (1, 1, 1, 0, 0, 0), ValueError, "bbox: expected x0, y0, z0, x1, y1, z1 with the lower corner first"),
    ("outliers", 1.0, ValueError, r"outliers: expected a number in \[0"),
    ("noise", "uniform", ValueError, "gaussian"),
    ("sensor", "eye", ValueError, "kinect"),
    ("weights", ["noise", "wind"], ValueError, "weights: expected some of 'confidence'"),
    ("memory", "8 gigabytes", ValueError, "memory: expected bytes or a size like '8GiB'"),
    ("threads", -1, ValueError, "threads: expected a whole number that is not negative"),
    ("judgement", 5, TypeError, "judgement: expected a path, found 5"),
    ("depth_kind", "w", ValueError, "depth_kind: expected one of 'z', 'range', 'disparity', 'inverse'"),
    ("progress", 5, TypeError, "progress: expected a function of"),
])
def test_values_that_options_cannot_have(scan, option, value, error, match):
    depths, poses = scan
    refuse(error, match, depths, INTRINSICS, poses, **{option: value})


def test_options_that_exclude_each_other(scan):
    depths, poses = scan
    refuse(ValueError, "voxel and resolution exclude each other", depths, INTRINSICS, poses, voxel=1, resolution=64)
    refuse(ValueError, "baseline: disparity needs", depths, INTRINSICS, poses, depth_kind="disparity")


def test_memory_that_does_not_suffice_names_a_voxel_that_would_fit(scan):
    depths, poses = sphere(14)
    refuse(ValueError, "voxel: 0.0005 needs about .* GiB of memory, 700.* MiB may be used; .* would fit", depths, INTRINSICS,
           poses, voxel=0.0005, memory="700MiB")


def test_what_the_source_raises_reaches_the_caller_as_itself(scan):
    depths, poses = scan

    class Unplugged(Exception):
        pass

    def frames():
        yield depths[0]
        raise Unplugged("the camera is gone")
    refuse(Unplugged, "the camera is gone", frames(), INTRINSICS, poses)

    def frame(index):
        if index == 2:
            raise Unplugged("no frame 2")
        return depths[index]
    with pytest.raises(Unplugged, match="no frame 2") as caught:
        vdbfuse.fuse(frame, INTRINSICS, poses)
    assert any(entry.name == "frame" for entry in caught.traceback)  # where it happened


def test_files_that_are_none(tmp_path):
    with pytest.raises(OSError, match="nowhere"):
        vdbfuse.read(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    with pytest.raises(OSError, match="empty"):
        vdbfuse.fuse(tmp_path / "empty")
    with pytest.raises(OSError, match="mesh.xyz"):
        vdbfuse.mesh(np.zeros((3, 3)), [[0, 1, 2]]).save(tmp_path / "mesh.xyz")
    (tmp_path / "broken.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
    with pytest.raises(OSError, match="broken.ply"):
        vdbfuse.read_mesh(tmp_path / "broken.ply")


def test_a_data_set_comes_alone(scan):
    depths, poses = scan
    data = vdbfuse.data_set(depths, INTRINSICS, poses)
    refuse(TypeError, "depths: a data set has cameras, poses and images of its own", data, INTRINSICS)
    refuse(TypeError, "depths: a data set has", data, camera_from_world=poses)


def test_meshes_that_are_none():
    with pytest.raises(ValueError, match=r"vertices: expected \(N, 3\), found shape \(3, 2\)"):
        vdbfuse.mesh(np.zeros((3, 2)), [[0, 1, 2]])
    with pytest.raises(TypeError, match="triangles: expected whole numbers, found float64"):
        vdbfuse.mesh(np.zeros((3, 3)), [[0.0, 1, 2]])
    with pytest.raises(ValueError, match="triangles: expected numbers of 3 vertices, found others"):
        vdbfuse.mesh(np.zeros((3, 3)), [[0, 1, 3]])
    with pytest.raises(TypeError, match="mesh: expected a mesh, a path or"):
        vdbfuse.evaluate(5, 5)
    with pytest.raises(ValueError, match="truth"):
        vdbfuse.evaluate(vdbfuse.mesh(np.zeros((3, 3)), [[0, 1, 2]]), vdbfuse.mesh(np.zeros((3, 3)), [[0, 1, 2]]))

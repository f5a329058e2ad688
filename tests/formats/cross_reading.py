#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What other programs write, we read, and what we write, they read.

    /usr/bin/python3 tests/formats/cross_reading.py build [WORK_FOLDER]

Renders a small set, has numpy, Open3D, PIL, OpenImageIO and COLMAP write it and `vdbfuse convert` read it, and
the other way round. Prints the largest difference of depths, poses (entries of the 4x4 matrix) and intrinsics
(pixels), and exits with 1 when one is larger than rounding explains. A program that is not installed is
skipped.
"""
import importlib
import json
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

WIDTH, HEIGHT, VIEWS = 96, 72, 6
MILLIMETRE, FLOAT, HALF = 0.00051, 1e-6, 0.002  # largest error of a depth of up to 4


class Skipped(Exception):
    pass


class Set:
    """depth N x H x W, intrinsics N x 3 x 3 (centres at integers), pose N x 4 x 4 world_from_camera."""

    def __init__(self, depth, intrinsics, pose, color=None):
        self.depth, self.intrinsics, self.pose, self.color = depth, intrinsics, pose, color


def needed(name):
    try:
        return importlib.import_module(name)
    except ImportError:
        raise Skipped(f"{name} is not installed")


# --- the scene: a ball of radius 0.5 above the floor z = -0.5 ---------------------------------------------------


def look_at(eye):
    forward = -eye / np.linalg.norm(eye)
    right = np.cross(forward, [0, 0, 1])
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    pose[:3, 3] = eye
    return pose


def ray_depths(intrinsics, pose):
    x, y = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(intrinsics).T @ pose[:3, :3].T
    eye = pose[:3, 3]
    a, b, c = (rays**2).sum(-1), rays @ eye, eye @ eye - 0.25
    root = b * b - a * c
    ball = np.where(root > 0, (-b - np.sqrt(np.maximum(root, 0))) / a, np.inf)
    floor = (-0.5 - eye[2]) / rays[..., 2]
    depth = np.minimum(ball, np.where(floor > 0, floor, np.inf))
    return np.where(depth < 4, depth, 0).astype(np.float32)


def render(one_camera=True):
    angles = np.linspace(0, 2 * np.pi, VIEWS, endpoint=False)
    pose = np.stack([look_at(np.array([1.6 * np.cos(a), 1.6 * np.sin(a), 0.7 + 0.1 * np.sin(a)])) for a in angles])
    intrinsics = np.tile(np.array([[90.5, 0, 48.25], [0, 91.75, 34.5], [0, 0, 1]]), (VIEWS, 1, 1))
    if not one_camera:
        intrinsics[:, 0, 0] += np.arange(VIEWS)
    depth = np.stack([ray_depths(k, p) for k, p in zip(intrinsics, pose)])
    depth[:, 3, 5] = 0
    color = np.random.default_rng(1).integers(0, 255, (VIEWS, HEIGHT, WIDTH, 3), dtype=np.uint8)
    return Set(depth, intrinsics, pose, color)


def distance_to_scene(points):
    return np.minimum(abs(np.linalg.norm(points, axis=1) - 0.5), abs(points[:, 2] + 0.5))


# --- our tool ---------------------------------------------------------------------------------------------------


class Bench:
    def __init__(self, build, work):
        self.tool, self.work, self.rows, self.count = pathlib.Path(build) / "bin/vdbfuse", work, [], 0

    def folder(self):
        self.count += 1
        path = self.work / str(self.count)
        path.mkdir()
        return path

    def convert(self, source, to, *options):
        out = self.folder() / "out"
        command = [self.tool, "convert", source, out, "--to", to, *options]
        done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip().splitlines()[-1] if done.stderr else "failed")
        return out

    def read(self, source, *options):
        arrays = np.load(self.convert(source, "numpy", *options) / "depth_set.npz")
        return Set(arrays["depth"], arrays["intrinsics"], arrays["world_from_camera"])

    def write(self, truth, to):
        source = self.folder() / "truth.npz"
        write_numpy(source, truth)
        return self.convert(source, to)

    def report(self, name, direction, program, action):
        """`action` returns (found, truth, tolerance of depth), or a text of its own."""
        try:
            result = action()
            if isinstance(result, str):
                self.rows.append((name, direction, program, result, "", "", "ok"))
                return
            self.rows.append((name, direction, program, *compare(*result)))
        except Skipped as reason:
            self.rows.append((name, direction, program, "", "", "", f"skipped: {reason}"))
        except Exception as error:  # whatever goes wrong is a failure of this row
            self.rows.append((name, direction, program, "", "", "", f"FAILED: {error}"))


def compare(found, truth, tolerance):
    if found.depth.shape != truth.depth.shape:
        return "", "", "", f"FAILED: shape {found.depth.shape}"
    depth = float(abs(found.depth - truth.depth).max())
    same = bool(((found.depth > 0) == (truth.depth > 0)).all())
    pose = float(abs(found.pose - truth.pose).max())
    pixels = float(abs(found.intrinsics - truth.intrinsics).max())
    good = depth <= tolerance and same and pose < 1e-6 and pixels < 1e-4
    return f"{depth:.1e}", f"{pose:.1e}", f"{pixels:.1e}", "ok" if good else "FAILED"


# --- numpy ------------------------------------------------------------------------------------------------------


def write_numpy(path, s, save=np.savez):
    save(path, depth=s.depth, intrinsics=s.intrinsics, world_from_camera=s.pose, color=s.color)


def numpy_reads(bench, truth):
    arrays = np.load(bench.write(truth, "numpy") / "depth_set.npz")
    assert (arrays["color"] == truth.color).all(), "colours"
    return Set(arrays["depth"], arrays["intrinsics"], arrays["world_from_camera"]), truth, FLOAT


def numpy_writes(bench, truth):
    path = bench.folder() / "set.npz"
    write_numpy(path, truth)
    return bench.read(path), truth, FLOAT


def numpy_writes_vggt(bench, truth):
    path = bench.folder() / "predictions.npz"
    camera_from_world = np.linalg.inv(truth.pose)[:, :3].astype(np.float32)
    np.savez_compressed(path, depth=truth.depth[..., None], extrinsic=camera_from_world,
                        intrinsic=truth.intrinsics.astype(np.float32),
                        images=(truth.color / 255).transpose(0, 3, 1, 2).astype(np.float32))
    return bench.read(path), truth, FLOAT


def numpy_writes_cut3r(bench, truth):
    path = bench.folder()
    for name in ("depth", "conf", "camera"):
        (path / name).mkdir()
    for i in range(VIEWS):
        np.save(path / f"depth/{i:06d}.npy", truth.depth[i])
        np.save(path / f"conf/{i:06d}.npy", np.ones_like(truth.depth[i]))
        np.savez(path / f"camera/{i:06d}.npz", pose=truth.pose[i], intrinsics=truth.intrinsics[i])
    return bench.read(path), truth, FLOAT


def numpy_writes_frames(bench, truth):
    path = bench.folder()
    for i in range(VIEWS):
        np.savez_compressed(path / f"{i:03d}.npz", depth=np.round(1000 * truth.depth[i]).astype(np.uint16),
                            K=truth.intrinsics[i], cam2world=truth.pose[i])
    return bench.read(path), truth, MILLIMETRE


def numpy_writes_files(bench, truth):
    path = bench.folder()
    np.save(path / "depths.npy", np.asfortranarray(truth.depth.astype(">f8")))
    np.save(path / "K.npy", truth.intrinsics[0].T.copy().T)
    np.save(path / "w2c.npy", np.linalg.inv(truth.pose))
    return bench.read(path), truth, FLOAT


# --- PIL and OpenImageIO: transforms.json -----------------------------------------------------------------------


def gl(pose):
    return pose @ np.diag([1, -1, -1, 1])


def write_transforms(path, truth, extension, **more):
    k = truth.intrinsics[0]
    frames = [{"file_path": f"images/{i}.png", "depth_file_path": f"depth/{i}.{extension}",
               "transform_matrix": gl(truth.pose[i]).tolist()} for i in range(VIEWS)]
    root = {"fl_x": k[0, 0], "fl_y": k[1, 1], "cx": k[0, 2] + 0.5, "cy": k[1, 2] + 0.5, "w": WIDTH, "h": HEIGHT,
            "frames": frames, **more}
    (path / "transforms.json").write_text(json.dumps(root))
    (path / "depth").mkdir()
    (path / "images").mkdir()


def pil_writes(bench, truth):
    image, path = needed("PIL.Image"), bench.folder()
    write_transforms(path, truth, "png", integer_depth_scale=0.0005)
    for i in range(VIEWS):
        steps = np.round(truth.depth[i] / 0.0005).astype(np.uint16)
        image.fromarray(steps).save(path / f"depth/{i}.png")
        image.fromarray(truth.color[i]).save(path / f"images/{i}.png")
    return bench.read(path), truth, MILLIMETRE


def pil_reads(bench, truth):
    image, path = needed("PIL.Image"), bench.write(truth, "transforms")
    root = json.loads((path / "transforms.json").read_text())
    k = np.array([[root["fl_x"], 0, root["cx"] - 0.5], [0, root["fl_y"], root["cy"] - 0.5], [0, 0, 1]])
    frames = root["frames"]
    depth = np.stack([np.asarray(image.open(path / f["depth_file_path"])) for f in frames])
    color = np.stack([np.asarray(image.open(path / f["file_path"])) for f in frames])
    assert (color == truth.color).all(), "colours"
    pose = np.stack([gl(np.array(f["transform_matrix"])) for f in frames])
    return Set(depth * root["integer_depth_scale"], np.tile(k, (VIEWS, 1, 1)), pose), truth, MILLIMETRE


def openimageio_writes(bench, truth, half):
    oiio, path = needed("OpenImageIO"), bench.folder()
    write_transforms(path, truth, "exr")
    for i in range(VIEWS):
        spec = oiio.ImageSpec(WIDTH, HEIGHT, 1, "half" if half else "float")
        spec.channelnames = ("Z",)
        spec["compression"] = "zip"
        out = oiio.ImageOutput.create(str(path / f"depth/{i}.exr"))
        out.open(str(path / f"depth/{i}.exr"), spec)
        out.write_image(np.ascontiguousarray(truth.depth[i][..., None]))
        out.close()
    return bench.read(path), truth, HALF if half else FLOAT


# --- PIL and numpy: frames of depth cameras ---------------------------------------------------------------------


def steps_of(depth, step):
    return np.round(depth / step).astype(np.uint16)


def save_pngs(image, folder, depths, names, step):
    folder.mkdir(exist_ok=True)
    for name, depth in zip(names, depths):
        image.fromarray(steps_of(depth, step)).save(folder / name)


def pil_writes_rgbd(bench, truth):
    image, path = needed("PIL.Image"), bench.folder()
    save_pngs(image, path, truth.depth, [f"frame-{i:06d}.depth.png" for i in range(VIEWS)], 0.001)
    np.savetxt(path / "camera-intrinsics.txt", truth.intrinsics[0])
    for i in range(VIEWS):
        np.savetxt(path / f"frame-{i:06d}.pose.txt", truth.pose[i])
    return bench.read(path), truth, MILLIMETRE


def pil_reads_rgbd(bench, truth):
    image, path = needed("PIL.Image"), bench.write(truth, "rgbd")
    depth = np.stack([np.asarray(image.open(f)) for f in sorted(path.glob("*.depth.png"))])
    pose = np.stack([np.loadtxt(f) for f in sorted(path.glob("*.pose.txt"))])
    k = np.loadtxt(path / "intrinsics.txt")
    return Set(depth / 1000, np.tile(k, (VIEWS, 1, 1)), pose), truth, MILLIMETRE


def quaternion(rotation):  # x y z w
    w = np.sqrt(max(0, 1 + np.trace(rotation))) / 2
    if w < 0.1:
        values, vectors = np.linalg.eigh(quaternion_matrix(rotation))
        return vectors[:, -1]
    r = rotation
    return np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], 4 * w * w]) / (4 * w)


def quaternion_matrix(r):  # whose largest eigenvector is the quaternion (Bar-Itzhack 2000)
    k = np.zeros((4, 4))
    k[:3, :3] = r + r.T - np.trace(r) * np.eye(3)
    k[:3, 3] = k[3, :3] = [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]
    k[3, 3] = np.trace(r)
    return k


def pil_writes_tum(bench, truth):
    image, path = needed("PIL.Image"), bench.folder()
    times = [round(1305031100.25 + i / 30, 6) for i in range(VIEWS)]
    save_pngs(image, path / "depth", truth.depth, [f"{t:.6f}.png" for t in times], 0.0002)
    (path / "depth.txt").write_text("".join(f"{t:.6f} depth/{t:.6f}.png\n" for t in times))
    rows = [[t, *p[:3, 3], *quaternion(p[:3, :3])] for t, p in zip(times, truth.pose)]
    np.savetxt(path / "groundtruth.txt", rows, fmt="%.9f", header="time tx ty tz qx qy qz qw")
    k = truth.intrinsics[0]
    camera = f"{k[0, 0]},{k[1, 1]},{k[0, 2]},{k[1, 2]}"
    return bench.read(path, "--intrinsics", camera), truth, MILLIMETRE


def pil_writes_scannet(bench, truth):
    image, path = needed("PIL.Image"), bench.folder()
    save_pngs(image, path / "depth", truth.depth, [f"{i}.png" for i in range(VIEWS)], 0.001)
    for name in ("pose", "intrinsic"):
        (path / name).mkdir()
    k = np.eye(4)
    k[:3, :3] = truth.intrinsics[0]
    np.savetxt(path / "intrinsic/intrinsic_depth.txt", k)
    for i in range(VIEWS):
        np.savetxt(path / f"pose/{i}.txt", truth.pose[i])
    return bench.read(path), truth, MILLIMETRE


def pil_writes_polycam(bench, truth):
    image, path = needed("PIL.Image"), bench.folder() / "keyframes"
    path.mkdir()
    save_pngs(image, path / "depth", truth.depth, [f"{i}.png" for i in range(VIEWS)], 0.001)
    (path / "cameras").mkdir()
    for i, (k, pose) in enumerate(zip(truth.intrinsics, truth.pose)):
        camera = {f"t_{r}{c}": gl(pose)[r, c] for r in range(3) for c in range(4)}
        camera.update(fx=k[0, 0], fy=k[1, 1], cx=k[0, 2], cy=k[1, 2], width=WIDTH, height=HEIGHT)
        (path / f"cameras/{i}.json").write_text(json.dumps(camera))
    return bench.read(path.parent), truth, MILLIMETRE


def numpy_writes_sens(bench, truth):
    path = bench.folder() / "a.sens"
    k = np.eye(4, dtype="<f4")
    k[:3, :3] = truth.intrinsics[0]
    out = struct.pack("<IQ", 4, 4) + b"test" + k.tobytes() + np.eye(4, dtype="<f4").tobytes()
    out += k.tobytes() + np.eye(4, dtype="<f4").tobytes()
    out += struct.pack("<iiIIIIfQ", 0, 1, WIDTH, HEIGHT, WIDTH, HEIGHT, 1000.0, VIEWS)
    for pose, depth, color in zip(truth.pose, truth.depth, truth.color):
        packed = zlib.compress(steps_of(depth, 0.001).tobytes())
        out += pose.astype("<f4").tobytes() + struct.pack("<QQQQ", 0, 0, color.nbytes, len(packed))
        out += color.tobytes() + packed
    path.write_bytes(out + struct.pack("<Q", 0))
    return bench.read(path), truth, MILLIMETRE


def numpy_writes_mvsnet(bench, truth):
    path = bench.folder()
    for name in ("cams", "depth_est"):
        (path / name).mkdir()
    for i, (k, pose) in enumerate(zip(truth.intrinsics, truth.pose)):
        rows = [" ".join(repr(float(v)) for v in row) for row in np.linalg.inv(pose)]
        rows = ["extrinsic", *rows, "", "intrinsic", *[" ".join(repr(float(v)) for v in row) for row in k]]
        (path / f"cams/{i:08d}_cam.txt").write_text("\n".join([*rows, "", "0.5 0.01"]) + "\n")
        header = f"Pf\n{WIDTH} {HEIGHT}\n-1.0\n".encode()
        (path / f"depth_est/{i:08d}.pfm").write_bytes(header + truth.depth[i][::-1].astype("<f4").tobytes())
    return bench.read(path), truth, FLOAT


# --- points: scanners' axes are x forward, y left, z up ---------------------------------------------------------


def scanner_points(truth, view):
    """Points of one view in the axes of a scanner there, and world_from_scanner."""
    y, x = np.nonzero(truth.depth[view])
    rays = np.stack([x, y, np.ones_like(x)], axis=1) @ np.linalg.inv(truth.intrinsics[view]).T
    points = rays * truth.depth[view][y, x][:, None]
    camera_from_scanner = np.array([[0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0], [0, 0, 0, 1.0]])
    return points @ camera_from_scanner[:3, :3], truth.pose[view] @ camera_from_scanner


def median_off(bench, source):
    """Median distance of what we read to the scene, in the largest angle between pixels times the distance."""
    out = bench.convert(source, "ptx")
    off = []
    for file in sorted(out.glob("*.ptx")):
        lines = file.read_text().splitlines()
        matrix = np.array([[float(v) for v in line.split()] for line in lines[6:10]])
        points = np.array([[float(v) for v in line.split()[:3]] for line in lines[10:]])
        points = points[(points != 0).any(axis=1)]
        off.append(distance_to_scene(points @ matrix[:3, :3] + matrix[3, :3]))
    off = np.concatenate(off)
    assert len(off) > 1000 and np.median(off) < 0.01, f"{len(off)} points, median {np.median(off):.1e} off"
    return f"{np.median(off):.1e}"


def open3d_writes_points(bench, truth, kind):
    o3d, path = needed("open3d"), bench.folder()
    for i in range(VIEWS):
        points, pose = scanner_points(truth, i)
        points = np.random.default_rng(i).permutation(points)
        cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points))
        o3d.io.write_point_cloud(str(path / f"{i}.{kind}"), cloud)
        np.savetxt(path / f"{i}.pose.txt", pose)
    return median_off(bench, path)


def numpy_writes_kitti(bench, truth):
    path = bench.folder()
    (path / "velodyne").mkdir()
    poses = []
    for i in range(VIEWS):
        points, pose = scanner_points(truth, i)
        np.hstack([points, np.ones((len(points), 1))]).astype("<f4").tofile(path / f"velodyne/{i:06d}.bin")
        poses.append(pose[:3].ravel())
    np.savetxt(path / "poses.txt", poses)
    return median_off(bench, path)


# --- Open3D -----------------------------------------------------------------------------------------------------


def open3d_trajectory(o3d, s):
    trajectory, parameters = o3d.camera.PinholeCameraTrajectory(), []
    for k, pose in zip(s.intrinsics, s.pose):
        p = o3d.camera.PinholeCameraParameters()
        p.intrinsic = o3d.camera.PinholeCameraIntrinsic(WIDTH, HEIGHT, k[0, 0], k[1, 1], k[0, 2], k[1, 2])
        p.extrinsic = np.linalg.inv(pose)
        parameters.append(p)
    trajectory.parameters = parameters
    return trajectory


def open3d_writes(bench, truth, kind):
    o3d, path = needed("open3d"), bench.folder()
    trajectory = open3d_trajectory(o3d, truth)
    o3d.io.write_pinhole_camera_trajectory(str(path / f"trajectory.{kind}"), trajectory)
    if kind == "log":
        o3d.io.write_pinhole_camera_intrinsic(str(path / "intrinsic.json"), trajectory.parameters[0].intrinsic)
    (path / "depth").mkdir()
    for i in range(VIEWS):
        steps = np.round(1000 * truth.depth[i]).astype(np.uint16)
        o3d.io.write_image(str(path / f"depth/{i:05d}.png"), o3d.geometry.Image(steps))
    return bench.read(path), truth, MILLIMETRE


def open3d_reads(bench, truth, kind):
    o3d, path = needed("open3d"), bench.write(truth, "open3d")
    parameters = o3d.io.read_pinhole_camera_trajectory(str(path / f"trajectory.{kind}")).parameters
    pose = np.stack([np.linalg.inv(p.extrinsic) for p in parameters])
    cameras = [p.intrinsic for p in parameters]
    if kind == "log":
        cameras = [o3d.io.read_pinhole_camera_intrinsic(str(path / "camera_intrinsic.json"))] * VIEWS
    depth = [np.asarray(o3d.io.read_image(str(f))) for f in sorted((path / "depth").iterdir())]
    intrinsics = np.stack([c.intrinsic_matrix for c in cameras])
    return Set(np.stack(depth) / 1000, intrinsics, pose), truth, MILLIMETRE


# --- COLMAP -----------------------------------------------------------------------------------------------------


def colmap(*arguments):
    program = shutil.which("colmap")
    if program is None:
        raise Skipped("colmap is not installed")
    done = subprocess.run([program, *[str(a) for a in arguments]], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError("colmap " + arguments[0])


def colmap_converts(bench, truth, kinds):
    path = bench.write(truth, "colmap")
    for kind in kinds:
        converted = bench.folder()
        colmap("model_converter", "--input_path", path / "sparse", "--output_path", converted, "--output_type", kind)
        shutil.rmtree(path / "sparse")
        shutil.copytree(converted, path / "sparse")
    return bench.read(path), truth, FLOAT


def numpy_reads_colmap(bench, truth):
    path = bench.write(truth, "colmap")
    depth = []
    for file in sorted((path / "stereo/depth_maps").iterdir()):
        width, height, channels, data = file.read_bytes().split(b"&", 3)
        depth.append(np.frombuffer(data, "<f4").reshape(int(height), int(width)))
    return Set(np.stack(depth), truth.intrinsics, truth.pose), truth, 0


def shift_cameras(path, pixels):
    lines = (path / "sparse/cameras.txt").read_text().splitlines()
    words = [line.split() for line in lines if not line.startswith("#")]
    text = [" ".join(w[:-2] + [str(float(c) + pixels) for c in w[-2:]]) for w in words]
    (path / "sparse/cameras.txt").write_text("\n".join(text) + "\n")


def colmap_fuses(bench, truth):
    path, out = bench.write(truth, "colmap"), bench.folder() / "fused.ply"
    # stereo_fusion takes pixels to be at integers while cameras have them at .5: COLMAP's issues 534 and 1515.
    shift_cameras(path, -0.5)
    colmap("stereo_fusion", "--workspace_path", path, "--input_type", "geometric", "--output_path", out,
           "--StereoFusion.min_num_pixels", "2")
    header, data = out.read_bytes().split(b"end_header\n", 1)
    count = int(header.split(b"element vertex ")[1].split()[0])
    kinds = [("xyz", "<f4", 3), ("normal", "<f4", 3), ("color", "u1", 3)]
    points = np.frombuffer(data, kinds, count)["xyz"].astype(float)
    off = float(np.median(distance_to_scene(points)))
    assert count > 1000 and off < 1e-5, f"{count} points, {off:.1e} off"
    return f"{off:.1e}"


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    work = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else tempfile.mkdtemp(prefix="cross-reading-"))
    work.mkdir(parents=True, exist_ok=True)
    bench, one, many = Bench(sys.argv[1], work), render(), render(one_camera=False)
    parts = [
        ("numpy", "they write", "numpy savez", lambda: numpy_writes(bench, many)),
        ("numpy", "they write", "numpy, names of VGGT", lambda: numpy_writes_vggt(bench, many)),
        ("numpy", "they write", "numpy, folders of CUT3R", lambda: numpy_writes_cut3r(bench, many)),
        ("numpy", "they write", "numpy, file a frame", lambda: numpy_writes_frames(bench, many)),
        ("numpy", "they write", "numpy, .npy files", lambda: numpy_writes_files(bench, one)),
        ("numpy", "they read", "numpy load", lambda: numpy_reads(bench, many)),
        ("transforms", "they write", "PIL, 16-bit PNG", lambda: pil_writes(bench, one)),
        ("transforms", "they write", "OpenImageIO, float EXR", lambda: openimageio_writes(bench, one, False)),
        ("transforms", "they write", "OpenImageIO, half EXR", lambda: openimageio_writes(bench, one, True)),
        ("transforms", "they read", "PIL, json", lambda: pil_reads(bench, one)),
        ("open3d", "they write", "Open3D, .log", lambda: open3d_writes(bench, one, "log")),
        ("open3d", "they write", "Open3D, .json", lambda: open3d_writes(bench, many, "json")),
        ("open3d", "they read", "Open3D, .log", lambda: open3d_reads(bench, one, "log")),
        ("open3d", "they read", "Open3D, .json", lambda: open3d_reads(bench, many, "json")),
        ("colmap", "they write", "model_converter, BIN", lambda: colmap_converts(bench, many, ["BIN"])),
        ("colmap", "they write", "model_converter, TXT", lambda: colmap_converts(bench, many, ["BIN", "TXT"])),
        ("colmap", "they read", "numpy", lambda: numpy_reads_colmap(bench, many)),
        ("colmap", "they read", "stereo_fusion", lambda: colmap_fuses(bench, one)),
        ("rgbd", "they write", "PIL, numpy", lambda: pil_writes_rgbd(bench, one)),
        ("rgbd", "they read", "PIL, numpy", lambda: pil_reads_rgbd(bench, one)),
        ("tum", "they write", "PIL, numpy", lambda: pil_writes_tum(bench, one)),
        ("scannet", "they write", "PIL, numpy", lambda: pil_writes_scannet(bench, one)),
        ("arkit", "they write", "PIL, json", lambda: pil_writes_polycam(bench, many)),
        ("sens", "they write", "numpy, zlib", lambda: numpy_writes_sens(bench, one)),
        ("mvsnet", "they write", "numpy", lambda: numpy_writes_mvsnet(bench, many)),
        ("points", "they write", "Open3D, PCD", lambda: open3d_writes_points(bench, one, "pcd")),
        ("points", "they write", "Open3D, PLY", lambda: open3d_writes_points(bench, one, "ply")),
        ("kitti", "they write", "numpy", lambda: numpy_writes_kitti(bench, one)),
    ]
    for part in parts:
        bench.report(*part)
    print(f"{'format':11} {'direction':11} {'other program':25} {'depth':>9} {'pose':>9} {'pixels':>9}  result")
    for name, direction, program, depth, pose, pixels, result in bench.rows:
        print(f"{name:11} {direction:11} {program:25} {depth:>9} {pose:>9} {pixels:>9}  {result}")
    print("pcd: the Point Cloud Library writes what Pcd.* and Bridge.* of the unit tests read")
    print("stanford: ../shared/data/bunny-scans against bun_zipper.ply, RealData.*")
    print("no other program is at hand for: ptx, e57")
    if len(sys.argv) < 3:
        shutil.rmtree(work)
    sys.exit(any("FAILED" in row[-1] for row in bench.rows))


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How far the depth maps of a folder in MVSNet layout (cams, depth_est, confidence) agree with each other.

  tests/benchmark/stereo_agreement.py FOLDER... [--tolerance 0.00125] [--min-confidence C] [--views]
  tests/benchmark/stereo_agreement.py --check

A pixel agrees with another view if its point, projected there and looked up at the nearest pixel, has
|z - depth of that view| < tolerance (unit of the poses). It is compared with the 6 views whose optical axes are nearest
to its own, within 60 degrees. Prints the pixels with depth per view, the shares of them that agree with at least one
and at least two others, and the median |z - depth| over all agreeing pairs, in thousandths of the unit (mm where poses
are in metres). A proxy of the truth: depth maps that one view made from another's agree without being right. Needs
python3-numpy.
"""
import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np


def read_pfm(path):
    """Rows from the top."""
    with open(path, "rb") as file:
        if file.readline().strip() != b"Pf":
            sys.exit(f"{path}: not a PFM image of one channel")
        width, height = map(int, file.readline().split())
        kind = "<f4" if float(file.readline()) < 0 else ">f4"
        return np.frombuffer(file.read(), kind, width * height).reshape(height, width)[::-1].astype(np.float64)


def write_pfm(path, image):
    with open(path, "wb") as file:
        file.write(b"Pf\n%d %d\n-1\n" % (image.shape[1], image.shape[0]))
        file.write(image[::-1].astype("<f4").tobytes())


def read_camera(path):
    """4x4 camera_from_world and 3x3 intrinsics."""
    words = path.read_text().split()
    at = words.index("extrinsic") + 1
    pose = np.array(words[at:at + 16], float).reshape(4, 4)
    at = words.index("intrinsic") + 1
    return pose, np.array(words[at:at + 9], float).reshape(3, 3)


class View:
    def __init__(self, folder, camera_path, min_confidence):
        self.name = camera_path.name.removesuffix("_cam.txt")
        self.pose, self.intrinsics = read_camera(camera_path)
        self.depth = read_pfm(folder / "depth_est" / (self.name + ".pfm"))
        self.depth[~np.isfinite(self.depth) | (self.depth < 0)] = 0
        if min_confidence > 0:
            confidence = read_pfm(folder / "confidence" / (self.name + ".pfm"))
            self.depth[~(confidence >= min_confidence)] = 0

    def points(self):
        """World points of all pixels with depth, 3xN."""
        y, x = np.nonzero(self.depth)
        rays = np.linalg.solve(self.intrinsics, np.stack([x, y, np.ones_like(x)]).astype(float))
        rotation, shift = self.pose[:3, :3], self.pose[:3, 3:]
        return rotation.T @ (rays * self.depth[y, x] - shift)

    def differences(self, points):
        """|z - depth| here of world points; infinite where nothing was measured."""
        height, width = self.depth.shape
        x, y, z = self.intrinsics @ (self.pose[:3, :3] @ points + self.pose[:3, 3:])
        with np.errstate(divide="ignore", invalid="ignore"):
            u, v = np.floor(x / z + 0.5), np.floor(y / z + 0.5)
        seen = (z > 0) & (u >= 0) & (v >= 0) & (u < width) & (v < height)
        result = np.full(z.shape, np.inf)
        depth = self.depth[v[seen].astype(int), u[seen].astype(int)]
        result[seen] = np.where(depth > 0, np.abs(z[seen] - depth), np.inf)
        return result


def read_views(folder, min_confidence):
    cameras = sorted((folder / "cams").glob("*_cam.txt"))
    views = [View(folder, camera, min_confidence) for camera in cameras
             if (folder / "depth_est" / (camera.name.removesuffix("_cam.txt") + ".pfm")).exists()]
    if len(views) < 2:
        sys.exit(f"{folder}: fewer than two depth maps (cams/NAME_cam.txt, depth_est/NAME.pfm)")
    return views


def neighbours(views, index, count, max_angle_deg):
    axes = np.array([view.pose[2, :3] for view in views])
    angles = np.degrees(np.arccos(np.clip(axes @ axes[index], -1, 1)))
    order = np.argsort(angles, kind="stable")
    return [j for j in order if j != index and angles[j] <= max_angle_deg][:count]


def agreement_of(views, index, tolerance, count=6, max_angle_deg=60):
    """Number of other views that each pixel with depth agrees with, and all |z - depth| of agreeing pairs."""
    points = views[index].points()
    agreeing, differences = np.zeros(points.shape[1], int), [np.empty(0)]
    for other in neighbours(views, index, count, max_angle_deg):
        difference = views[other].differences(points)
        agrees = difference < tolerance
        agreeing += agrees
        differences.append(difference[agrees])
    return agreeing, np.concatenate(differences)


def row(name, agreeing, differences, views=1):
    """Line of the table; agreeing and differences of one view or of several together."""
    shares = [100 * float(np.mean(agreeing >= k)) if agreeing.size else 0.0 for k in (1, 2)]
    median = f"{1000 * np.median(differences):.3f}" if differences.size else "-"
    return f"| {name} | {agreeing.size / views:.0f} | {shares[0]:.1f} % | {shares[1]:.1f} % | {median} |"


def table(folder, tolerance, min_confidence, each_view=False):
    views = read_views(folder, min_confidence)
    found = [agreement_of(views, i, tolerance) for i in range(len(views))]
    lines = [row(f"{folder.name} {view.name}", *one) for view, one in zip(views, found)] if each_view else []
    together = [np.concatenate(parts) for parts in zip(*found)]
    return lines + [row(f"{folder.name}, {len(views)} views", *together, views=len(views))]


def check():
    """A wall at z = 2 seen by cameras side by side; the third is 1 off, the fourth's left half 0.001."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in ("cams", "depth_est", "confidence"):
            (folder / part).mkdir()
        depths = [np.full((20, 40), 2.0) for _ in range(5)]
        depths[2] += 1
        depths[3][:, :20] += 0.001
        depths[4][:] = np.nan
        for i, depth in enumerate(depths):
            pose = np.eye(4)
            pose[0, 3] = -0.4 * i  # 4 pixels at the wall
            if i == 4:
                pose[:3, :3] = [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]  # beyond 60 degrees, and without depth
            numbers = "\n".join(" ".join(map(str, line)) for line in pose)
            (folder / "cams" / f"{i:08}_cam.txt").write_text(
                f"extrinsic\n{numbers}\n\nintrinsic\n20 0 19.5\n0 20 9.5\n0 0 1\n\n1 0.01 192 3\n")
            write_pfm(folder / "depth_est" / f"{i:08}.pfm", depth)
            write_pfm(folder / "confidence" / f"{i:08}.pfm", np.full(depth.shape, 0.3 if i == 1 else 0.9))
        views = read_views(folder, 0)
        counts = [agreement_of(views, i, 0.00125)[0].reshape(20, -1) for i in range(4)]
        # Of view 0, view 1 sees columns 4 to 39, view 3 columns 12 to 39.
        assert (counts[0][:, :4] == 0).all() and (counts[0][:, 4:12] == 1).all() and (counts[0][:, 12:] == 2).all()
        assert (counts[2] == 0).all() and (counts[3][:, 36:] == 0).all()
        assert neighbours(views, 0, 6, 60) == [1, 2, 3] and neighbours(views, 0, 2, 60) == [1, 2]
        # View 0 with 3: 28 columns, of which those seen in its left half, 12 to 31, are 0.001 off.
        strict = agreement_of(views, 0, 0.0009)[0].reshape(20, -1)
        assert (strict[:, 12:32] == 1).all() and (strict[:, 32:] == 2).all()
        sure = read_views(folder, 0.5)
        assert agreement_of(sure, 1, 1)[0].size == 0 and (agreement_of(sure, 0, 0.00125)[0] <= 1).all()
        assert table(folder, 0.00125, 0)[-1].split("|")[2].strip() == "640"  # 4 of 5 views are full
        assert row("none", np.empty(0), np.empty(0)) == "| none | 0 | 0.0 % | 0.0 % | - |"
    print("as expected")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path)
    parser.add_argument("--tolerance", type=float, default=0.00125)
    parser.add_argument("--min-confidence", type=float, default=0)
    parser.add_argument("--views", action="store_true", help="a line for each view, too")
    parser.add_argument("--check", action="store_true", help="try the script itself on a made-up wall")
    options = parser.parse_args()
    if options.check:
        return check()
    if not options.folders:
        parser.error("which folder?")
    print("| depth maps | pixels a view | agree with >= 1 | >= 2 | median difference / 1000 |\n|---|---|---|---|---|")
    for folder in options.folders:
        print("\n".join(table(folder, options.tolerance, options.min_confidence, options.views)))


if __name__ == "__main__":
    main()

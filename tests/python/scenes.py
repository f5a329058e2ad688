# SPDX-License-Identifier: Apache-2.0
"""A sphere of half a metre around the origin as a depth camera sees it, in numpy alone."""
import numpy as np

RADIUS = 0.5
WIDTH, HEIGHT = 96, 72
INTRINSICS = (90.0, 90.0, (WIDTH - 1) / 2, (HEIGHT - 1) / 2)
FLIP = np.diag([1.0, -1.0, -1.0, 1.0])  # OpenGL's axes from OpenCV's, and back


def look_at_origin(eye):
    """world_from_camera, x right, y down, z forward."""
    forward = -np.asarray(eye) / np.linalg.norm(eye)
    right = np.cross([0.0, 0.0, -1.0], forward)
    right /= np.linalg.norm(right)
    pose = np.eye(4)
    pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
    pose[:3, 3] = eye
    return pose


def sphere_depth(pose, intrinsics=INTRINSICS, width=WIDTH, height=HEIGHT):
    """(H, W) float32: z, 0 beside the sphere."""
    fx, fy, cx, cy = intrinsics
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    rays = np.stack([(x - cx) / fx, (y - cy) / fy, np.ones_like(x, np.float64)], axis=-1)
    center = np.linalg.inv(pose)[:3, 3]
    a, b, c = (rays ** 2).sum(-1), rays @ center, center @ center - RADIUS ** 2
    inside = b * b - a * c
    return np.where(inside > 0, (b - np.sqrt(np.maximum(inside, 0))) / a, 0).astype(np.float32)


def poses_around(count):
    """(count, 4, 4), on two rings, one above and one below."""
    angles = 2 * np.pi * np.arange(count) / count
    heights = np.where(np.arange(count) % 2 == 0, 0.9, -0.9)
    return np.stack([look_at_origin([1.2 * np.cos(a), 1.2 * np.sin(a), h]) for a, h in zip(angles, heights)])


def sphere(count=14):
    """(count, H, W) depths and (count, 4, 4) poses."""
    poses = poses_around(count)
    return np.stack([sphere_depth(pose) for pose in poses]), poses


def radius_error(mesh):
    """Largest distance of a vertex from the sphere."""
    return np.abs(np.linalg.norm(mesh.vertices, axis=1) - RADIUS).max()

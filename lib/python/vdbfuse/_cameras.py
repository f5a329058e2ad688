# SPDX-License-Identifier: Apache-2.0
"""Intrinsics and poses in the many shapes that they come in."""
import numpy as np

_AXES = {"opencv": False, "opengl": True}
_DISTORTION = 5


def _numbers(where, value):
    if hasattr(value, "intrinsic_matrix"):  # a camera of Open3D
        value = value.intrinsic_matrix
    try:
        numbers = np.asarray(value, np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{where}: expected numbers, found {type(value).__name__}") from error
    if not np.isfinite(numbers).all():
        raise ValueError(f"{where}: expected finite numbers, found NaN or infinity")
    return numbers


def _of_matrix(matrix):
    if matrix[..., 0, 1].any():
        raise ValueError("intrinsics: expected a camera without skew, K[0, 1] = 0")
    return np.stack([matrix[..., 0, 0], matrix[..., 1, 1], matrix[..., 0, 2], matrix[..., 1, 2]], axis=-1)


def _for_each(where, numbers, count, single_dimensions):
    """(count, …) of one for all or one each."""
    if numbers.ndim == single_dimensions:
        numbers = numbers[np.newaxis]
    if len(numbers) == 1:
        return np.repeat(numbers, count, axis=0)
    if len(numbers) != count:
        raise ValueError(f"{where}: expected one for all or one for each of {count} views, found {len(numbers)}")
    return numbers


def cameras(intrinsics, distortion, count):
    """(count, 9) float64: fx, fy, cx, cy, k1, k2, p1, p2, k3."""
    if intrinsics is None:
        raise TypeError("intrinsics: expected fx, fy, cx, cy or a 3x3 matrix, found None")
    numbers = _numbers("intrinsics", intrinsics)
    if numbers.ndim >= 2 and numbers.shape[-2:] == (3, 3):
        numbers = _of_matrix(numbers)
    if numbers.ndim not in (1, 2) or numbers.shape[-1] != 4:
        raise ValueError(f"intrinsics: expected (4,), (N, 4), (3, 3) or (N, 3, 3), found shape {numbers.shape}")
    pinholes = _for_each("intrinsics", numbers, count, 1)
    lens = np.zeros((count, _DISTORTION))
    if distortion is not None:
        given = _numbers("distortion", distortion)
        if given.ndim not in (1, 2) or not 1 <= given.shape[-1] <= _DISTORTION:
            raise ValueError(f"distortion: expected up to five of k1, k2, p1, p2, k3, found shape {given.shape}")
        lens[:, :given.shape[-1]] = _for_each("distortion", given, count, 1)
    return np.concatenate([pinholes, lens], axis=1)


def _matrices(where, value):
    if hasattr(value, "__iter__") and not hasattr(value, "shape"):
        value = list(value)
        if len({np.shape(pose) for pose in value}) > 1:
            raise ValueError(f"{where}: expected matrices of one shape, found several")
    matrices = _numbers(where, value)
    if matrices.ndim == 2:
        matrices = matrices[np.newaxis]
    if matrices.ndim != 3 or matrices.shape[1:] not in ((4, 4), (3, 4)):
        raise ValueError(f"{where}: expected (N, 4, 4) or (N, 3, 4), found shape {matrices.shape}")
    last = np.broadcast_to(np.array([[0.0, 0.0, 0.0, 1.0]]), (len(matrices), 1, 4))
    if matrices.shape[1] == 3:
        return np.concatenate([matrices, last], axis=1)
    wrong = np.abs(matrices[:, 3:] - last).max(axis=(1, 2)) > 1e-6
    if wrong.any():
        raise ValueError(f"{where}[{wrong.argmax()}]: expected 0 0 0 1 in the last row; is the matrix transposed?")
    return matrices


def poses(world_from_camera, camera_from_world, axes, default=None):
    """(N, 4, 4) float64, whether they are camera_from_world, whether their camera's axes are OpenGL's."""
    if axes not in _AXES:
        raise ValueError(f"axes: expected 'opencv' or 'opengl', found {axes!r}")
    given = [pose for pose in (default, world_from_camera, camera_from_world) if pose is not None]
    if len(given) != 1:
        raise TypeError("poses: expected them once, as poses, world_from_camera= or camera_from_world=")
    inverse = camera_from_world is not None
    return _matrices("camera_from_world" if inverse else "poses", given[0]), inverse, _AXES[axes]


def one_pose(world_from_camera, camera_from_world, axes, default=None):
    matrices, inverse, opengl = poses(world_from_camera, camera_from_world, axes, default)
    if len(matrices) != 1:
        raise ValueError(f"pose: expected one, found {len(matrices)}")
    return matrices[0], inverse, opengl

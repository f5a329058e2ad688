# SPDX-License-Identifier: Apache-2.0
"""What callers hand over, brought into the one form that the extension module takes. `where` begins each message."""
import numpy as np

_DEPTH = "float32 or uint16 (float16 and float64 are converted)"


def _refuse_shape(where, expected, found):
    raise ValueError(f"{where}: expected {expected}, found shape {tuple(found)}")


def _array(where, value):
    """Also of what knows how to become an array: tensors of torch on the CPU, pictures of PIL, images of Open3D."""
    try:
        return np.asarray(value)
    except Exception as error:
        raise TypeError(f"{where}: expected an array, found {type(value).__name__}") from error


def _plane(where, array):
    """(H, W), of (H, W, 1) or (1, H, W) as networks give them."""
    if array.ndim == 3 and array.shape[-1] == 1:
        array = array[..., 0]
    elif array.ndim == 3 and array.shape[0] == 1:
        array = array[0]
    if array.ndim != 2 or 0 in array.shape:
        _refuse_shape(where, "(H, W)", array.shape)
    return array


def _packed_rows(array):
    """Rows may lie anywhere; the numbers of one row, side by side."""
    native = array.dtype.isnative and array.strides[-1] == array.itemsize
    return array if native else np.ascontiguousarray(array, array.dtype.newbyteorder("="))


def depth_as_it_is(where, value):
    """Checked, not converted."""
    array = _plane(where, _array(where, value))
    if (array.dtype.kind, array.dtype.itemsize) not in (("f", 2), ("f", 4), ("f", 8), ("u", 2)):
        raise TypeError(f"{where}: expected {_DEPTH}, found {array.dtype}")
    return array


def depth(where, value):
    array = depth_as_it_is(where, value)
    return _packed_rows(array.astype(np.float32, copy=False) if array.dtype.kind == "f" else array)


def confidence(where, value, shape):
    if value is None:
        return None
    array = _plane(where, _array(where, value))
    if array.dtype.kind not in "fui":
        raise TypeError(f"{where}: expected numbers, found {array.dtype}")
    _require_shape(where, array, shape)
    return np.ascontiguousarray(array, np.float32)


def mask(where, value, shape):
    if value is None:
        return None
    array = _plane(where, _array(where, value))
    if array.dtype.kind not in "bui":
        raise TypeError(f"{where}: expected bool or whole numbers, 0 outside the object, found {array.dtype}")
    _require_shape(where, array, shape)
    return np.ascontiguousarray(array != 0, np.uint8)


def color(where, value):
    if value is None:
        return None
    array = _array(where, value)
    if array.dtype != np.uint8:
        raise TypeError(f"{where}: expected uint8, found {array.dtype}")
    if array.ndim != 3 or array.shape[2] not in (3, 4) or 0 in array.shape:
        _refuse_shape(where, "(H, W, 3)", array.shape)
    return np.ascontiguousarray(array[..., :3])


def _require_shape(where, array, shape):
    if array.shape != tuple(shape):
        _refuse_shape(where, f"the depth's {tuple(shape)}", array.shape)


def view(where, depth_value, confidence_value=None, color_value=None, mask_value=None):
    """The tuple of arrays of one view."""
    image = depth(f"{where}: depth", depth_value)
    return (image, confidence(f"{where}: confidence", confidence_value, image.shape),
            color(f"{where}: color", color_value), mask(f"{where}: mask", mask_value, image.shape))

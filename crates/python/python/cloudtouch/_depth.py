"""Depth images: from what a camera stores to points."""

from __future__ import annotations

import os
import warnings
from typing import Any

import numpy as np
import numpy.typing as npt

from cloudtouch import _arrays, _given, _native

#: Of 16 bits the largest number, which some cameras store where nothing came back.
NO_RETURN = 65535


def points(depth: Any, intrinsics: npt.ArrayLike, depth_scale: float | None) -> npt.NDArray[np.float64]:
    """(height, width, 3): places in the optical frame of the camera, m, NaN where nothing came back."""
    depth_scale = _given.optional_number(depth_scale, "depth_scale")
    metres = _metres(depth, depth_scale)
    height, width = metres.shape
    fx, fy, cx, cy = camera = _pinhole(intrinsics)
    doubt = _native.check_camera(camera, 0.001 if depth_scale is None else depth_scale, (width, height))
    if doubt is not None:
        warnings.warn(doubt, stacklevel=3)
    rows, columns = np.indices(metres.shape)
    return np.stack([(columns - cx) / fx * metres, (rows - cy) / fy * metres, metres], axis=-1)


def placed(image: npt.NDArray[np.float64], pose: npt.ArrayLike) -> npt.NDArray[np.float64]:
    """The same where a pose puts them."""
    turn_and_place = _arrays.numbers(pose, "sensor_pose", (4, 4))
    return image @ turn_and_place[:3, :3].T + turn_and_place[:3, 3]


def _metres(depth: Any, depth_scale: float | None) -> npt.NDArray[np.float64]:
    if isinstance(depth, np.ma.MaskedArray):
        raise ValueError("depth is a masked array: give depth.filled(0), 0 for no return")
    if isinstance(depth, (str, os.PathLike)):
        path = os.fspath(depth)
        raise TypeError(
            f"depth is {path!r}, the name of a file: give its array, such as cv2.imread({path!r}, cv2.IMREAD_UNCHANGED)"
        )
    array = _arrays.array_of(depth, "depth")
    if array.ndim == 3 and array.shape[2] == 1:
        array = array[:, :, 0]
    if array.ndim != 2 or min(array.shape) < 2:
        raise ValueError(f"depth has the shape {array.shape}: give (height, width), a depth for each pixel")
    if array.dtype.kind in "iu" and array.dtype.itemsize > 1:
        steps = array.astype(np.float64)
        steps[(array <= 0) | (array == NO_RETURN)] = np.nan
        return steps * (0.001 if depth_scale is None else depth_scale)
    if array.dtype.kind != "f" or array.dtype.itemsize < 4:
        raise ValueError(
            f"depth has the type {array.dtype}: give whole steps as the camera stores them (uint16), or metres "
            "(float32 or float64)"
        )
    if depth_scale is not None:
        raise ValueError("depth_scale is for whole steps (uint16), and depth has floats, which are metres: leave it out")
    metres = array.astype(np.float64)
    metres[~(np.isfinite(metres) & (metres > 0))] = np.nan
    return metres


def _pinhole(intrinsics: npt.ArrayLike) -> tuple[float, float, float, float]:
    if isinstance(intrinsics, (str, os.PathLike)):
        path = os.fspath(intrinsics)
        raise TypeError(
            f"intrinsics is {path!r}: give the numbers, (fx, fy, cx, cy) in pixels or (3, 3); `cloudtouch --intrinsics` "
            "alone reads files"
        )
    array = _arrays.array_of(intrinsics, "intrinsics")
    if array.dtype.kind not in "fiu":
        raise ValueError(f"intrinsics has the type {array.dtype}: give numbers, (fx, fy, cx, cy) in pixels or (3, 3)")
    array = array.astype(np.float64)
    if array.shape == (4,):
        fx, fy, cx, cy = array.tolist()
        return fx, fy, cx, cy
    if array.shape != (3, 3):
        raise ValueError(f"intrinsics has the shape {array.shape}: give (fx, fy, cx, cy) in pixels, or (3, 3)")
    wanted = np.array([[array[0, 0], 0, array[0, 2]], [0, array[1, 1], array[1, 2]], [0, 0, 1]])
    if not np.array_equal(array, wanted):
        raise ValueError(
            f"intrinsics is {array.tolist()}: give [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], without skew, row by row"
        )
    return array[0, 0].item(), array[1, 1].item(), array[0, 2].item(), array[1, 2].item()

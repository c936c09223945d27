"""What users have, as arrays that the library reads; what is of the right kind already is not copied."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from cloudtouch import _given

#: Units that arrays may say they are in: those of the package, and none.
UNITS = ("", "m", "meter", "metre", "rad", "radian", "dimensionless")

#: As numpy writes a shape, of which the first number is free.
FREE = -1


def boxes(told: list[tuple[str, list[list[float]]]]) -> dict[str, npt.NDArray[np.float64]]:
    """(2, 3) for each name."""
    return {name: np.array(corners) for name, corners in told}


def by_name(value: Any) -> Any:
    """A row of a pandas table as a mapping, for its numbers are in whatever order its columns are."""
    row = value.to_dict() if hasattr(value, "to_dict") else None
    return row if row and all(isinstance(name, str) for name in row) else value


def rows_of(value: Any) -> Any:
    """The rows of a pandas table by the names of its columns; of anything else what it holds."""
    return value.to_dict("records") if hasattr(value, "columns") and hasattr(value, "to_dict") else value


def array_of(value: Any, name: str) -> npt.NDArray[Any]:
    """What a user gave as an array, whatever its shape and type."""
    if value is None or isinstance(value, (str, bytes, os.PathLike)):
        raise TypeError(f"{name} is {_given.told(value)}: give an array of numbers")
    if isinstance(value, Iterator) and not hasattr(value, "__array__"):
        raise TypeError(f"{name} is {_given.told(value)}, which gives one after the other: give list({name})")
    _refuse_unit(value, name)
    try:
        return np.asarray(value)
    # RuntimeError is that of a tensor of torch that needs a gradient.
    except (TypeError, ValueError, RuntimeError) as error:
        raise ValueError(f"{name} makes no array ({error}): give rows of equally many numbers") from None


def points(value: Any, name: str, *, of_image: bool = True) -> tuple[npt.NDArray[Any], tuple[int, int] | None]:
    """Rows of x, y and z, and width and height where they are those of an image."""
    _refuse_mask(value, name)
    columns = _columns(value, name)
    array = array_of(value, name) if columns is None else _side_by_side(columns, name)
    if array.dtype.names:
        array = _side_by_side({field: array[field] for field in array.dtype.names}, name)
    if array.shape == (0,):
        array = np.empty((0, 3))
    image_size = None
    if array.ndim == 3:
        height, width = array.shape[:2]
        image_size = (width, height)
        if array.shape[2] == 3:
            array = array.reshape(-1, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        images = ", or (height, width, 3) for a depth image" if of_image else ""
        raise ValueError(f"{name} has the shape {array.shape}: give (N, 3){images}")
    return _readable(array, name), image_size


def _columns(value: Any, name: str) -> dict[str, Any] | None:
    """The columns of a pandas table by name, those of the points with what is in them; ``None`` of anything else."""
    names = list(value.columns) if hasattr(value, "columns") and hasattr(value, "__getitem__") else []
    if not any(isinstance(column, str) for column in names):
        return None
    for field in "xyz":
        if names.count(field) > 1:
            raise ValueError(f"{name} has the column {field} twice: leave out the one that is not meant")
    # One by one: beside a column of words all of a table are objects.
    return {str(column): value[column] if column in ("x", "y", "z") else None for column in names}


def _side_by_side(fields: dict[str, Any], name: str) -> npt.NDArray[Any]:
    """Rows of x, y and z, each of a field of its own."""
    missing = [field for field in "xyz" if field not in fields]
    if missing:
        raise ValueError(f"{name} has the fields {', '.join(fields)}: {', '.join(missing)} is missing")
    return np.stack([_column(fields[field], f"{name}[{field!r}]") for field in "xyz"], axis=-1)


def _column(value: Any, name: str) -> npt.NDArray[Any]:
    """Numbers of one field; what a table of pandas has none of, where it says so, is a missing return."""
    array = array_of(value, name)
    if array.dtype.kind == "O" and getattr(value.dtype, "kind", "O") in "fiu":
        array = value.to_numpy(dtype=np.float64, na_value=np.nan)
    return _readable(array, name)


def numbers(value: Any, name: str, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
    """Numbers of one shape, in double precision."""
    _refuse_mask(value, name)
    array = array_of(value, name)
    if array.shape == (0,) and shape[0] == FREE:
        # An empty list: none of them.
        array = np.empty((0, *shape[1:]))
    fits = array.ndim == len(shape) and all(n in (FREE, m) for n, m in zip(shape, array.shape))
    if not fits:
        wanted = str(shape).replace(str(FREE), "N")
        is_quaternion = shape[-2:] == (4, 4) and array.shape[-1:] == (7,)
        remedy = ", matrices and not positions with quaternions" if is_quaternion else ""
        raise ValueError(f"{name} has the shape {array.shape}: give {wanted}{remedy}")
    return np.asarray(_readable(array, name), dtype=np.float64)


def indices(value: Any, name: str) -> npt.NDArray[np.uint32]:
    """Three indices of vertices a row."""
    array = _whole(value, name)
    if array.size == 0:
        array = np.empty((0, 3), dtype=np.uint32)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name} has the shape {array.shape}: give (M, 3), three indices a triangle")
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name} has the type {array.dtype}: give whole numbers, such as int64")
    if array.size and (array.min() < 0 or array.max() > np.iinfo(np.uint32).max):
        low, high = array.min(), array.max()
        raise ValueError(f"{name} holds indices from {low} to {high}: they count vertices from 0")
    return np.require(array, dtype=np.uint32, requirements="A")


def places(value: Any, name: str, count: int) -> list[int]:
    """Which of so many rows, by indices or by a truth value each."""
    array = _whole(value, name)
    if array.size == 0 and array.ndim == 1 and array.dtype.kind != "b":
        array = array.astype(np.int64)
    if array.ndim != 1 or (array.dtype.kind == "b" and len(array) != count):
        raise ValueError(f"{name} has the shape {array.shape}: give indices (K,), or truth values ({count},)")
    if array.dtype.kind == "b":
        array = np.flatnonzero(array)
    if array.dtype.kind not in "iu":
        raise ValueError(f"{name} has the type {array.dtype}: give whole numbers, such as int64, or truth values")
    if array.size and array.min() < 0:
        raise ValueError(f"{name} holds the index {array.min()}: points are counted from 0")
    found: list[int] = array.tolist()
    return found


def _readable(array: npt.NDArray[Any], name: str) -> npt.NDArray[Any]:
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name} has the type {array.dtype}: give numbers, float32 or float64")
    if array.dtype.kind == "f" and array.dtype.itemsize < 4:
        # A metre to half a millimetre, and four to two: a grid that no sensor has.
        raise ValueError(f"{name} has the type {array.dtype}, of three digits: give float32 or float64")
    single = array.dtype.itemsize == 4 and array.dtype.kind == "f"
    # Aligned, and in the byte order of the machine.
    return np.require(array, dtype=np.float32 if single else np.float64, requirements="A")


def _whole(value: Any, name: str) -> npt.NDArray[Any]:
    """An array of indices, of which none is masked: what is under a mask would count."""
    if isinstance(value, np.ma.MaskedArray):
        raise ValueError(f"{name} is a masked array: give the rows of it that count, as a plain array")
    return array_of(value, name)


def _refuse_mask(value: Any, name: str) -> None:
    if isinstance(value, np.ma.MaskedArray):
        raise ValueError(f"{name} is a masked array: give {name}.filled(numpy.nan), NaN for no return")


def _refuse_unit(value: Any, name: str) -> None:
    """What knows its unit loses it as a plain array, and its millimetres would be metres."""
    if isinstance(value, np.ndarray) or hasattr(value, "magnitude"):
        unit = getattr(value, "units", getattr(value, "unit", None))
        if unit is not None and str(unit) not in UNITS:
            raise ValueError(f"{name} is in {unit}: give plain numbers, in metres and radians")

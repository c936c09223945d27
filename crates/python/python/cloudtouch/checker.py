"""Tables of poses in, tables of answers out: what a data engine calls on each of its workers."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from cloudtouch import _given, _native
from cloudtouch._kept import Kept
from cloudtouch._native import CloudtouchError
from cloudtouch.bodies import Cloud, Mesh, check_sensor
from cloudtouch.query import Body, Query
from cloudtouch.report import Batch

#: Extensions that are read as meshes; a ``.ply`` is a mesh as an object, and as a scene if it has faces.
MESHES = (".stl", ".obj")
#: Columns that a row has to have.
NEEDED = ("scene", "object", "pose")


class PoseChecker:
    """Answers rows of (scene, object, pose); call it with columns.

    A plain class that keeps the bodies it prepared last: Ray Data's ``map_batches``, Dask's ``map_partitions`` and a loop
    of your own run it as it is; a table of pandas comes back as one. Answers do not depend on how rows are shared out. A row that cannot be answered has the
    verdict ``"error"`` and says why; it costs no other row its answer.

    Parameters
    ----------
    root
        Folder that the paths in the columns ``scene`` and ``object`` start from.
    sensor
        Of scenes, as for :class:`Cloud`.
    object_sensor
        Of objects that are clouds; that of scenes where it is not given.
    unit, cloud_unit
        Of meshes and of clouds.
    query
        Settings by name, as :class:`Query` takes them.
    keep
        How many scenes, and how many objects, stay prepared. Rows in the order of their scenes are prepared once.

    Raises
    ------
    ValueError
        There is no folder ``root``.
    CloudtouchError
        A sensor or a unit is not known, or a setting of ``query`` is out of range.
    """

    def __init__(
        self,
        root: str | os.PathLike[str] = ".",
        *,
        sensor: str,
        object_sensor: str | None = None,
        unit: str = "m",
        cloud_unit: str = "m",
        query: Mapping[str, Any] | None = None,
        keep: int = 4,
    ) -> None:
        self._root = _given.folder(root, "root")
        if not self._root.is_dir():
            raise ValueError(f"root is {root}: there is no such folder: give the one that the paths start from")
        self._sensors = (sensor, sensor if object_sensor is None else object_sensor)
        for stated, name in zip(self._sensors, ("sensor", "object_sensor")):
            check_sensor(stated, name)
        self._units = (_given.text(unit, "unit"), _given.text(cloud_unit, "cloud_unit"))
        for stated, name in zip(self._units, ("unit", "cloud_unit")):
            _native.check_unit(stated, name)
        if query is not None and not isinstance(query, Mapping):
            raise TypeError(f'query is {_given.told(query)}: give its settings by name, such as {{"reject": 0.05}}')
        self._query = Query(**(query or {}))
        self._scenes: Kept[Body] = Kept(_given.count(keep, "keep"))
        self._objects: Kept[Body] = Kept(self._scenes.limit)

    def __repr__(self) -> str:
        sensor, object_sensor = self._sensors
        return f"<PoseChecker: files in {self._root}, sensors {sensor!r} and {object_sensor!r}, {self._query!r}>"

    def __call__(self, rows: Any) -> Any:
        """The columns of ``rows``, and those of :class:`Batch` beside them.

        Parameters
        ----------
        rows
            Columns of M rows by their names, or a DataFrame of pandas, whose index stays. ``scene`` and ``object``: paths.
            ``pose``: from object to scene, 16 numbers row by row, (4, 4) or as nested lists. All others are handed on.

        Returns
        -------
        dict or DataFrame
            As ``rows`` are.

        Raises
        ------
        ValueError
            A column is missing, or has another length.
        """
        count = _count(rows)
        # By place from here on: a column of pandas goes by its labels, which need not be in order, nor be there.
        columns = {name: column if _is_masked(column) else _array(column) for name, column in rows.items()}
        asked = {name: _array(column) for name, column in rows.items() if name in NEEDED}
        poses = [_sixteen(pose) for pose in asked["pose"]]
        answers = _refused("", count).columns()
        answers = {name: column.astype(_wide(column.dtype)) for name, column in answers.items()}
        for names, places in _groups(asked, poses):
            batch = self._answer(names, [poses[place] for place in places])
            for name, column in batch.columns().items():
                answers[name][places] = column
        if hasattr(rows, "assign"):
            return rows.assign(**_of_table(type(rows), answers, count))
        return {**columns, **answers}

    def _answer(self, names: tuple[str, str], poses: list[Any]) -> Batch:
        if isinstance(poses[0], str):
            return _refused(poses[0], len(poses))
        for column, name in zip(NEEDED, names):
            if not name:
                return _refused(f"{column} is missing: give a path that starts from root", len(poses))
        try:
            scene = self._scenes.get(names[0], lambda: self._read(names[0], is_scene=True))
            body = self._objects.get(names[1], lambda: self._read(names[1], is_scene=False))
            batch = self._query.run_batch(scene, body, np.stack(poses), errors="keep")
        except (ValueError, OSError) as error:
            return _refused(str(error), len(poses))
        # A row is named by the table it is in, not by its place among those of the same pair.
        words = [text.partition(": ")[2] if text.startswith("poses[") else text for text in batch.error.tolist()]
        return replace(batch, error=np.asarray(words, dtype=np.str_))

    def _read(self, name: str, *, is_scene: bool) -> Body:
        path, (unit, cloud_unit) = self._root / name, self._units
        suffix = path.suffix.lower()
        if suffix in MESHES or (suffix == ".ply" and not is_scene):
            return Mesh.read(path, unit=unit)
        if suffix == ".ply":
            # As a cloud a mesh would be its vertices, and free between them.
            with contextlib.suppress(CloudtouchError):
                return Mesh.read(path, unit=unit)
        sensor = self._sensors[0 if is_scene else 1]
        return Cloud.read(path, sensor=sensor, unit=cloud_unit, refined=is_scene)


def _count(rows: Any) -> int:
    if not isinstance(rows, Mapping) and not hasattr(rows, "assign"):
        told = f"{type(rows).__module__}.{type(rows).__name__}"
        instead = 'in Ray batch_format="numpy", of Arrow to_pydict(), of Polars to_dict()'
        raise TypeError(f"rows is a {told}: give columns by their names or a table of pandas ({instead})")
    twice = [name for name in NEEDED if list(rows).count(name) > 1]
    if twice:
        raise ValueError(f"columns {', '.join(map(str, rows))}: {', '.join(twice)} is there twice: leave one of them")
    missing = [name for name in NEEDED if name not in rows]
    if missing:
        raise ValueError(f"columns {', '.join(map(str, rows))}: {', '.join(missing)} is missing")
    lengths = {name: len(column) for name, column in rows.items()}
    if len(set(lengths.values())) > 1:
        told = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ValueError(f"columns have different lengths: {told}")
    return lengths["pose"]


def _groups(
    rows: Mapping[str, npt.NDArray[Any]], poses: list[Any]
) -> Iterator[tuple[tuple[str, str], npt.NDArray[np.int64]]]:
    """Scene and object, and the rows that ask about them, in the order they first come; those without a pose apart."""
    places: dict[tuple[str, str, str], list[int]] = {}
    for place, pose in enumerate(poses):
        refused = pose if isinstance(pose, str) else ""
        key = (_path(rows["scene"][place]), _path(rows["object"][place]), refused)
        places.setdefault(key, []).append(place)
    for (scene, body, _), group in places.items():
        yield (scene, body), np.asarray(group)


def _path(value: Any) -> str:
    # Where a table has nothing, it hands None or NaN on.
    return str(value) if isinstance(value, (str, os.PathLike)) else ""


def _of_table(kind: Any, answers: Mapping[str, npt.NDArray[Any]], count: int) -> dict[str, Any]:
    """Columns for a table. Those of no rows are of the kinds they are of elsewhere: made of nothing, all would be numbers."""
    if count:
        return {name: list(column) for name, column in answers.items()}
    one = {name: list(column) for name, column in _refused("", 1).columns().items()}
    return dict(kind(one).iloc[:0].items())


def _sixteen(pose: Any) -> npt.NDArray[np.float64] | str:
    """The matrix, or why there is none."""
    if isinstance(pose, str) and pose.startswith("["):
        return "pose is not 16 numbers but text: Dask makes it of lists in memory unless dataframe.convert-string is False"
    try:
        given = np.asarray(_plain(pose))
        # Imaginary parts would be lost, and True is not 1.
        numbers = np.asarray(given, dtype=np.float64) if given.dtype.kind not in "bc" else np.empty(0)
    except (TypeError, ValueError):
        numbers = np.empty(0)
    # What is under a mask is not known.
    if numbers.size != 16 or np.ma.getmaskarray(pose).any():
        return "pose is not 16 numbers: give those of a 4 x 4 matrix, row by row"
    return numbers.reshape(4, 4)


def _plain(pose: Any) -> Any:
    # Arrow tables hand nested lists on as arrays of arrays.
    if isinstance(pose, np.ndarray) and pose.dtype == object:
        return [_plain(row) for row in pose]
    return pose


def _is_masked(value: Any) -> bool:
    return isinstance(value, np.ma.MaskedArray)


def _array(column: Any) -> npt.NDArray[Any]:
    try:
        # As one array, rows would lose their masks.
        if not _is_masked(column) and not any(map(_is_masked, column)):
            return np.asarray(column)
    except ValueError:
        pass
    # Rows of different shapes too, such as a pose that is none among others: each stays as it is.
    rows = np.empty(len(column), dtype=object)
    for place, row in enumerate(column):
        rows[place] = row
    return rows


def _wide(dtype: np.dtype[Any]) -> np.dtype[Any] | type:
    # Text of any length: the rows of another pair may have longer messages.
    return object if dtype.kind == "U" else dtype


def _refused(message: str, count: int) -> Batch:
    """Rows that could not be asked about, all for one reason."""
    return Batch._of(_native.refused(message, count))

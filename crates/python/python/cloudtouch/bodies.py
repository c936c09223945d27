"""Bodies: noisy clouds and exact meshes, prepared once and queried in any pose."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable, Iterator, Sized
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from cloudtouch import _arrays, _depth, _given, _native


@dataclass(frozen=True, eq=False)
class SeenLink:
    """A part of the robot where a camera saw it; :meth:`Robot.seen` makes them."""

    mesh: Mesh
    """The part, in its own frame."""
    pose: npt.NDArray[np.float64]
    """(4, 4): from its frame into that of the points, m."""
    padding: float
    """Points this near to its surface, m, are taken for it too."""


class Change(NamedTuple):
    """What a change did to a cloud."""

    inserted: int
    """Points that came."""
    removed: int
    """Points that went."""
    moved: int
    """Points that are elsewhere."""
    surfaces_kept: int
    """Points whose surface was computed before and is kept."""
    surfaces_lost: int
    """Points whose surface was computed before and is computed anew."""
    is_recentred: bool
    """Whether the cloud has moved by more than its size: then all surfaces are lost."""
    is_rebuilt: bool
    """Whether index and tree were built anew, and not only where something changed."""


class Cloud:
    """A noisy point cloud, ready to be queried in any pose, from many threads at once.

    Preparing takes all cores and lets other Python threads run. :meth:`insert`, :meth:`remove`, :meth:`move_points` and
    :meth:`replace_frame` change a cloud in its place, and scenes and robots that have it see that. They are refused
    while another thread asks about the cloud.

    Parameters
    ----------
    points
        (N, 3), float32 or float64, m: rows of NaN are passed over, as missing returns. Or (height, width, 3): a depth
        image as its camera delivers it, NaN where nothing came back, of which it is known what was not seen. Any strides;
        read where they are. A structured array with fields x, y and z (as ROS's PointCloud2 is read), of one or two
        dimensions, will do, and so will a pandas table with such columns or an object with ``.points``, such as an
        Open3D cloud.
    sensor
        What measured it, and how noisy that is: ``"kinect"``, ``"stereo:BASELINE_M,FOCAL_PX,DISPARITY_STD_PX"``,
        ``"tof:STD_M,PER_METRE"``, ``"lidar:RANGE_STD_M,BEAM_RAD"``, ``"iso:STD_M"``, ``"axes:SX,SY,SZ"``, ``"grid:RESOLUTION_M"``, ``"exact"`` or
        ``"per-point"``; of a file ``cloudtouch info FILE`` suggests one. State it as it is: twice the noise reads more touching surfaces as free, half of it stops more.
    sensor_pose
        (4, 4): from the frame of the sensor (of a camera x right, y down, z forward) into that of the points. Where
        it is not given it counts as the identity, but nothing is concluded from where the sensor stood. Not for scans
        from several places in one cloud: what lies between it and a return counts as empty.
    covariances
        (N, 3, 3), m^2: the noise of each point, for ``sensor="per-point"``.
    normals
        (N, 3), of any length and either sign. They are believed: leave out what was fitted to noisy points.
    min_range, max_range
        Points nearer to the sensor, or farther, are dropped, m. Where not given, those within 10 cm of a camera or
        laser scanner, if they have the rows and columns of an image.
    keep_veil
        Keeps the points that float between a near and a far surface at the edges of a camera's image, which are dropped
        otherwise (``removed["veil"]`` says how many).
    outliers
        (neighbors, deviations): drops points whose mean distance to so many neighbours is so many standard deviations
        above that of all.
    collision_map
        Edge of a cell, m: points are replaced by the centres of the occupied cells.
    robot
        Where the robot was when the points were measured, as :meth:`Robot.seen` gives it: points in it, or as near to it
        as its padding, are removed.
    refined
        Computes the surface everywhere now, and not where queries come near it: later ready, and each query one and a
        half to four times as fast. For a scene that thousands of poses are tested in.

    Raises
    ------
    ValueError
        An array has the wrong shape or type.
    CloudtouchError
        Nothing is left of the cloud, a number is out of range or the sensor is not known; the message says what to do.
    """

    __slots__ = ("_arguments", "_body")

    _arguments: dict[str, Any]
    _body: _native.Body

    def __init__(
        self,
        points: Any,
        *,
        sensor: str,
        sensor_pose: npt.ArrayLike | None = None,
        covariances: npt.ArrayLike | None = None,
        normals: npt.ArrayLike | None = None,
        min_range: float | None = None,
        max_range: float | None = None,
        keep_veil: bool = False,
        outliers: tuple[int, float] | None = None,
        collision_map: float | None = None,
        robot: Iterable[SeenLink] = (),
        refined: bool = False,
    ) -> None:
        self._prepare(
            *_scan(
                points,
                sensor=sensor,
                sensor_pose=sensor_pose,
                covariances=covariances,
                normals=normals,
                min_range=min_range,
                max_range=max_range,
                keep_veil=keep_veil,
                outliers=outliers,
                collision_map=collision_map,
                robot=robot,
                refined=refined,
            )
        )

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        *,
        sensor: str,
        unit: str = "m",
        sensor_pose: npt.ArrayLike | None = None,
        **others: Any,
    ) -> Cloud:
        """A cloud from a file: ``.pcd``, ``.ply``, ``.xyz``, ``.txt`` or ``.csv``.

        Parameters
        ----------
        unit
            Of its coordinates: ``"m"``, ``"cm"``, ``"mm"`` or ``"in"``.
        sensor, sensor_pose
            As for :class:`Cloud`. Where the sensor stood is taken from the file if it is not given.
        others
            Every other argument of :class:`Cloud`, by name.

        Raises
        ------
        CloudtouchError
            The file cannot be read, is malformed or has another extension, with place and remedy; and what
            :class:`Cloud` raises.
        """
        path = _given.file(path, "path")
        if os.fspath(path).lower().endswith(".png"):
            raise _native.CloudtouchError(
                f"{os.fspath(path)}: a depth image is read with the intrinsics of its camera: give its array to "
                "Cloud.from_depth, such as cv2.imread(path, cv2.IMREAD_UNCHANGED)"
            )
        rows, image_size, pose, covariances = _native.read_cloud(path, _given.text(unit, "unit"))
        if image_size is not None:
            width, height = image_size
            rows = rows.reshape(height, width, 3)
        if isinstance(sensor, str) and sensor.strip() == "per-point":
            others.setdefault("covariances", covariances)
        with _naming(path):
            return cls(rows, sensor=sensor, sensor_pose=pose if sensor_pose is None else sensor_pose, **others)

    @classmethod
    def from_depth(
        cls,
        depth: npt.ArrayLike,
        intrinsics: npt.ArrayLike,
        *,
        sensor: str,
        depth_scale: float | None = None,
        sensor_pose: npt.ArrayLike | None = None,
        **others: Any,
    ) -> Cloud:
        """A cloud from a depth image as cameras and data sets store it, of which it is known what was not seen.

        Its points are in the optical frame of the camera (x right, y down, z forward), or where ``sensor_pose`` puts
        them.

        Parameters
        ----------
        depth
            (height, width): depths along the axis of the camera, not along the ray. Whole numbers (uint16) are steps, of
            which 0 and 65535 stand for no return; floats are metres, of which 0, negative ones, NaN and infinity do.
        intrinsics
            (fx, fy, cx, cy) or (3, 3), pixels, of this image. Lens distortion is not corrected: rectify first.
        sensor
            As for :class:`Cloud`.
        depth_scale
            Metres a step; 0.001 where it is not given. TUM's images have 0.0002.
        sensor_pose
            (4, 4): from the camera into the frame that poses will be given in. The camera's own frame where it is not
            given.
        others
            Every other argument of :class:`Cloud`, by name.

        Raises
        ------
        ValueError
            An array has the wrong shape or type.
        CloudtouchError
            No camera has such intrinsics for an image of this size; and what :class:`Cloud` raises.

        Examples
        --------
        >>> depth = numpy.full((48, 64), 800, dtype=numpy.uint16)
        >>> cloudtouch.Cloud.from_depth(depth, (60, 60, 31.5, 23.5), sensor="iso:0.002")
        <Cloud: 3072 points, sensor 'iso:0.002', 0.84 x 0.627 x 0 m about (0, 0, 0.8)>
        """
        image = _depth.points(depth, intrinsics, depth_scale)
        pose = np.eye(4) if sensor_pose is None else sensor_pose
        return cls(_depth.placed(image, pose), sensor=sensor, sensor_pose=pose, **others)

    def _prepare(self, rows: npt.NDArray[Any], arguments: dict[str, Any]) -> None:
        self._arguments = arguments
        self._body = _native.cloud(rows, _told(arguments))

    def insert(self, points: Any, *, sensor: str | None = None, **others: Any) -> Change:
        """Adds another scan of the same frame, behind the points that there are.

        A changed cloud answers as one made of the same points does, up to rounding, but near lonely samples, where it may
        differ by a tenth and more. After :meth:`rebuild` it does to the bit, as long as the middle of the box around them
        stays. What is kept is the surface where nothing near has changed.

        Parameters
        ----------
        points, others
            As for :class:`Cloud`, of this scan alone: nothing is taken over from the first.
        sensor
            That of the cloud where it is not given.

        Raises
        ------
        ValueError
            An array has the wrong shape or type.
        CloudtouchError
            As :class:`Cloud`, or another thread asks about the cloud; it is then as it was.
        """
        rows, arguments = _scan(points, sensor=self.sensor if sensor is None else sensor, **others)
        return Change(*self._body.insert(rows, _told(arguments)))

    def replace_frame(self, image: Any, *, sensor: str | None = None, **others: Any) -> Change:
        """Brings the cloud up to date by what a camera sees now.

        Points that it sees through, or measures again, go, and its own come. What is hidden, in a hole of the image or
        beside it stays as it was. A panorama, as of a turning laser scanner, takes away what it sees through and nothing
        that it measures again: the cloud grows with every such frame.

        Parameters
        ----------
        image
            (height, width, 3): a depth image in the frame of the cloud, m.
        sensor
            That of the cloud where it is not given.
        others
            As for :class:`Cloud`; ``sensor_pose`` says where the camera stood.

        Raises
        ------
        ValueError
            An array has the wrong shape or type.
        CloudtouchError
            It is no image, or as :meth:`insert`.
        """
        rows, arguments = _scan(image, sensor=self.sensor if sensor is None else sensor, **others)
        return Change(*self._body.replace_frame(rows, _told(arguments)))

    def remove(self, which: npt.ArrayLike) -> Change:
        """Removes points; those after them move up.

        Parameters
        ----------
        which
            (K,), whole numbers: indices into :attr:`points`, each once. Or (len(cloud),), truth values.

        Raises
        ------
        ValueError
            ``which`` has the wrong shape or type.
        CloudtouchError
            There is no such point, one is named twice, none would be left, or another thread asks about the cloud.
        """
        return Change(*self._body.remove(_arrays.places(which, "which", len(self))))

    def move_points(self, which: npt.ArrayLike, places: npt.ArrayLike) -> Change:
        """Moves points; they keep their indices and their noise.

        Parameters
        ----------
        which
            As of :meth:`remove`.
        places
            (K, 3): where to, in the frame of the cloud, m.

        Raises
        ------
        ValueError
            An array has the wrong shape or type.
        CloudtouchError
            There is no such point, one is named twice, a place is not finite, or another thread asks about the cloud.
        """
        indices = _arrays.places(which, "which", len(self))
        return Change(*self._body.move_points(indices, _arrays.numbers(places, "places", (len(indices), 3))))

    def rebuild(self) -> Change:
        """Builds index and tree anew, and keeps the surface: answers are those of a cloud made anew.

        After a change they may differ near lonely samples, seldom by a tenth. A change does this by itself where
        much has changed since the last time; this is for moments when nobody waits.

        Raises
        ------
        CloudtouchError
            Another thread asks about the cloud.
        """
        return Change(*self._body.rebuild())

    @property
    def points(self) -> npt.NDArray[np.float64]:
        """(K, 3): the points that were kept, m, in the frame they were given in."""
        return self._body.points()

    @property
    def rows(self) -> npt.NDArray[np.int64]:
        """(K,): for every kept point its row in what was given (of an image row by row), counted on from scan to scan where
        others were inserted; empty after a collision map."""
        return self._body.rows()

    @property
    def removed(self) -> dict[str, int]:
        """How many points each stage of the filter took away."""
        return dict(self._body.removed())

    @property
    def sensor(self) -> str:
        """The sensor, as it was stated."""
        return str(self._arguments["sensor"])

    @property
    def prepare_seconds(self) -> float:
        """How long preparation took."""
        return self._body.prepare_seconds()

    def __len__(self) -> int:
        """How many points were kept."""
        return self._body.count()

    def __repr__(self) -> str:
        removed = ", ".join(f"{stage} {count}" for stage, count in self.removed.items() if count)
        dropped = f" (removed: {removed})" if removed else ""
        return f"<Cloud: {len(self)} points{dropped}, sensor {self.sensor!r}, {_extent(self.points)}>"

    def __getstate__(self) -> tuple[npt.NDArray[np.float64], dict[str, Any]]:
        points = self._body.given_points()
        if points is None:
            raise TypeError("a cloud that was changed does not pickle: pickle the scans that it was made of")
        return points, self._arguments

    def __setstate__(self, state: tuple[npt.NDArray[np.float64], dict[str, Any]]) -> None:
        self._prepare(*state)


class Mesh:
    """A triangle mesh, ready to be queried in any pose, from many threads at once. Its surface is exact.

    Parameters
    ----------
    vertices
        (V, 3), float32 or float64, m. Or an object with ``.vertices`` and ``.faces`` or ``.triangles``, such as a mesh of
        trimesh or Open3D; ``triangles`` is then left out.
    triangles
        (M, 3), whole numbers: indices of vertices from 0, anticlockwise seen from outside. A mesh that is not watertight
        is a surface without an inside.

    Raises
    ------
    ValueError
        An array has the wrong shape or type.
    CloudtouchError
        There are no triangles, an index or a coordinate is out of range, or two corners of every triangle are in one place.
    """

    __slots__ = ("_body",)

    _body: _native.Body

    def __init__(self, vertices: Any, triangles: npt.ArrayLike | None = None) -> None:
        _refuse_file(vertices, "vertices", "Mesh.read({})")
        if triangles is None:
            vertices, triangles = _faces(vertices)
        rows, image_size = _arrays.points(vertices, "vertices", of_image=False)
        if image_size is not None:
            raise ValueError("vertices has three dimensions: give (V, 3)")
        self._body = _native.mesh(rows, _arrays.indices(triangles, "triangles"))

    @classmethod
    def read(cls, path: str | os.PathLike[str], *, unit: str = "m") -> Mesh:
        """A mesh from a file: ``.stl``, ``.obj`` or ``.ply``, in ``"m"``, ``"cm"``, ``"mm"`` or ``"in"``.

        Raises
        ------
        CloudtouchError
            The file cannot be read, is malformed or has another extension, with place and remedy.
        """
        vertices, triangles = _native.read_mesh(_given.file(path, "path"), _given.text(unit, "unit"))
        with _naming(path):
            return cls(vertices, triangles)

    @classmethod
    def _prepared(cls, body: _native.Body) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._body = body
        return mesh

    @property
    def vertices(self) -> npt.NDArray[np.float64]:
        """(V, 3): the vertices after merging equal ones, m."""
        return self._body.points()

    @property
    def triangles(self) -> npt.NDArray[np.int64]:
        """(M, 3): the triangles after merging."""
        return self._body.triangles()

    @property
    def is_watertight(self) -> bool:
        """Whether it encloses a volume: only then has it an inside."""
        return self._body.is_watertight()

    @property
    def prepare_seconds(self) -> float:
        """How long preparation took."""
        return self._body.prepare_seconds()

    def __len__(self) -> int:
        """How many triangles are left after merging."""
        return self._body.count()

    def __repr__(self) -> str:
        kind = "watertight" if self.is_watertight else "open"
        return f"<Mesh: {len(self)} triangles, {kind}, {_extent(self.vertices)}>"

    def __getstate__(self) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
        vertices = self._body.given_points()
        assert vertices is not None, "a mesh does not change"
        return vertices, self._body.given_triangles()

    def __setstate__(self, state: tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]) -> None:
        vertices, triangles = state
        self._body = _native.mesh(vertices, _arrays.indices(triangles, "triangles"))


def native_body(body: Any, name: str) -> _native.Body:
    """What the compiled half knows of a body; ``name`` is that of the argument."""
    if not isinstance(body, (Cloud, Mesh)):
        kind = type(body).__name__
        raise TypeError(f"{name} is of the type {kind}: give a cloudtouch.Cloud or a cloudtouch.Mesh")
    return body._body


def native_pair(a: Any, b: Any) -> tuple[_native.Body, _native.Body]:
    """The same of both bodies of a query."""
    return native_body(a, "a"), native_body(b, "b")


def check_sensor(sensor: Any, name: str) -> None:
    """Refuses what is no sensor, by the name of the argument."""
    if not isinstance(sensor, str):
        said = f"{sensor:g}" if isinstance(sensor, (int, float)) else type(sensor).__name__
        example = f"iso:{said}" if isinstance(sensor, (int, float)) else "iso:0.002"
        raise TypeError(
            f'{name} is {said}: give a str that says what measured the points, such as "kinect", or "{example}" for '
            "that standard deviation, m, in every direction"
        )
    _native.check_sensor(sensor, name)


def _scan(
    points: Any,
    *,
    sensor: str,
    sensor_pose: npt.ArrayLike | None = None,
    covariances: npt.ArrayLike | None = None,
    normals: npt.ArrayLike | None = None,
    min_range: float | None = None,
    max_range: float | None = None,
    keep_veil: bool = False,
    outliers: tuple[int, float] | None = None,
    collision_map: float | None = None,
    robot: Iterable[SeenLink] = (),
    refined: bool = False,
) -> tuple[npt.NDArray[Any], dict[str, Any]]:
    """Rows of points, and everything else that a cloud is made of, by its name."""
    _refuse_file(points, "points", "Cloud.read({}, sensor=...)")
    if not isinstance(points, np.ndarray) and hasattr(points, "points"):
        points = _of_cloud(points)
    elif hasattr(points, "vertices"):
        # Of a mesh they would be few of its points, and nothing between them.
        kind = type(points).__name__
        raise TypeError(f"points is of the type {kind}: give its .vertices for a cloud, or Mesh({kind}) for a mesh")
    check_sensor(sensor, "sensor")
    rows, image_size = _arrays.points(points, "points")
    count = len(rows)

    def optional(value: npt.ArrayLike | None, name: str, *shape: int) -> Any:
        # A copy: pickling must not see what its owner does to it later.
        return None if value is None else _arrays.numbers(value, name, shape).copy()

    noise = optional(covariances, "covariances", count, 3, 3)
    if noise is not None and sensor.strip() != "per-point":
        raise ValueError(
            f'covariances are given, and the sensor {sensor!r} does not use them: give sensor="per-point", or leave them out'
        )
    return rows, {
        "sensor": sensor,
        "sensor_pose": optional(sensor_pose, "sensor_pose", 4, 4),
        "image_size": image_size,
        "covariances": noise,
        "normals": optional(normals, "normals", count, 3),
        "min_range": _given.optional_number(min_range, "min_range"),
        "max_range": _given.optional_number(max_range, "max_range"),
        "keep_veil": _given.flag(keep_veil, "keep_veil"),
        "outliers": _given.count_and_number(outliers, "outliers"),
        "collision_map": _given.optional_number(collision_map, "collision_map"),
        "robot": [replace(link, pose=optional(link.pose, "robot", 4, 4)) for link in _links(robot)],
        "refined": _given.flag(refined, "refined"),
    }


def _of_cloud(source: Any) -> Any:
    """Its points, where they are not those of a mesh: they would be few, and nothing between them."""
    for name in ("faces", "triangles", "cells"):
        faces: Any = getattr(source, name, None)
        if isinstance(faces, Sized) and len(faces):
            raise TypeError(
                f"points is of the type {type(source).__name__}, which has .{name}: give its .points for a cloud, or Mesh(its "
                "vertices, its triangles) for a mesh"
            )
    return source.points


def _links(robot: Any) -> list[SeenLink]:
    try:
        links = list(robot)
    except TypeError:
        links = [robot]
    for link in links:
        if not isinstance(link, SeenLink):
            raise TypeError(f"robot has a {type(link).__name__}: give what Robot.seen returns, or a list of SeenLink")
        if not isinstance(link.mesh, Mesh):
            raise TypeError(f"robot has a link of the type {type(link.mesh).__name__}: give a cloudtouch.Mesh")
        _given.number(link.padding, "robot: padding")
    return links


@contextlib.contextmanager
def _naming(path: str | os.PathLike[str]) -> Iterator[None]:
    """What is found of a file once it is read names it too."""
    try:
        yield
    except _native.CloudtouchError as error:
        raise _native.CloudtouchError(f"{os.fspath(path)}: {error}") from None


def _told(arguments: dict[str, Any]) -> dict[str, Any]:
    """As the compiled half takes them."""
    return {**arguments, "robot": [(link.mesh._body, link.pose, link.padding) for link in arguments["robot"]]}


def _refuse_file(value: Any, name: str, instead: str) -> None:
    if isinstance(value, (str, bytes, os.PathLike)):
        path = os.fspath(value)
        raise TypeError(f"{name} is {path!r}, the name of a file: give arrays, or call {instead.format(repr(path))}")


def _faces(source: Any) -> tuple[Any, Any]:
    # ``triangles`` of a trimesh are the corners themselves, not indices.
    faces = getattr(source, "faces", None)
    if faces is None:
        faces = getattr(source, "triangles", None)
    if faces is None or not hasattr(source, "vertices"):
        name = type(source).__name__
        raise TypeError(f"{name} has no .vertices with .faces or .triangles: give vertices and triangles")
    return source.vertices, faces


def _extent(points: npt.NDArray[np.float64]) -> str:
    low, high = points.min(axis=0), points.max(axis=0)
    size = " x ".join(f"{side:.3g}" for side in high - low)
    return f"{size} m about ({', '.join(f'{middle:.3g}' for middle in (low + high) / 2)})"

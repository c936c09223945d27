"""Robots from URDF in what a camera saw: which link touches what."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
import numpy.typing as npt

from cloudtouch import _arrays, _given, _native
from cloudtouch.bodies import Mesh, SeenLink, native_body
from cloudtouch.page import Page
from cloudtouch.query import Body, Query, native_query
from cloudtouch.report import Floats, Verdict
from cloudtouch.scene import Checked, PairAnswer

#: Positions of joints: by name, as in a row of a pandas table, or (J,) in the order of ``Robot.moving``; rad, and m
#: for those that slide.
Positions = Union[Mapping[str, float], npt.ArrayLike]


@dataclass(frozen=True)
class Joint:
    """A joint of a robot: what moves a link against another."""

    name: str
    """Its name in the URDF."""
    kind: str
    """``"fixed"``; ``"revolute"`` or ``"continuous"``, where it turns between limits or without; ``"prismatic"``, where it
    slides."""
    limits: Optional[tuple[float, float]]
    """Lower and upper, rad or m; ``None`` for continuous and fixed joints."""
    mimics: Optional[tuple[str, float, float]]
    """Name of the joint it follows, at so many times its position and an offset; ``None`` where it moves by itself."""


class Robot:
    """A robot read from a URDF, with the ``<collision>`` geometry of its links. Immutable; it does not pickle.

    Meshes and boxes are exact; cylinders, capsules and spheres are closed meshes about them, larger by at most 0.25 % of
    the radius. A link without ``<collision>`` is not there for any query: :attr:`unchecked_links` names those.

    Parameters
    ----------
    urdf
        The file; its meshes are ``.stl``, ``.obj`` or ``.ply``.
    packages
        Folders of ``package://`` by name. Those that hold the URDF, or lie beside a folder that does, are found without.
    srdf
        File whose disabled pairs of links may touch.

    Raises
    ------
    CloudtouchError
        A file is missing or malformed, a number is none, links are no tree, or a mesh is of a size that cannot be meant.
    """

    __slots__ = ("_robot",)

    _robot: _native.Robot

    def __init__(
        self,
        urdf: str | os.PathLike[str],
        *,
        packages: Mapping[str, str | os.PathLike[str]] | None = None,
        srdf: str | os.PathLike[str] | None = None,
    ) -> None:
        described = None if srdf is None else _given.file(srdf, "srdf")
        self._robot = _native.Robot(_given.file(urdf, "urdf"), _given.folders(packages, "packages"), described)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """All joints, from the base outwards."""
        return tuple(
            Joint(name, kind, None if limits is None else (limits[0], limits[1]), mimics)
            for name, kind, limits, mimics in self._robot.joints()
        )

    @property
    def moving(self) -> tuple[str, ...]:
        """The joints that move by themselves, from the base outwards: a position is needed of each."""
        return tuple(joint.name for joint in self.joints if joint.kind != "fixed" and joint.mimics is None)

    @property
    def links(self) -> tuple[str, ...]:
        """All links, in the order of the URDF."""
        return tuple(self._robot.links())

    @property
    def unchecked_links(self) -> tuple[str, ...]:
        """Links that can be seen and have no ``<collision>`` geometry: no query knows of them."""
        return tuple(self._robot.unchecked_links())

    @property
    def unknown_links(self) -> tuple[str, ...]:
        """Links that the SRDF disables and the robot lacks: of another variant, or misspelt, so that what was meant is
        checked."""
        return tuple(self._robot.unknown_links())

    def may_touch(self, a: str, b: str) -> bool:
        """Whether two links may touch: neighbours, those that never move against one another, and those of the SRDF.

        Raises
        ------
        CloudtouchError
            The robot has no link of one of these names.
        """
        return self._robot.may_touch(_given.text(a, "a"), _given.text(b, "b"))

    def link_poses(self, joints: Positions) -> dict[str, Floats]:
        """(4, 4) of each link by its name: from its frame into that of the base, m.

        Parameters
        ----------
        joints
            By name, as in a row of a pandas table, or (J,) in the order of :attr:`moving`; rad or m.

        Raises
        ------
        ValueError
            ``joints`` has the wrong shape or type.
        CloudtouchError
            A joint is unknown, left out, not finite or beyond its limits.
        """
        return dict(self._robot.link_poses(self._named(joints, "joints")))

    def seen(
        self, joints: Positions, base_pose: npt.ArrayLike | None = None, *, padding: float = 0.01
    ) -> tuple[SeenLink, ...]:
        """The links where a camera saw them, for ``Cloud(..., robot=...)``, which removes their points.

        Parameters
        ----------
        joints
            Those *when the points were measured*: at those asked about, what is in the way would be removed.
        base_pose
            (4, 4): from the base of the robot into the frame of the points, m; the identity where it is not given.
        padding
            Points this near to a link, m, are taken for it too: more than the noise and the error of the joints.

        Raises
        ------
        ValueError, CloudtouchError
            As :meth:`link_poses`, and where ``padding`` is negative or not finite.
        """
        padding = _given.number(padding, "padding")
        if not 0 <= padding < math.inf:
            raise ValueError(f"padding is {padding:g}: give metres, 0 or more")
        links = self._robot.seen(self._named(joints, "joints"), _base(base_pose))
        return tuple(SeenLink(Mesh._prepared(body), pose, padding) for body, pose in links)

    def _named(self, value: Positions, name: str) -> dict[str, float]:
        value = _arrays.by_name(value)
        if isinstance(value, Mapping):
            numbers = _arrays.numbers(list(value.values()), name, (len(value),)) if value else np.empty(0)
            return dict(zip(map(str, value), numbers.tolist()))
        moving = self.moving
        return dict(zip(moving, _arrays.numbers(value, name, (len(moving),)).tolist()))

    def __repr__(self) -> str:
        return f"<Robot: {len(self.links)} links, moved by {', '.join(self.moving) or 'nothing'}>"

    def __reduce__(self) -> Any:
        raise TypeError("a robot does not pickle: read its URDF where it is needed")


@dataclass(frozen=True, eq=False)
class Stopped:
    """Where a path is not known to be free any more."""

    segment: int
    """From which of the positions given, counted from 0, to the next."""
    t: float
    """Time in the segment, from 0 to 1."""
    pair: Optional[PairAnswer]
    """The worst pair there; ``None`` where all are free, but too near for positions around to be known to be."""
    nearest: Optional[tuple[str, str, float]]
    """Then the pair that is least sure around there, and the most that its probability may be."""


@dataclass(frozen=True, eq=False)
class PathChecked:
    """What is known of a robot along a path of its joints."""

    given: tuple[Checked, ...]
    """What is found at each of the positions given."""
    certified_free_until: float
    """Share of the path up to which every position is free, those between the given ones too."""
    stopped: Optional[Stopped]
    """What is there; ``None`` where that is the end."""
    later: Optional[Stopped]
    """The first collision found beyond, of sixteen positions in each segment, where none was found so far."""
    looked_at: int
    """How many positions were asked about."""
    verdict: Verdict
    """``"free"`` where the whole path is; ``"undecided"`` where no pair was checked; else the worst that was found."""


class RobotChecker:
    """A robot in its surroundings, asked about positions of its joints, on all cores.

    ``copy.copy`` makes another in the same surroundings, which allows and holds what it will by itself. It does not pickle.

    Parameters
    ----------
    robot
        The robot; several checkers may share it.
    surroundings
        A cloud or a mesh. A cloud that is changed later is seen as it then is. A scan that shows the robot itself is made
        with ``Cloud(..., robot=robot.seen(...))``.
    base_pose
        (4, 4): from the base of the robot into the frame of the surroundings, m; the identity where it is not given.
    self_collision
        Whether links are asked about one another too, but those that :meth:`Robot.may_touch`.

    Raises
    ------
    ValueError
        ``base_pose`` has the wrong shape or type.
    CloudtouchError
        ``base_pose`` is no rigid motion, or a link is called ``surroundings``.
    """

    __slots__ = ("_checker", "_robot")

    _checker: _native.RobotChecker
    _robot: Robot

    def __init__(
        self,
        robot: Robot,
        surroundings: Body,
        base_pose: npt.ArrayLike | None = None,
        *,
        self_collision: bool = False,
    ) -> None:
        if not isinstance(robot, Robot):
            raise TypeError(f"robot is {_given.told(robot)}: give a cloudtouch.Robot")
        self._robot = robot
        body = native_body(surroundings, "surroundings")
        with_itself = _given.flag(self_collision, "self_collision")
        self._checker = _native.RobotChecker(robot._robot, body, _base(base_pose), with_itself)

    @property
    def robot(self) -> Robot:
        """The robot."""
        return self._robot

    def allow(self, a: str, b: str = "surroundings") -> None:
        """Say that two may touch, each a link, what is held, or the surroundings: they are not asked about.

        A base that is bolted to its table, or that no camera sees around; a finger and what it holds.

        Raises
        ------
        CloudtouchError
            One of them has no shape that is checked.
        """
        self._checker.allow(_given.text(a, "a"), _given.text(b, "b"))

    def hold(self, name: str, body: Body, link: str, link_from_body: npt.ArrayLike | None = None) -> None:
        """Have a link hold a body, as it is now: it moves with the link from then on, along paths too.

        It is asked about as the links are, but beside the one that holds it. The surroundings must not hold it any
        more. With ``self_collision`` fingers that touch it have to be allowed (:meth:`allow`).

        Parameters
        ----------
        link_from_body
            (4, 4): from the frame of the body into that of the link, m; the identity where it is not given.

        Raises
        ------
        ValueError
            ``link_from_body`` has the wrong shape or type.
        CloudtouchError
            No link has that name, something else has the name of the body, or the pose is no rigid motion.
        """
        pose = np.eye(4) if link_from_body is None else _arrays.numbers(link_from_body, "link_from_body", (4, 4))
        names = _given.text(name, "name"), _given.text(link, "link")
        self._checker.hold(names[0], native_body(body, "body"), names[1], pose)

    def release(self, name: str) -> None:
        """Let go of a body that is held.

        Raises
        ------
        CloudtouchError
            Nothing of that name is held.
        """
        self._checker.release(_given.text(name, "name"))

    def boxes(self, joints: Positions) -> dict[str, Floats]:
        """Where the surroundings, each link and what is held are, to see whether the base is where you meant.

        (2, 3) for each name: lowest and highest corner along the axes of the surroundings, m, never too small.

        Raises
        ------
        ValueError, CloudtouchError
            As :meth:`check`.
        """
        return _arrays.boxes(self._checker.boxes(self._robot._named(joints, "joints")))

    def check(self, query: Query, joints: Positions) -> Checked:
        """All pairs that do not read as free, the worst first; the scan is called ``"surroundings"``.

        Contacts are in the frame of the surroundings. A link with several shapes has a number from 0 behind its name.

        Parameters
        ----------
        joints
            By name, or (J,) in the order of :attr:`Robot.moving`; rad or m.

        Raises
        ------
        ValueError
            ``joints`` has the wrong shape or type.
        CloudtouchError
            A joint is unknown, left out, not finite or beyond its limits.
        """
        return Checked._of(*self._checker.check(native_query(query), self._robot._named(joints, "joints")))

    def is_free(self, query: Query, joints: Positions) -> bool:
        """Whether :meth:`check` would find all free, and no more: sooner known, for planners.

        Raises
        ------
        ValueError
            ``joints`` has the wrong shape or type.
        CloudtouchError
            As :meth:`check`.
        """
        return self._checker.is_free(native_query(query), self._robot._named(joints, "joints"))

    def page(self, query: Query, joints: Positions, *, title: str = "cloudtouch") -> Page:
        """The robot in its surroundings and what :meth:`check` finds, as by :meth:`Scene.page`.

        Raises
        ------
        ValueError
            ``joints`` has the wrong shape or type.
        CloudtouchError
            As :meth:`check`, when the page is shown or written.
        """
        named = self._robot._named(joints, "joints")
        asked, words = native_query(query), _given.text(title, "title")
        return Page(lambda height: self._checker.page(asked, named, words, height))

    def check_path(self, query: Query, path: Iterable[Positions], *, tolerance: float = 0.001) -> PathChecked:
        """How far along a path every position is free, nothing between those given left out.

        Between two positions each joint moves straight from one value to the other.

        Parameters
        ----------
        path
            (M, J), or positions by name, at least two; or a table of pandas with a column for each joint.
        tolerance
            How finely it is looked at, as a share of the path.

        Raises
        ------
        ValueError
            A position has the wrong shape or type.
        CloudtouchError
            There are fewer than two, ``tolerance`` is below 1e-5 or above 1, or as :meth:`check`.
        """
        asked, rows = native_query(query), _arrays.rows_of(path)
        if isinstance(rows, (str, bytes, Mapping)) or not isinstance(rows, Iterable):
            raise TypeError(f"path is {_given.told(rows)}: give (M, J), or a list of positions")
        tolerance = _given.number(tolerance, "tolerance")
        positions = [self._robot._named(joints, f"path[{index}]") for index, joints in enumerate(rows)]
        given, until, (stopped, later), looked_at, verdict = self._checker.check_path(asked, positions, tolerance)
        checked = tuple(Checked._of(*at) for at in given)
        return PathChecked(checked, until, _place(stopped), _place(later), looked_at, verdict)

    def __repr__(self) -> str:
        return f"<RobotChecker of {self._robot!r}>"

    def __copy__(self) -> RobotChecker:
        other = _given.same_kind(self)
        other._robot, other._checker = self._robot, self._checker.copied()
        return other

    def __reduce__(self) -> Any:
        raise TypeError("a robot checker does not pickle: make it where it is needed (copy.copy makes one beside it)")


def _place(found: _native.Place | None) -> Stopped | None:
    if found is None:
        return None
    segment, t, pair, nearest = found
    return Stopped(segment, t, None if pair is None else PairAnswer._of(pair), nearest)


def _base(pose: npt.ArrayLike | None) -> Floats:
    return np.eye(4) if pose is None else _arrays.numbers(pose, "base_pose", (4, 4))

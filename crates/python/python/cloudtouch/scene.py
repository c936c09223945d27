"""Many bodies: which of them may touch."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

from cloudtouch import _arrays, _given, _native
from cloudtouch.bodies import native_body
from cloudtouch.page import Page
from cloudtouch.query import Body, Query, native_query
from cloudtouch.report import Floats, Report, Verdict


@dataclass(frozen=True, eq=False)
class PairAnswer:
    """Two bodies of a scene that do not read as free."""

    a: str
    """Name of the larger."""
    b: str
    """Name of the other."""
    report: Optional[Report]
    """Their report, with contacts in the frame of the scene; ``None`` where there is no answer, which is not free."""
    error: Optional[str]
    """Why there is none."""

    @property
    def verdict(self) -> Verdict:
        """That of the report; ``"undecided"`` without one."""
        return "undecided" if self.report is None else self.report.verdict

    @classmethod
    def _of(cls, told: tuple[str, str, dict[str, Any] | None, str | None]) -> PairAnswer:
        a, b, report, error = told
        return cls(a, b, None if report is None else Report._of(report), error)

    def __repr__(self) -> str:
        return f"<PairAnswer: {self.a!r} and {self.b!r}, {self.error or self.report}>"


class Outside(NamedTuple):
    """A body of a scene that, alone or with others, is far from the rest."""

    name: str
    """Its name."""
    gap_m: float
    """Between its box and that around all others, m."""
    size_m: float
    """Diagonal of the larger of the two, m."""


class BodyWarning(NamedTuple):
    """What is to be said of a body of a scene by itself."""

    name: str
    """Its name."""
    words: str
    """A sentence, with a remedy; "the scene" in it is this body."""


@dataclass(frozen=True, eq=False)
class Checked:
    """What is found of all pairs of bodies of a scene."""

    pairs: tuple[PairAnswer, ...]
    """All that do not read as free, the worst first."""
    count: int
    """Pairs of bodies in the scene."""
    allowed: int
    """Of these, pairs that may touch."""
    ruled_out: int
    """Pairs known to be free by their boxes alone."""
    asked: int
    """Pairs that were asked about."""
    unchecked: tuple[str, ...]
    """Bodies of which no pair was checked: all they could be in may touch. The verdict is of the others."""
    outside: tuple[Outside, ...]
    """Bodies farther from the rest than either is large: free, but perhaps by a pose in another unit."""
    warnings: tuple[BodyWarning, ...]
    """What is to be said of bodies by themselves, whatever the verdict, such as a scan that does not show its robot."""

    @property
    def verdict(self) -> Verdict:
        """The worst of any pair; ``"undecided"`` where none was checked, for all may touch or there are fewer than two bodies."""
        if self.pairs:
            return self.pairs[0].verdict
        return "undecided" if self.allowed == self.count else "free"

    @classmethod
    def _of(
        cls,
        pairs: list[tuple[str, str, dict[str, Any] | None, str | None]],
        counts: list[int],
        unchecked: list[str],
        outside: list[tuple[str, float, float]],
        warnings: list[tuple[str, str]],
    ) -> Checked:
        count, allowed, ruled_out, asked = counts
        far = tuple(Outside(*of) for of in outside)
        told = tuple(BodyWarning(*of) for of in warnings)
        found = tuple(map(PairAnswer._of, pairs))
        return cls(found, count, allowed, ruled_out, asked, tuple(unchecked), far, told)


class Scene:
    """Named bodies, each with a pose; bodies may be attached to others, and pairs may be allowed to touch.

    Moving a body costs nothing, and a cloud that is changed is seen as it then is. Poses are (4, 4), from the frame of the
    body into that of the scene, or of what it is attached to, m. Names that are not there, or there already, are a :class:`CloudtouchError`.

    ``copy.copy`` makes a scene to try things in: it has the same bodies, and what is moved, added or allowed in one of the
    two is not in the other. Scenes do not pickle.
    """

    __slots__ = ("_scene",)

    _scene: _native.Scene

    def __init__(self) -> None:
        self._scene = _native.Scene()

    def add(self, name: str, body: Body, pose: npt.ArrayLike | None = None) -> None:
        """Adds a body; at the origin where no pose is given."""
        self._scene.add(_given.text(name, "name"), native_body(body, "body"), _matrix(pose))

    def replace(self, name: str, body: Body) -> None:
        """Puts another body in the place of one, such as a new scan of the same thing."""
        self._scene.replace(_given.text(name, "name"), native_body(body, "body"))

    def remove(self, name: str) -> None:
        """Removes a body that no other is attached to."""
        self._scene.remove(_given.text(name, "name"))

    def set_pose(self, name: str, pose: npt.ArrayLike) -> None:
        """Moves a body, and what is attached to it."""
        self._scene.set_pose(_given.text(name, "name"), _arrays.numbers(pose, "pose", (4, 4)))

    def attach(self, name: str, to: str) -> None:
        """From now on the first moves with the second, from where both are."""
        self._scene.attach(_given.text(name, "name"), _given.text(to, "to"))

    def detach(self, name: str) -> None:
        """It stays where it is, and moves by itself."""
        self._scene.detach(_given.text(name, "name"))

    def allow(self, a: str, b: str, may_touch: bool = True) -> None:
        """Whether two bodies may touch: such pairs are not asked about."""
        names = _given.text(a, "a"), _given.text(b, "b")
        self._scene.allow(*names, _given.flag(may_touch, "may_touch"))

    @property
    def names(self) -> list[str]:
        """Of all bodies, in order."""
        return self._scene.names()

    def boxes(self) -> dict[str, Floats]:
        """Where bodies are, to see whether the poses are those you meant.

        (2, 3) for each name: lowest and highest corner along the axes of the scene, m, of its own box turned by the
        pose, and so never too small.
        """
        return _arrays.boxes(self._scene.boxes())

    def check(self, query: Query) -> Checked:
        """All pairs that do not read as free, the worst first, on all cores."""
        return Checked._of(*self._scene.check(native_query(query)))

    def check_first(self, query: Query) -> PairAnswer | None:
        """One pair that does not read as free, or ``None`` where all do: sooner known.

        ``None`` also where no pair was asked about, which :meth:`check` and :meth:`is_free` do not call free.
        """
        found = self._scene.check_first(native_query(query))
        return None if found is None else PairAnswer._of(found)

    def is_free(self, query: Query) -> bool:
        """Whether :meth:`check` would find all free, and no more: sooner known, for planners."""
        return self._scene.is_free(native_query(query))

    def page(self, query: Query, *, title: str = "cloudtouch") -> Page:
        """All bodies and what :meth:`check` finds, to look at: a notebook shows it, :meth:`Page.save` writes it."""
        asked, words = native_query(query), _given.text(title, "title")
        return Page(lambda height: self._scene.page(asked, words, height))

    def __copy__(self) -> Scene:
        other = _given.same_kind(self)
        other._scene = self._scene.copied()
        return other

    def __reduce__(self) -> Any:
        raise TypeError("a scene does not pickle: add its bodies where it is needed (copy.copy makes one that shares them)")

    def __len__(self) -> int:
        """How many bodies there are."""
        return len(self.names)

    def __repr__(self) -> str:
        return f"<Scene: {', '.join(self.names) or 'empty'}>"


def _matrix(pose: npt.ArrayLike | None) -> npt.NDArray[np.float64]:
    return np.eye(4) if pose is None else _arrays.numbers(pose, "pose", (4, 4))

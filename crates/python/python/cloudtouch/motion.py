"""Answers about more than one pose. Plain data, as reports are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from cloudtouch.report import Floats, Report, Verdict


@dataclass(frozen=True)
class UnderPoses:
    """How likely a collision is over all the poses that may be."""

    probability: float
    """Mean collision probability of the poses."""
    lower: float
    """Mean of their lower bounds."""
    upper: float
    """Mean of their upper bounds."""
    std_error: float
    """The standard error that as many poses drawn at random would leave."""
    poses: int
    """How many poses were asked about."""

    @property
    def bounds(self) -> tuple[float, float]:
        """``(lower, upper)``."""
        return self.lower, self.upper


@dataclass(frozen=True, eq=False)
class Gradient:
    """What an answer changes by with the pose: for a metre along and a radian about the axes of B, in its own frame."""

    probability: Floats
    """(6,): of the collision probability; translation x, y, z, then rotation x, y, z."""
    log_odds: Floats
    """(6,): of ln(P / (1 - P)), which goes on changing where the probability is all but 0 or 1."""
    clearance: Optional[Floats]
    """(6,): of the clearance, where there is one."""


@dataclass(frozen=True, eq=False)
class Penetration:
    """The least translation of B that was found to end a collision."""

    direction: Floats
    """(3,): where to, a unit vector in the frame of A; zero where B need not move."""
    distance: float
    """How far, until a collision is less likely than asked for, m."""
    depth: float
    """How far, until it is as likely as not: how deep B is in, m."""
    std: float
    """What the surfaces leave open of the depth along its own way, m."""


@dataclass(frozen=True, eq=False)
class AlongPath:
    """A pose of a path that was asked about."""

    segment: int
    """From which pose of the path, counted from 0, to the next."""
    t: float
    """Time in the segment, from 0 to 1."""
    share: float
    """The same as a share of the whole path, every segment having the same part."""
    pose: Floats
    """(4, 4): from the frame of B into that of A, m."""
    report: Report
    """The whole answer there."""

    @classmethod
    def _of(cls, told: dict[str, Any]) -> AlongPath:
        told["report"] = Report._of(told["report"])
        return cls(**told)


@dataclass(frozen=True, eq=False)
class Swept:
    """How likely two bodies collide along a path."""

    lower: float
    """The largest probability of any pose of the path is not below this ..."""
    upper: float
    """... and not above this, those between the given ones included."""
    verdict: Verdict
    """``"free"``: every pose is, for certain. ``"in_collision"``: some pose is. Else as of a :class:`Report`."""
    undecided_by: Optional[str]
    """Why it is undecided: the doubt about the earliest pose that there is one about."""
    warnings: tuple[str, ...]
    """Signs of a slip, each kind once, as of the earliest pose."""
    most_probable: AlongPath
    """The most probable of the poses asked about."""
    first: Optional[AlongPath]
    """The earliest pose found above ``accept``; ``None`` where none was."""
    first_not_before: Optional[float]
    """No pose before this share of the path is above ``accept``; ``None`` without ``first``."""
    certified_free_until: float
    """Up to this share of the path every pose is free for certain."""
    poses: int
    """How many poses were asked about."""
    seconds: float
    """How long it took, s."""

    @property
    def probability(self) -> float:
        """The largest of the poses asked about."""
        return self.most_probable.report.probability

    @property
    def bounds(self) -> tuple[float, float]:
        """``(lower, upper)``."""
        return self.lower, self.upper

    @classmethod
    def _of(cls, told: dict[str, Any]) -> Swept:
        told["warnings"] = tuple(told["warnings"])
        told["most_probable"] = AlongPath._of(told["most_probable"])
        told["first"] = None if told["first"] is None else AlongPath._of(told["first"])
        return cls(**told)

    def __repr__(self) -> str:
        words = [self.verdict + (f" ({self.undecided_by})" if self.undecided_by else "")]
        words.append(f"P = {self.probability:.3g} in [{self.lower:.3g}, {self.upper:.3g}]")
        words.append(f"free until {self.certified_free_until:.3g} of the path")
        if self.first is not None:
            words.append(f"in collision from {self.first.share:.3g}")
        words.extend(f"warning: {warning}" for warning in self.warnings)
        return f"<Swept: {', '.join(words)}>"

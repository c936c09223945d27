"""Answers about more than one pose. Plain data, as reports are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

from cloudtouch.report import Floats, Report, Verdict


@dataclass(frozen=True)
class UnderPoses:
    """How likely a collision is over all the poses that may be."""

    #: Mean collision probability of the poses.
    probability: float
    #: Mean of their lower bounds.
    lower: float
    #: Mean of their upper bounds.
    upper: float
    #: The standard error that as many poses drawn at random would leave.
    std_error: float
    #: How many poses were asked about.
    poses: int

    @property
    def bounds(self) -> tuple[float, float]:
        """``(lower, upper)``."""
        return self.lower, self.upper


@dataclass(frozen=True, eq=False)
class AlongPath:
    """A pose of a path that was asked about."""

    #: From which pose of the path, counted from 0, to the next.
    segment: int
    #: Time in the segment, from 0 to 1.
    t: float
    #: The same as a share of the whole path, every segment having the same part.
    share: float
    #: (4, 4): from the frame of B into that of A, m.
    pose: Floats
    #: The whole answer there.
    report: Report

    @classmethod
    def _of(cls, told: dict[str, Any]) -> AlongPath:
        told["report"] = Report._of(told["report"])
        return cls(**told)


@dataclass(frozen=True, eq=False)
class Swept:
    """How likely two bodies collide along a path."""

    #: The largest probability of any pose of the path is not below this ...
    lower: float
    #: ... and not above this, those between the given ones included.
    upper: float
    #: ``"free"``: every pose is, for certain. ``"in_collision"``: some pose is. Else as of a :class:`Report`.
    verdict: Verdict
    #: Why it is undecided: the doubt about the earliest pose that there is one about.
    undecided_by: Optional[str]
    #: Signs of a slip, each kind once, as of the earliest pose.
    warnings: tuple[str, ...]
    #: The most probable of the poses asked about.
    most_probable: AlongPath
    #: The earliest pose found above ``accept``; ``None`` where none was.
    first: Optional[AlongPath]
    #: No pose before this share of the path is above ``accept``; ``None`` without ``first``.
    first_not_before: Optional[float]
    #: Up to this share of the path every pose is free for certain.
    certified_free_until: float
    #: How many poses were asked about.
    poses: int
    #: How long it took, s.
    seconds: float

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

"""Answers. Plain data: they pickle, and hold nothing of the bodies."""

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, Literal, NamedTuple, Optional

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Verdict = Literal["free", "uncertain", "in_collision", "undecided"]


class Contact(NamedTuple):
    """A place where the surfaces touch or may touch."""

    point: Floats
    """(3,): where, in the frame of A, m."""
    normal: Floats
    """(3,): unit normal, from A to B: push B along it to get it off."""
    probability: float
    """That the surfaces meet there; never above that of the collision."""
    clearance: float
    """Gap along the normal, m; negative in overlap."""
    area: Optional[float]
    """How much surface belongs to it, m^2, roughly."""


class Evidence(NamedTuple):
    """What a probability rests on; none of the numbers has a unit."""

    deviations: float
    """Least Mahalanobis distance between two pieces of surface, from 6 down to -6, deep inside of a mesh."""
    crossing: float
    """How clearly one surface passes through the other: ln(1 + s), s a sum of standard deviations."""
    extent: Optional[float]
    """Over how many pieces of surface the bodies are about as near as where they are nearest; ``None`` where that
    changes nothing."""
    misclassified: Optional[float]
    """Points expected on the wrong side of the best separating surface; ``None`` where there was no doubt."""
    noise_over_spacing: float
    """Noise over the spacing of the points, of both bodies together: what the rest is worth depends on it."""
    scatter_over_spacing: float
    """The same as far as the points scatter by the noise that is stated; what they do not show they share."""


class PointProbabilities(NamedTuple):
    """Points of a cloud that have a probability worth telling; all others have none."""

    indices: npt.NDArray[np.int64]
    """(K,): indices into ``Cloud.points``."""
    probabilities: Floats
    """(K,): that the surface there collides."""


@dataclass(frozen=True, eq=False, repr=False)
class Report:
    """The answer to one query."""

    probability: float
    """That the two underlying surfaces collide."""
    lower: float
    """Lower bound on it under the same model."""
    upper: float
    """Upper bound: what was left out, or not decided, raises it."""
    verdict: Verdict
    """``"free"``: the upper bound is below ``reject`` and nothing speaks against believing it. ``"uncertain"``:
    between the thresholds. ``"in_collision"``: above ``accept``. ``"undecided"``: cannot be told; treat it as not
    free."""
    undecided_by: Optional[str]
    """Why it is undecided: ``"unseen"``, ``"enclosed"``, ``"units"``, ``"sparse"``, ``"noise"``, ``"rounded"``,
    ``"no_surface"``, ``"missing"``, ``"sensor"``, ``"unsolved"`` or ``"bounds"``; ``None`` for every other verdict."""
    log_likelihood_ratio: Optional[float]
    """How many times as probable the evidence is in a collision as without one, as a logarithm; ``None`` between
    meshes."""
    clearance: Optional[float]
    """Expected gap where the surfaces are likeliest to touch, m, negative in overlap; ``None`` when nothing was near.
    """
    clearance_std: Optional[float]
    """Its standard deviation, m."""
    clearance_is_bound: bool
    """Whether the overlap may be deeper than ``clearance`` says."""
    clearance_at_least: Optional[float]
    """No sampled surface of one body is nearer to the other than this, m; ``None`` where they may touch, where the
    verdict is doubted, and between meshes, whose distance is ``clearance``."""
    unseen: Optional[float]
    """Share of a body's surface where the depth image of the other saw nothing, 0 to 1; ``None`` without such an
    image."""
    evidence: Optional[Evidence]
    """What the probability rests on; ``None`` between meshes."""
    warnings: tuple[str, ...]
    """Signs of a slip (a unit, a pose, a sensor that is hardly meant), each a sentence with a remedy."""
    points_a: PointProbabilities
    """Points of A with a probability of their own; empty for a mesh."""
    points_b: PointProbabilities
    """Points of B with a probability of their own; empty for a mesh."""
    seconds: float
    """How long the query took, s, in whole microseconds."""
    _contacts: Optional[tuple[Floats, Floats, Floats]] = None
    """Points, normals, and probability, clearance and area of the contacts, a row each."""

    @cached_property
    def contacts(self) -> tuple[Contact, ...]:
        """Where the surfaces touch or may touch, most probable first."""
        if self._contacts is None:
            return ()
        points, normals, numbers = self._contacts
        rows = zip(points, normals, numbers.tolist())
        # A number that is not one is not equal to itself.
        return tuple(Contact(p, n, at, gap, area if area == area else None) for p, n, (at, gap, area) in rows)

    @property
    def bounds(self) -> tuple[float, float]:
        """``(lower, upper)``."""
        return self.lower, self.upper

    @classmethod
    def _of(cls, told: dict[str, Any]) -> "Report":
        evidence = told["evidence"]
        told["evidence"] = None if evidence is None else Evidence(*evidence)
        told["warnings"] = tuple(told["warnings"])
        for side in ("points_a", "points_b"):
            found = told.get(side)
            told[side] = _no_points() if found is None else PointProbabilities(*found)
        # Not by the constructor: a frozen class sets its fields one by one, which takes longer than the rest.
        report = cls.__new__(cls)
        report.__dict__.update(told)
        return report

    def __repr__(self) -> str:
        words = [self.verdict + (f" ({self.undecided_by})" if self.undecided_by else "")]
        words.append(f"P = {self.probability:.3g} in [{self.lower:.3g}, {self.upper:.3g}]")
        if self.clearance is not None and self.clearance_std is not None:
            sign = "<= " if self.clearance_is_bound else ""
            gap, std = 1e3 * self.clearance, 1e3 * self.clearance_std
            words.append(f"clearance {sign}{gap:+.1f} +- {std:.1f} mm")
        count = len(self.contacts)
        words.append(f"{count} contact{'' if count == 1 else 's'}")
        words.extend(f"warning: {warning}" for warning in self.warnings)
        return f"<Report: {', '.join(words)}>"


@dataclass(frozen=True)
class Within:
    """How likely two surfaces are within a margin of each other."""

    margin: float
    """The margin, m."""
    probability: float
    """That the distance of the two surfaces is below it."""
    lower: float
    """Lower bound on that."""
    upper: float
    """Upper bound on that."""
    deviations: float
    """How many standard deviations the surfaces are from being within the margin, from 6 down to -6."""

    @property
    def bounds(self) -> tuple[float, float]:
        """``(lower, upper)``."""
        return self.lower, self.upper


@dataclass(frozen=True, eq=False, repr=False)
class Batch:
    """The answers to M poses, a row for each in their order; NaN where a report has ``None``."""

    probability: Floats
    """(M,): that the surfaces collide."""
    lower: Floats
    """(M,): lower bounds."""
    upper: Floats
    """(M,): upper bounds."""
    verdict: npt.NDArray[np.str_]
    """(M,): ``"free"``, ``"uncertain"``, ``"in_collision"`` or ``"undecided"``, as text; ``"error"`` for a pose that
    was refused."""
    undecided_by: npt.NDArray[np.str_]
    """(M,): why it is undecided, as text; empty for every other verdict."""
    log_likelihood_ratio: Floats
    """(M,): see :attr:`Report.log_likelihood_ratio`."""
    clearance: Floats
    """(M,): m, see :attr:`Report.clearance`."""
    clearance_std: Floats
    """(M,): m."""
    clearance_is_bound: npt.NDArray[np.bool_]
    """(M,): whether the overlap may be deeper."""
    clearance_at_least: Floats
    """(M,): m, see :attr:`Report.clearance_at_least`."""
    contact_point: Floats
    """(M, 3): the likeliest contact, in the frame of A, m."""
    contact_normal: Floats
    """(M, 3): its unit normal, from A to B."""
    contact_count: npt.NDArray[np.int64]
    """(M,): how many contacts there are."""
    warning_count: npt.NDArray[np.int64]
    """(M,): how many warnings there are."""
    warnings: npt.NDArray[np.str_]
    """(M,): their codes, with commas between them, as text; :meth:`Query.run` says more."""
    seconds: Floats
    """(M,): how long each query took on its thread, s."""
    error: npt.NDArray[np.str_]
    """(M,): why a pose was refused, as text; empty for every answer."""

    def columns(self) -> dict[str, npt.NDArray[Any]]:
        """Every column by its name, for a table."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @classmethod
    def _of(cls, told: dict[str, Any]) -> "Batch":
        texts = {name: np.asarray(told[name], dtype=np.str_) for name in ("warnings", "error")}
        return cls(**{**told, **texts})

    def __len__(self) -> int:
        return len(self.probability)

    def __repr__(self) -> str:
        verdicts = _counted(self.verdict)
        codes = [code for codes in self.warnings.tolist() if codes for code in codes.split(",")]
        warned = _counted(codes)
        found = f"{': ' if verdicts else ''}{verdicts}{'; warnings: ' if warned else ''}{warned}"
        return f"<Batch: {len(self)} poses{found}>"


def _counted(names: npt.ArrayLike) -> str:
    found, counts = np.unique(names, return_counts=True)
    return ", ".join(f"{count} {name}" for name, count in zip(found, counts))


def _no_points() -> PointProbabilities:
    return PointProbabilities(np.empty(0, dtype=np.int64), np.empty(0))

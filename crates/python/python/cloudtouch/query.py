"""Queries: two bodies and a pose in, a probability out."""

from __future__ import annotations

from typing import Any, Literal, Union

import numpy as np
import numpy.typing as npt

from cloudtouch import _arrays, _given, _native
from cloudtouch.bodies import Cloud, Mesh, native_pair
from cloudtouch.motion import Gradient, Penetration, Swept, UnderPoses
from cloudtouch.page import Page
from cloudtouch.report import Batch, Report, Within

Body = Union[Cloud, Mesh]

#: More than any clock counts; the compiled half takes twice as many.
MOST_SECONDS = 2.0**63


class Query:
    """Settings, checked; cheap to make, immutable, and shared by threads.

    Parameters
    ----------
    accept, reject
        Above ``accept`` a pair is in collision, with an upper bound below ``reject`` it is free. If a collision costs C
        and a good pose refused costs 1, ``reject = 1 / (1 + C)``.
    prior
        Which share of the poses asked about collides, before anything is known of them: between 0 and 1.
    max_unseen
        Share of a body's surface that may lie where a depth image saw nothing, 0 to 1; beyond, nothing is free. Of what
        is less than 3 cm behind what it saw, and may be inside it, a tenth of that. 1 takes the unseen for empty.
    max_missing
        Share of the rows of a cloud without image layout that may have no return, 0 to 1.
    doubt_units
        Whether sizes and distances that cannot be meant make a pair undecided.
    stop_above
        The search ends when a collision is this certain; 1 never ends it early.
    deadline
        How long a query may search, s; ``None`` for as long as it takes. What that cuts short is never free.
    max_contacts
        How many contacts are reported at most.

    Raises
    ------
    CloudtouchError
        A setting is out of range.
    """

    __slots__ = ("_query", "_settings")

    _query: _native.Query
    _settings: dict[str, Any]

    def __init__(
        self,
        *,
        accept: float = 0.9,
        reject: float = 0.1,
        prior: float = 0.5,
        max_unseen: float = 0.02,
        max_missing: float = 0.25,
        doubt_units: bool = True,
        stop_above: float = 0.999,
        deadline: float | None = None,
        max_contacts: int = 16,
    ) -> None:
        self._set(
            {
                "accept": _given.number(accept, "accept"),
                "reject": _given.number(reject, "reject"),
                "prior": _given.number(prior, "prior"),
                "max_unseen": _given.number(max_unseen, "max_unseen"),
                "max_missing": _given.number(max_missing, "max_missing"),
                "doubt_units": _given.flag(doubt_units, "doubt_units"),
                "stop_above": _given.number(stop_above, "stop_above"),
                "deadline": _seconds(deadline, "deadline"),
                "max_contacts": _given.count(max_contacts, "max_contacts"),
            }
        )

    def _set(self, settings: dict[str, Any]) -> None:
        self._settings = settings
        self._query = _native.Query(*settings.values())

    @property
    def settings(self) -> dict[str, Any]:
        """All settings by name, as ``Query(**settings)`` takes them."""
        return dict(self._settings)

    def run(self, a: Body, b: Body, pose: npt.ArrayLike) -> Report:
        """How likely it is that the surfaces behind two bodies collide.

        Parameters
        ----------
        a, b
            The scene and the object, as a rule; either may be a cloud or a mesh.
        pose
            (4, 4): from the frame of ``b`` into that of ``a``, m.

        Raises
        ------
        ValueError
            ``pose`` has the wrong shape or type.
        CloudtouchError
            ``pose`` is no rigid motion, or the meshes cannot be tested against each other. A pair that could not be
            decided is no error but a verdict, and never reads as free.
        """
        return Report._of(self._query.run(*native_pair(a, b), _arrays.numbers(pose, "pose", (4, 4))))

    def within(self, a: Body, b: Body, pose: npt.ArrayLike, margin: float) -> tuple[Report, Within]:
        """The report of :meth:`run`, and how likely the surfaces are within ``margin`` metres of each other.

        Never less likely than a collision, nor less likely with a larger margin.

        Raises
        ------
        CloudtouchError
            ``margin`` is negative or not finite, and what :meth:`run` raises.
        """
        matrix = _arrays.numbers(pose, "pose", (4, 4))
        report, within = self._query.within(*native_pair(a, b), matrix, _given.number(margin, "margin"))
        return Report._of(report), Within(**within)

    def clearance_interval(self, a: Body, b: Body, pose: npt.ArrayLike, share: float = 0.9) -> tuple[float, float]:
        """Between what distances, m, the surfaces lie with a probability of ``share``.

        As likely nearer than the first as farther than the second; 0 where a collision alone is likely enough.

        Raises
        ------
        CloudtouchError
            ``share`` is not between 0 and 1, and what :meth:`run` raises.
        """
        matrix, share = _arrays.numbers(pose, "pose", (4, 4)), _given.number(share, "share")
        low, high = self._query.clearance_interval(*native_pair(a, b), matrix, share)
        return low, high

    def run_uncertain(
        self, a: Body, b: Body, pose: npt.ArrayLike, covariance: npt.ArrayLike
    ) -> tuple[Report, UnderPoses]:
        """How likely a collision is where the pose is known only so well, and the report on the likeliest pose.

        Takes up to 29 queries, on all cores, seven where all poses collide, and two where none comes near.

        Parameters
        ----------
        pose
            (4, 4): the likeliest, from the frame of ``b`` into that of ``a``, m.
        covariance
            (6, 6) of a small motion in the frame of ``b`` that follows: translation, m, then rotation vector, rad. May be
            singular. Or (6,), standard deviations of independent ones.

        Raises
        ------
        CloudtouchError
            ``covariance`` is not finite or beyond 1e18, not symmetric or has a negative eigenvalue, and what
            :meth:`run` raises.
        ValueError
            One of (6,) standard deviations is negative.
        """
        matrix = _arrays.numbers(pose, "pose", (4, 4))
        if _arrays.array_of(covariance, "covariance").ndim == 1:
            stds = _arrays.numbers(covariance, "covariance", (6,))
            if (stds < 0).any():
                raise ValueError(f"covariance: {stds.min()} is negative: a standard deviation is 0 or more")
            if (stds[3:] > np.pi).any():
                raise ValueError(f"covariance: {stds[3:].max()} rad is more than half a turn: is it in degrees?")
            covariance = np.diag(stds**2)
        spread = _arrays.numbers(covariance, "covariance", (6, 6))
        report, under = self._query.run_uncertain(*native_pair(a, b), matrix, spread)
        return Report._of(report), UnderPoses(**under)

    def gradient(self, a: Body, b: Body, pose: npt.ArrayLike) -> tuple[Report, Gradient]:
        """The report of :meth:`run`, and what it changes by with the pose: what an optimiser follows.

        Raises
        ------
        CloudtouchError
            What :meth:`run` raises.
        """
        report, slopes = self._query.gradient(*native_pair(a, b), _arrays.numbers(pose, "pose", (4, 4)))
        return Report._of(report), Gradient(**slopes)

    def penetration(
        self, a: Body, b: Body, pose: npt.ArrayLike, probability: float = 0.1
    ) -> tuple[Report, Penetration | None]:
        """The report of :meth:`run`, and the least translation of ``b`` found that ends the collision.

        ``None`` where no direction frees it. Takes some three hundred queries in a collision.

        Parameters
        ----------
        probability
            A collision less likely than this is none.

        Raises
        ------
        CloudtouchError
            ``probability`` is not between 0 and 1, and what :meth:`run` raises.
        """
        matrix, below = _arrays.numbers(pose, "pose", (4, 4)), _given.number(probability, "probability")
        report, out = self._query.penetration(*native_pair(a, b), matrix, below)
        return Report._of(report), None if out is None else Penetration(**out)

    def sweep(
        self, a: Body, b: Body, poses: npt.ArrayLike, *, tolerance: float = 0.01, screw: bool = False
    ) -> Swept:
        """How likely the bodies collide anywhere along a path of ``b``, nothing between its poses missed.

        Parameters
        ----------
        poses
            (M, 4, 4), M at least 2: the path goes from each to the next, the origin of ``b`` along a straight line, its
            rotation by the shorter turn (of half a turn rounding decides which way round: ``warnings`` tell).
        tolerance
            Stretches this short, as a share of the path, are not looked at closer; what they leave open stays in the
            bounds. At least 1e-5.
        screw
            The way from each pose to the next is a screw, about one axis and along it, as a joint moves.

        Raises
        ------
        ValueError
            ``poses`` has the wrong shape or type.
        CloudtouchError
            All poses are the same, ``tolerance`` is below 1e-5 or above 1, and what :meth:`run` raises.
        """
        matrices = _arrays.numbers(poses, "poses", (_arrays.FREE, 4, 4))
        how = _given.flag(screw, "screw"), _given.number(tolerance, "tolerance")
        return Swept._of(self._query.sweep(*native_pair(a, b), matrices, *how))

    def run_batch(
        self, a: Body, b: Body, poses: npt.ArrayLike, *, errors: Literal["raise", "keep"] = "raise"
    ) -> Batch:
        """Many poses of one pair, on all cores: the numbers of :meth:`run`, a row for each pose.

        Other Python threads run meanwhile; Ctrl-C ends it. ``RAYON_NUM_THREADS`` limits the cores.

        Parameters
        ----------
        poses
            (M, 4, 4): from the frame of ``b`` into that of ``a``, m.
        errors
            ``"keep"`` answers the other poses: a bad one has the verdict ``"error"``, NaN for numbers and its message in
            ``Batch.error``.

        Raises
        ------
        ValueError
            ``poses`` has the wrong shape or type.
        CloudtouchError
            As :meth:`run`; the message names the first pose concerned, and there are no other answers.
        """
        if errors not in ("raise", "keep"):
            raise ValueError(f"errors is {errors!r}: give 'raise' or 'keep'")
        matrices = _arrays.numbers(poses, "poses", (_arrays.FREE, 4, 4))
        return Batch._of(self._query.run_batch(*native_pair(a, b), matrices, errors == "keep"))

    def is_free(self, a: Body, b: Body, pose: npt.ArrayLike) -> bool:
        """Whether a pose reads as free: ``run(a, b, pose).verdict == "free"``, and sooner.

        Parameters
        ----------
        pose
            (4, 4): from the frame of ``b`` into that of ``a``, m.

        Raises
        ------
        ValueError
            ``pose`` has the wrong shape or type.
        CloudtouchError
            As :meth:`run`.
        """
        return self._query.is_free(*native_pair(a, b), _arrays.numbers(pose, "pose", (4, 4)))

    def are_free(self, a: Body, b: Body, poses: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Which of many poses read as free, on all cores: ``run_batch(a, b, poses).verdict == "free"``, and sooner.

        A pose is done with as soon as it is known not to be free, and no contacts are looked for. Ctrl-C ends it.

        Parameters
        ----------
        poses
            (M, 4, 4): from the frame of ``b`` into that of ``a``, m.

        Returns
        -------
        numpy.ndarray
            (M,) of bool: true where the verdict is ``"free"``; false where it is any other.

        Raises
        ------
        ValueError
            ``poses`` has the wrong shape or type.
        CloudtouchError
            As :meth:`run`; the message names the first pose concerned, and there are no other answers.
        """
        matrices = _arrays.numbers(poses, "poses", (_arrays.FREE, 4, 4))
        return self._query.are_free(*native_pair(a, b), matrices)

    def page(self, a: Body, b: Body, poses: npt.ArrayLike, *, title: str = "cloudtouch") -> Page:
        """Both bodies and the answers of :meth:`run`, to look at: a notebook shows it, :meth:`Page.save` writes it.

        Parameters
        ----------
        poses
            (4, 4) or (M, 4, 4), at most 500, in the order of the slider, which counts from 1.

        Raises
        ------
        ValueError
            ``poses`` has the wrong shape or type.
        CloudtouchError
            As :meth:`run_batch`, when the page is shown or written.
        """
        if _arrays.array_of(poses, "poses").ndim == 2:
            poses = _arrays.numbers(poses, "poses", (4, 4))[None]
        matrices = _arrays.numbers(poses, "poses", (_arrays.FREE, 4, 4)).copy()
        bodies, title = native_pair(a, b), _given.text(title, "title")
        words = (title, [body.sensor if isinstance(body, Cloud) else None for body in (a, b)])
        return Page(lambda height: self._query.page(*bodies, matrices, words, height))

    def __repr__(self) -> str:
        return f"Query({', '.join(f'{name}={value!r}' for name, value in self._settings.items())})"

    def __eq__(self, other: object) -> bool:
        return self._settings == other._settings if isinstance(other, Query) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self._settings.values()))

    def __getstate__(self) -> dict[str, Any]:
        return self._settings

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._set(state)


def _seconds(value: Any, name: str) -> float | None:
    """How long something may take, where that is limited."""
    seconds = _given.optional_number(value, name)
    if seconds is not None and not 0 <= seconds <= MOST_SECONDS:
        instead = "give seconds, 0 or more, or None for as long as it takes"
        raise _native.CloudtouchError(f"{name} is {_given.told(value)}: {instead}")
    return seconds


def native_query(query: Any, name: str = "query") -> _native.Query:
    """What the compiled half knows of a query; ``name`` is that of the argument."""
    if not isinstance(query, Query):
        raise TypeError(f"{name} is {_given.told(query)}: give a cloudtouch.Query")
    return query._query

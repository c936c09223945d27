//! What is found of the bodies of a scene.

use std::cmp::{Ordering, Reverse};
use std::fmt;

use serde::Serialize;

use crate::doubt::warning::{Warning, length};
use crate::error::QueryError;
use crate::report::{Report, Verdict};

/// Two bodies that do not read as free.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PairAnswer {
    /// Name of the larger of the two, A of the report.
    pub a: String,
    /// Name of the other, B of the report.
    pub b: String,
    /// That of [`Query::run`](crate::Query::run) with contacts in the frame of the scene; or why there
    /// is none, which is not free either.
    pub answer: Result<Report, QueryError>,
}

/// What is found of all pairs of bodies of a scene.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Checked {
    /// All pairs that do not read as free, the worst first: in collision by their probability, without
    /// an answer, undecided, uncertain.
    pub pairs: Vec<PairAnswer>,
    /// Pairs of bodies in the scene.
    pub count: usize,
    /// Of these, pairs that may touch by what was said.
    pub allowed: usize,
    /// Bodies of which no pair was checked, by their names: all they could be in may touch by what was said. The
    /// verdict is of the others.
    pub unchecked: Vec<String>,
    /// Pairs known to be free by their boxes alone.
    pub ruled_out: usize,
    /// Pairs that were asked about.
    pub asked: usize,
    /// Bodies that alone or together are farther from the rest than either is large, by their names: free,
    /// but perhaps by a pose in another unit or the wrong way round.
    pub outside: Vec<Outside>,
    /// What is to be said of bodies by themselves, whatever the verdict: of how a cloud was measured or
    /// filtered, in the order of their names.
    pub warnings: Vec<BodyWarning>,
}

/// A warning about a body of a scene. Displays as a sentence with a remedy, and serialises as `{"name"}` with
/// what the [`Warning`] has, whose `scene` is this body.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct BodyWarning {
    /// Its name.
    pub name: String,
    /// What is to be said.
    #[serde(flatten)]
    pub warning: Warning,
}

impl fmt::Display for BodyWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`: {}", self.name, self.warning)
    }
}

/// A body of a scene that is far from the rest. Displays as a sentence with a remedy.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Outside {
    /// Its name.
    pub name: String,
    /// Between the box around it and those with it, and that around the rest, m.
    pub gap_m: f64,
    /// Diagonal of the larger of the two, m.
    pub size_m: f64,
}

impl fmt::Display for Outside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, gap_m, size_m } = self;
        write!(
            f,
            "`{name}` is {} from the rest, farther than either is large ({}): are poses in metres, into the \
             frame of the scene?",
            length(*gap_m),
            length(*size_m)
        )
    }
}

impl Checked {
    /// The worst verdict of any pair: free where none is left, undecided where one has no answer and
    /// none is in collision, and where [none was checked](Self::is_unchecked).
    pub fn verdict(&self) -> Verdict {
        let without = if self.is_unchecked() { Verdict::Undecided } else { Verdict::Free };
        self.pairs.first().map_or(without, PairAnswer::verdict)
    }

    /// Whether there was no pair to check: all may touch by what was said, or there are fewer than two bodies.
    /// Nothing is known then.
    pub fn is_unchecked(&self) -> bool {
        self.allowed == self.count
    }
}

impl PairAnswer {
    /// The verdict; undecided without an answer.
    pub fn verdict(&self) -> Verdict {
        self.answer.as_ref().map_or(Verdict::Undecided, |report| report.verdict)
    }

    pub(super) fn is_free(&self) -> bool {
        self.verdict() == Verdict::Free
    }

    /// The worse first; of the same by name.
    pub(super) fn by_gravity(&self, other: &Self) -> Ordering {
        let rank = |pair: &Self| {
            let order = match (&pair.answer, pair.verdict()) {
                (_, Verdict::InCollision) => 0,
                (Err(_), _) => 1,
                (_, Verdict::Undecided) => 2,
                (_, Verdict::Uncertain) => 3,
                (_, Verdict::Free) => 4,
            };
            let probability = pair.answer.as_ref().map_or(1.0, |r| r.collision_probability);
            // Probabilities are not negative, and their bits in their order.
            (order, Reverse(probability.to_bits()))
        };
        (rank(self), &self.a, &self.b).cmp(&(rank(other), &other.a, &other.b))
    }
}

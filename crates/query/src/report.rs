//! What a query answers.

use std::fmt;

use cloudtouch_geom::{Point3, Vector3};
use serde::{Serialize, Serializer};

use crate::doubt::undecided::Undecided;
use crate::doubt::unseen::Unseen;
use crate::doubt::warning::Warning;
use crate::judge::ContactEvidence;
use crate::mode::Mode;
use crate::stats::Stats;

/// The answer to one query. Serialises to the JSON object of the command-line tool.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Probability that the two underlying surfaces collide.
    pub collision_probability: f64,
    /// Lower and upper bound on that probability under the same model: what was culled, left out
    /// by an early stop, or not decided widens them. [`Self::collision_probability`] lies within. In the
    /// paper's mode pairs that were left out are bounded by a plane midway, which the surface of a kernel may bend
    /// away from: an answer without the early stop may lie a little outside.
    pub bounds: [f64; 2],
    /// The decision at the thresholds of the query.
    pub verdict: Verdict,
    /// Why the verdict is [`Verdict::Undecided`]; `None` for every other.
    pub undecided_by: Option<Undecided>,
    /// What the evidence weighs: the logarithm of how many times as probable it is in a collision as
    /// without one. The probability is that of the prior moved by it. `None` on the paper's path, and
    /// between two meshes, which are exact.
    pub log_likelihood_ratio: Option<f64>,
    /// Distance of the surfaces where they are likeliest to touch; `None` when nothing was near
    /// enough to be measured, or what was left out may be closer.
    pub clearance_m: Option<Clearance>,
    /// No sampled surface of one body is nearer to that of the other than this, m: a lower bound from
    /// the boxes around them, above 0. `None` where these overlap, so that the surfaces may touch, where the
    /// verdict is doubted, when the paper's path or a deadline left surfaces out, and between two meshes, whose
    /// distance is `clearance_m`.
    pub clearance_at_least_m: Option<f64>,
    /// Where the surfaces touch or may touch, most probable first.
    pub contacts: Vec<Contact>,
    /// What the probability rests on; `None` on the paper's path, and between two meshes.
    pub evidence: Option<ContactEvidence>,
    /// How much of a body lies where a single depth image saw nothing; `None` where no body is one.
    pub unseen: Option<Unseen>,
    /// Signs of a slip: a unit, a pose or a sensor that is hardly meant.
    pub warnings: Vec<Warning>,
    /// What the answer cost.
    pub stats: Stats,
    /// Seed of the stochastic traversals; 0 on the default path, which draws nothing.
    pub seed: u64,
    /// Which path estimated.
    pub mode: Mode,
    /// The largest probability of any point (section 4.4 of the paper).
    #[serde(skip)]
    pub max_probability: f64,
    /// The probability that at least one of the likely, well separated points collides
    /// (section 4.4, noisy-or).
    #[serde(skip)]
    pub noisy_or_probability: f64,
    /// Points with a probability worth telling, for pictures and planners.
    #[serde(skip)]
    pub point_probabilities: PointProbabilities,
}

/// The decision a query takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The upper bound on the probability is below the reject threshold.
    Free,
    /// The probability lies between the thresholds: the surfaces may touch, overlap or be apart.
    Uncertain,
    /// The probability is above the accept threshold.
    InCollision,
    /// Some part could not be decided, or was left out without a bound below the reject threshold,
    /// and the rest does not settle the matter; or what was found cannot be believed:
    /// [`Report::undecided_by`] says why.
    Undecided,
}

impl Verdict {
    /// Its name in JSON and in Python.
    pub fn code(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Uncertain => "uncertain",
            Self::InCollision => "in_collision",
            Self::Undecided => "undecided",
        }
    }
}

/// Its code.
impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.code())
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.pad(match self {
            Self::Free => "free",
            Self::Uncertain => "uncertain",
            Self::InCollision => "in collision",
            Self::Undecided => "undecided",
        })
    }
}

/// A gap between two surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Clearance {
    /// Expected gap along the normal of the contact, m; negative in overlap.
    pub mean: f64,
    /// Standard deviation of that, m: of the surfaces across, and of what samples leave open between
    /// them.
    pub std: f64,
    /// Whether the overlap may be deeper than `mean` says: of surfaces that cross no more than half a
    /// spacing is told. Where noise is about as large as the spacing, chance makes surfaces cross that are apart,
    /// and this shows no overlap.
    pub is_bound: bool,
}

impl Clearance {
    /// A gap of this mean and standard deviation (m) that is no bound.
    pub fn new(mean: f64, std: f64) -> Self {
        Self { mean, std, is_bound: false }
    }
}

/// A place where the surfaces touch or may touch, in the frame of A.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Contact {
    /// Where the surfaces meet or would meet, m. On the paper's path a point on the separating
    /// surface; where that passes far from the most probable samples, the middle of these.
    #[serde(serialize_with = "as_array")]
    pub point: Point3,
    /// Unit vector along which B leaves A there, as far as the samples of both around the contact tell:
    /// across the plane that separates these best. Where they lie in one another, as a peg in its hole, it
    /// may be any; so it may in deep overlaps, of which less is seen from a contact. On the paper's path that of
    /// the separating surface.
    #[serde(serialize_with = "vector_as_array")]
    pub normal_a_to_b: Vector3,
    /// Probability that the surfaces meet there; never above that of the collision.
    pub probability: f64,
    /// Gap across the pieces of surface there, m; negative in overlap.
    pub clearance_m: f64,
    /// How much surface belongs to the contact, m², roughly: the places within a spacing of it. Those of all contacts
    /// are no measure of the overlap: in a certain collision the search ends at the first of them
    /// ([`QuerySettings::stop_above`](crate::QuerySettings::stop_above)), and neighbours may count some places both.
    /// `None` on the paper's path.
    pub area_m2: Option<f64>,
}

fn as_array<S: serde::Serializer>(point: &Point3, serializer: S) -> Result<S::Ok, S::Error> {
    [point.x, point.y, point.z].serialize(serializer)
}

pub(crate) fn vector_as_array<S: serde::Serializer>(
    v: &Vector3,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    [v.x, v.y, v.z].serialize(serializer)
}

/// Probabilities of single points, as (index into the prepared cloud, probability) in index order.
///
/// Points that are not listed were culled or are below [`POINT_FLOOR`](crate::POINT_FLOOR). A body
/// that is a mesh has no entries.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct PointProbabilities {
    /// Points of A.
    pub a: Vec<(usize, f64)>,
    /// Points of B.
    pub b: Vec<(usize, f64)>,
}

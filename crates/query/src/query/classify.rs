//! One leaf pair: the ladder from a plane to a kernel classifier, and the surface it ends with.

use cloudtouch_geom::UncertainPoint;
use cloudtouch_svm::{Class, DEFAULT_KAPPA_MAX, separate};

use crate::cloud::Surfel;
use crate::report::Stats;

use super::settings::{Mode, QuerySettings};
use super::surface::Surface;
use super::train::by_kernel;

/// A point on one side of a leaf pair, in the local frame of A.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairPoint {
    /// Index in the prepared cloud; `None` for a point of a mesh.
    pub index: Option<u32>,
    pub point: UncertainPoint,
    /// Distance between samples there, m.
    pub spacing: f64,
}

impl From<&Surfel> for PairPoint {
    /// A piece of surface that is in the local frame of A already.
    fn from(surfel: &Surfel) -> Self {
        Self { index: Some(surfel.index), point: surfel.point, spacing: surfel.spacing }
    }
}

/// The points of the two leaves.
#[derive(Debug, Default)]
pub(crate) struct PairPoints {
    pub a: Vec<PairPoint>,
    pub b: Vec<PairPoint>,
    /// Whether the points of that side are exact points of a mesh.
    pub a_is_mesh: bool,
    pub b_is_mesh: bool,
}

/// What a leaf pair says.
#[derive(Debug)]
pub(crate) enum PairAnswer {
    /// A surface separates the pair, with these probabilities of the points of A and of B.
    Separated { surface: Surface, a: Vec<f64>, b: Vec<f64> },
    /// The uncertainty is as large as the pair itself: nothing separates it, nothing joins it.
    Indistinct,
    /// No solver reached an answer.
    Undecided,
}

impl PairAnswer {
    /// The largest probability of a point; 1 without an answer.
    pub(super) fn largest(&self) -> f64 {
        match self {
            Self::Separated { a, b, .. } => a.iter().chain(b).copied().fold(0.0, f64::max),
            Self::Indistinct | Self::Undecided => 1.0,
        }
    }
}

/// Beyond this many standard deviations on either side of a plane, no kernel problem is solved:
/// every point is less probable than 1e-6.
const CERTAIN_DEVIATIONS: f64 = DEFAULT_KAPPA_MAX;

/// Climbs the ladder until a rung answers.
///
/// A probability is a statement about the best separating surface there is: among the surfaces
/// tried, the calibrated mode takes the one whose worst point is least probable, and trains no
/// kernel classifier where a plane already keeps every point below what is `known` from other
/// pairs. The paper's mode takes the kernel classifier unless a plane is certain.
pub(crate) fn classify(
    points: &PairPoints,
    settings: &QuerySettings,
    known: f64,
    stats: &mut Stats,
) -> PairAnswer {
    let uncertain = |side: &[PairPoint]| side.iter().map(|p| p.point).collect::<Vec<_>>();
    let (a, b) = (uncertain(&points.a), uncertain(&points.b));
    let separation = separate(&a, &b, CERTAIN_DEVIATIONS);
    let plane = separation.and_then(|s| score(Surface::Plane(s), &a, &b));
    let plane = match plane {
        Some(plane) if separation.is_some_and(|s| s.kappa >= CERTAIN_DEVIATIONS) => {
            stats.linear_certificates += 1;
            return plane;
        }
        plane => plane,
    };
    if settings.mode == Mode::Paper {
        let kernel = by_kernel(points, settings, known, stats);
        return match (plane, kernel) {
            (Some(plane), PairAnswer::Indistinct | PairAnswer::Undecided) => plane,
            (_, kernel) => kernel,
        };
    }
    match plane {
        Some(plane) if plane.largest() <= known => {
            stats.linear_certificates += 1;
            plane
        }
        Some(plane) => {
            let kernel = by_kernel(points, settings, known, stats);
            if plane.largest() <= kernel.largest() { plane } else { kernel }
        }
        None => by_kernel(points, settings, known, stats),
    }
}

/// The probabilities that a surface gives the points; `None` when one of them is not a number.
pub(super) fn score(
    surface: Surface,
    a: &[UncertainPoint],
    b: &[UncertainPoint],
) -> Option<PairAnswer> {
    let side = |points: &[UncertainPoint], class| {
        points.iter().map(|p| surface.probability(p, class)).collect::<Option<Vec<f64>>>()
    };
    let (a, b) = (side(a, Class::A)?, side(b, Class::B)?);
    Some(PairAnswer::Separated { surface, a, b })
}

//! One leaf pair: the ladder from a plane to a kernel classifier, and the surface it ends with.

use cloudtouch_geom::UncertainPoint;
use cloudtouch_svm::{
    Class, Classifier, DEFAULT_KAPPA_MAX, Kernel, Problem, Rung, Sample, Settings, Solution,
    Status, UnitBox, balanced_penalties, separate,
};

use crate::report::Stats;

use super::settings::{Mode, QuerySettings};
use super::surface::Surface;

/// A point on one side of a leaf pair, in the local frame of A.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PairPoint {
    /// Index in the prepared cloud; `None` for a point of a mesh.
    pub index: Option<u32>,
    pub point: UncertainPoint,
    /// Distance between samples there, m.
    pub spacing: f64,
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
    fn largest(&self) -> f64 {
        match self {
            Self::Separated { a, b, .. } => a.iter().chain(b).copied().fold(0.0, f64::max),
            Self::Indistinct | Self::Undecided => 1.0,
        }
    }
}

/// Beyond this many standard deviations on either side of a plane, no kernel problem is solved:
/// every point is less probable than 1e-6.
const CERTAIN_DEVIATIONS: f64 = DEFAULT_KAPPA_MAX;

/// A kernel classifier is not trusted where the typical standard deviation is larger than this
/// share of the pair: with ellipsoids as large as the scene, f can be bent flat at every point and
/// its confident probabilities mean nothing.
const TRUSTED_STD: f64 = 0.5;
/// How much tighter a collapsed problem is solved before it is believed.
const TIGHTER: f64 = 1e-3;

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
        Some(plane)
            if separation.is_some_and(|s| s.kappa >= CERTAIN_DEVIATIONS)
                || (settings.mode == Mode::Calibrated && plane.largest() <= known) =>
        {
            stats.linear_certificates += 1;
            return plane;
        }
        plane => plane,
    };
    let kernel = by_kernel(points, settings, stats);
    let kernel_answered = matches!(kernel, PairAnswer::Separated { .. });
    match plane {
        Some(plane) if !(kernel_answered && settings.mode == Mode::Paper) => {
            if plane.largest() <= kernel.largest() { plane } else { kernel }
        }
        _ => kernel,
    }
}

/// The probabilities that a surface gives the points; `None` when one of them is not a number.
fn score(surface: Surface, a: &[UncertainPoint], b: &[UncertainPoint]) -> Option<PairAnswer> {
    let side = |points: &[UncertainPoint], class| {
        points.iter().map(|p| surface.probability(p, class)).collect::<Option<Vec<f64>>>()
    };
    let (a, b) = (side(a, Class::A)?, side(b, Class::B)?);
    Some(PairAnswer::Separated { surface, a, b })
}

/// Median over the points of the largest standard deviation in any direction, m.
fn typical_std(points: &[UncertainPoint]) -> f64 {
    let mut stds: Vec<f64> = points.iter().map(|p| p.covariance.max_std()).collect();
    stds.sort_by(f64::total_cmp);
    stds[stds.len() / 2]
}

fn by_kernel(points: &PairPoints, settings: &QuerySettings, stats: &mut Stats) -> PairAnswer {
    stats.kernel_solves += 1;
    let all: Vec<UncertainPoint> = points.a.iter().chain(&points.b).map(|p| p.point).collect();
    let Some(unit_box) = UnitBox::around(&all) else { return PairAnswer::Undecided };
    if typical_std(&all) * unit_box.scale() > TRUSTED_STD {
        return PairAnswer::Indistinct;
    }
    let (penalty_a, penalty_b) =
        balanced_penalties(settings.penalty, points.a.len(), points.b.len());
    let factor = |is_mesh: bool| if is_mesh { settings.mesh_penalty_factor } else { 1.0 };
    let samples: Vec<Sample> = all
        .iter()
        .enumerate()
        .map(|(i, &point)| {
            let (class, penalty) = if i < points.a.len() {
                (Class::A, penalty_a * factor(points.a_is_mesh))
            } else {
                (Class::B, penalty_b * factor(points.b_is_mesh))
            };
            let sample = Sample { point, class, radius: settings.ellipsoid_radius, penalty };
            unit_box.sample_inside(&sample)
        })
        .collect();
    let kernel = Kernel::Gaussian { gamma: settings.gamma };
    let Ok(problem) = Problem::try_new(&samples, kernel) else { return PairAnswer::Undecided };
    let mut solve = |relative_gap: f64| -> Option<Solution> {
        let solution = problem.solve(&Settings::with_relative_gap(relative_gap).ok()?);
        stats.fallbacks += usize::from(solution.rung == Rung::Clarabel);
        Some(solution)
    };
    let mut solution = solve(settings.relative_gap);
    if solution.as_ref().is_some_and(|s| s.status == Status::Collapsed) {
        // A loose tolerance cannot tell a small w from none: once more, tighter.
        solution = solve(settings.relative_gap * TIGHTER);
    }
    let Some(solution) = solution else { return PairAnswer::Undecided };
    stats.max_relative_gap = stats.max_relative_gap.max(solution.relative_gap);
    if solution.status == Status::Collapsed {
        return PairAnswer::Indistinct;
    }
    let Ok(classifier) = Classifier::try_new(&problem, &solution) else {
        return PairAnswer::Undecided;
    };
    let surface = Surface::Kernel(classifier.outside(unit_box));
    let (a, b) = all.split_at(points.a.len());
    score(surface, a, b).unwrap_or(PairAnswer::Undecided)
}

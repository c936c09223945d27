//! The kernel classifier of one leaf pair (eq. 10 to 16 of the paper), trained in the unit box.

use std::ops::ControlFlow;

use cloudtouch_geom::UncertainPoint;
use cloudtouch_svm::{
    Class, Classifier, Problem, Rung, Sample, Settings, Solution, Solver, Status, Undetermined,
    UnitBox, balanced_penalties,
};

use crate::stats::Stats;

use super::clock::Clock;
use super::pair::{PairAnswer, PairPoint, PairPoints};
use super::settings::ClassifierSettings;
use super::surface::Surface;

/// That a pair is apart is not believed of a classifier where the typical standard deviation across
/// its surface is larger than this, in box lengths: eq. 16 takes f as linear over a few standard
/// deviations, but f can turn within a kernel width, 1/√(2γ), and be flat at every point. An eighth of that width at
/// the default γ of 3 (0.41), a quarter at the paper's of 10 (0.22).
const TRUSTED_STD: f64 = 0.05;
/// Where it is this share of that off, a loose tolerance may decide.
const AT_LIMIT: f64 = 0.05;
/// How much tighter a problem is solved that leaves open whether there is a surface, or where.
const TIGHTER: f64 = 1e-2;
/// A larger relative gap than this counts as this: no probability is read beyond it.
const LOOSEST: f64 = 3e-2;

/// What training a classifier gave.
#[derive(Debug)]
pub(crate) struct Trained {
    pub answer: PairAnswer,
    /// Multipliers in the unit box, those of A first; `None` where no problem could be posed.
    pub solution: Option<Solution>,
}

impl Trained {
    const UNDECIDED: Self = Self { answer: PairAnswer::Undecided, solution: None };
}

/// What a solution says.
struct Reading {
    answer: PairAnswer,
    /// Whether another solution within the tolerance may be believed where this is not, or the other way.
    is_at_limit: bool,
}

/// Trains a classifier and reads the probabilities off it.
///
/// An answer that the first solution leaves open, or nearly, is solved again, tighter; left open still, or cut
/// short by the clock, the pair is undecided.
pub(crate) fn by_kernel(
    points: &PairPoints,
    settings: &ClassifierSettings,
    clock: &Clock,
    stats: &mut Stats,
) -> Trained {
    stats.kernel_solves += 1;
    let relative_gap = settings.relative_gap.min(LOOSEST);
    let settings = &ClassifierSettings { relative_gap, ..*settings };
    let all: Vec<UncertainPoint> = points.a.iter().chain(&points.b).map(|p| p.point).collect();
    let Some(unit_box) = UnitBox::around(&all) else { return Trained::UNDECIDED };
    let unit_box = settings.scale.map_or(unit_box, |scale| unit_box.with_scale(scale));
    let samples = samples(points, &unit_box, settings);
    let Ok(problem) = Problem::new(&samples, settings.kernel) else {
        return Trained::UNDECIDED;
    };
    let solver = |relative_gap| Solver::new(Settings { relative_gap, ..Settings::default() });
    let both = [relative_gap, TIGHTER * relative_gap].map(solver);
    let [Ok(mut loose), Ok(mut tight)] = both else { return Trained::UNDECIDED };
    let mut is_cut = false;
    let mut look = |_: &_| {
        is_cut = clock.is_over();
        if is_cut { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };

    let sides = all.split_at(points.a.len());
    let reading = |solution: &_| read(&problem, solution, unit_box, sides, settings);
    let mut solution = loose.solve_watched(&problem, None, &mut look);
    let mut read = reading(&solution);
    if is_open(&solution) || read.is_at_limit {
        solution = tight.solve_watched(&problem, Some(&solution), &mut look);
        read = reading(&solution);
    }
    stats.fallbacks += usize::from(solution.rung == Rung::Clarabel);
    stats.max_relative_gap = stats.max_relative_gap.max(solution.relative_gap);
    // That a loose solution cannot exclude w = 0 says little: a tighter one may.
    let is_collapsed = matches!(read.answer, PairAnswer::Indistinct)
        && solution.status == Status::Collapsed
        && solution.relative_gap > tight.settings().relative_gap;
    let answer = if is_cut && is_collapsed { PairAnswer::Undecided } else { read.answer };
    Trained { answer, solution: Some(solution) }
}

/// Whether a loose tolerance may be why nothing is determined: it cannot tell a small w from none, nor
/// what the bias is where hardly a multiplier is free.
fn is_open(solution: &Solution) -> bool {
    matches!(
        solution.determined(),
        Err(Undetermined::Collapsed | Undetermined::Weight { .. } | Undetermined::Bias { .. })
    )
}

fn samples(points: &PairPoints, unit_box: &UnitBox, settings: &ClassifierSettings) -> Vec<Sample> {
    let (penalty_a, penalty_b) = if settings.is_balanced {
        balanced_penalties(settings.penalty, points.a.len(), points.b.len())
    } else {
        (settings.penalty, settings.penalty)
    };
    let factor = |is_mesh: bool| if is_mesh { settings.mesh_penalty_factor } else { 1.0 };
    let of_a = (Class::A, penalty_a * factor(points.a_is_mesh));
    let of_b = (Class::B, penalty_b * factor(points.b_is_mesh));
    let sample = |(i, of): (usize, &PairPoint)| {
        let (class, penalty) = if i < points.a.len() { of_a } else { of_b };
        let radius = of.radius.unwrap_or(settings.ellipsoid_radius);
        unit_box.sample_inside(&Sample { point: of.point, class, radius, penalty })
    };
    points.a.iter().chain(&points.b).enumerate().map(sample).collect()
}

fn read(
    problem: &Problem,
    solution: &Solution,
    unit_box: UnitBox,
    (a, b): (&[UncertainPoint], &[UncertainPoint]),
    settings: &ClassifierSettings,
) -> Reading {
    let sure = |answer| Reading { answer, is_at_limit: false };
    if solution.status == Status::Collapsed {
        return sure(PairAnswer::Indistinct);
    }
    // Cut short, or stuck: that probabilities may be read does not make them exact.
    if solution.relative_gap > settings.relative_gap {
        return sure(PairAnswer::Undecided);
    }
    let Ok(classifier) = Classifier::new(problem, solution) else {
        return sure(PairAnswer::Undecided);
    };
    let surface = Surface::Kernel(classifier.outside(unit_box));
    let std = if settings.distrusts_noise {
        typical_std_across(&surface, a.iter().chain(b)) * unit_box.scale()
    } else {
        0.0
    };
    let is_at_limit = (std / TRUSTED_STD - 1.0).abs() < AT_LIMIT;
    let answer = match PairAnswer::of(surface, a, b) {
        Some(answer) if std > TRUSTED_STD && answer.largest() < 0.5 => PairAnswer::Indistinct,
        Some(answer) => answer,
        None => PairAnswer::Undecided,
    };
    Reading { answer, is_at_limit }
}

/// Median over the points of the standard deviation along the gradient, m.
fn typical_std_across<'a>(
    surface: &Surface,
    points: impl Iterator<Item = &'a UncertainPoint>,
) -> f64 {
    let across = |point: &UncertainPoint| {
        let (_, gradient) = surface.value_and_gradient(&point.mean);
        let normal = gradient.try_normalize(0.0);
        // A function that is flat there trusts no noise.
        normal.map_or_else(|| point.covariance.max_std(), |n| point.covariance.std_along(&n))
    };
    let mut stds: Vec<f64> = points.map(across).collect();
    stds.sort_by(f64::total_cmp);
    stds[stds.len() / 2]
}

//! Leaf problems as a query poses them, and what solving them takes.

use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, Vector3, seed};
use cloudtouch_svm::{
    Class, Classifier, Kernel, Problem, Rung, Sample, Settings, Solution, Status, UnitBox,
    balanced_penalties,
};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};

use super::{RELATIVE_GAP, SEED};

/// Points of each side, as many as a leaf holds.
const POINTS: u64 = 40;
/// Shapes over a plane, each with equal and with lopsided noise.
pub(super) const KINDS: u64 = 6;

/// γ, C and r of a default query.
pub(super) const GAMMA: f64 = 10.0;
pub(super) const PENALTY: f64 = 100.0;
const RADIUS: f64 = 1.0;

/// The points of two leaves, A and B.
pub(super) type Leaves = [Vec<UncertainPoint>; 2];

/// A cap, a wedge or a slanted sheet over a unit square, `gap` box lengths from it, measured with
/// noise of `std` box lengths.
pub(super) fn leaves(gap: f64, std: f64, kind: u64) -> Leaves {
    let lopsided = kind >= KINDS / 2;
    [0, 1].map(|side| {
        let at = |i| {
            let draw = |k| seed::unit(seed::derive(seed::derive(SEED, kind, side), i, k)) - 0.5;
            let (x, y) = (draw(0), draw(1));
            let z = match (side, kind % 3) {
                (1, _) => 0.0,
                (_, 0) => gap + 0.6 * (x * x + y * y),
                (_, 1) => gap + 0.8 * x.abs(),
                _ => gap + 0.4 * (x + 0.5),
            };
            Point3::new(x, y, z)
        };
        let exact: Vec<Point3> = (0..POINTS).map(at).collect();
        let noisy = add_noise(&exact, NoiseKind::Gaussian, 1.0, seed::derive(SEED, kind, 2 + side));
        let root = if lopsided { Vector3::new(0.2, 0.5, 1.0) } else { Vector3::repeat(1.0) } * std;
        let covariance =
            Covariance::from_symmetric(&Matrix3::from_diagonal(&root.component_mul(&root)));
        let measured = exact.iter().zip(&noisy).map(|(exact, noisy)| UncertainPoint {
            mean: exact + (noisy - exact).component_mul(&root),
            covariance,
        });
        measured.collect()
    })
}

/// Solves a leaf pair as a query does: in its unit box, with penalties balanced.
pub(super) fn solve(leaves: &Leaves, gamma: f64, penalty: f64) -> Option<Solved> {
    let unit_box = UnitBox::around(leaves.iter().flatten())?;
    let penalties = balanced_penalties(penalty, leaves[0].len(), leaves[1].len());
    let side = |class, points: &[UncertainPoint], penalty| {
        let sample = |&point: &UncertainPoint| {
            unit_box.sample_inside(&Sample { point, class, radius: RADIUS, penalty })
        };
        points.iter().map(sample).collect::<Vec<_>>()
    };
    let mut samples = side(Class::A, &leaves[0], penalties.0);
    samples.extend(side(Class::B, &leaves[1], penalties.1));
    Solved::new(&samples, gamma)
}

/// A problem with its solution.
pub(super) struct Solved {
    pub(super) problem: Problem,
    pub(super) solution: Solution,
    /// Probabilities of the samples; none when they are not determined.
    pub(super) probabilities: Option<Vec<f64>>,
}

impl Solved {
    pub(super) fn new(samples: &[Sample], gamma: f64) -> Option<Self> {
        let problem = Problem::try_new(samples, Kernel::Gaussian { gamma }).ok()?;
        let settings = Settings { relative_gap: RELATIVE_GAP, ..Settings::default() };
        let solution = problem.solve(&settings).ok()?;
        let probabilities = probabilities(samples, &problem, &solution);
        Some(Self { problem, solution, probabilities })
    }

    /// Whether the answer came from Clarabel, the fallback of the ladder.
    pub(super) fn fell_back(&self) -> bool {
        self.solution.rung == Rung::Clarabel
    }

    /// Whether there is no answer. A collapse is one: that nothing separates the pair.
    pub(super) fn is_undecided(&self) -> bool {
        !matches!(self.solution.status, Status::Converged | Status::Collapsed)
    }
}

pub(super) fn probabilities(
    samples: &[Sample],
    problem: &Problem,
    solution: &Solution,
) -> Option<Vec<f64>> {
    let f = Classifier::try_new(problem, solution).ok()?;
    samples.iter().map(|s| f.probability(&s.point, s.class)).collect()
}

/// The largest difference of two lists of probabilities; none unless both are known.
pub(super) fn largest_difference(p: &Option<Vec<f64>>, q: &Option<Vec<f64>>) -> Option<f64> {
    let (p, q) = (p.as_ref()?, q.as_ref()?);
    Some(p.iter().zip(q).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_far_apart_are_free_and_leaves_that_overlap_are_less_so() {
        for kind in 0..KINDS {
            let largest = |gap: f64| {
                let solved = solve(&leaves(gap, 0.01, kind), GAMMA, PENALTY).unwrap();
                assert!(!solved.is_undecided());
                solved.probabilities.unwrap().into_iter().fold(0.0, f64::max)
            };
            let [far, within] = [0.3, -0.1].map(largest);
            // A kernel surface can bend between points of sheets that cross.
            assert!(far < 1e-3 && within > 0.05, "kind {kind}: {far} and {within}");
        }
    }
}

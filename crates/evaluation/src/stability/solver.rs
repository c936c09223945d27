//! The solver as a query uses it; no other file of this report knows its interface.

use anyhow::Result;
use cloudtouch_geom::UncertainPoint;
use cloudtouch_svm::{
    Class, Classifier, Kernel, Problem, Rung, Sample, Settings, Solution, Solver, Status, UnitBox,
    balanced_penalties,
};
use cloudtouch_testkit::hard_cases::HardProblem;

/// The relative gap that solves are asked for: that of reported figures.
pub(super) const RELATIVE_GAP: f64 = 1e-4;
/// γ, C and r of a default query.
pub(super) const GAMMA: f64 = 10.0;
pub(super) const PENALTY: f64 = 100.0;
const RADIUS: f64 = 1.0;

/// A problem to be solved.
pub(super) struct Posed {
    samples: Vec<Sample>,
    gamma: f64,
}

impl Posed {
    /// Two leaves as a query poses them: in their unit box, with penalties balanced. None of
    /// nothing.
    pub(super) fn of_leaves(
        [a, b]: [&[UncertainPoint]; 2],
        gamma: f64,
        penalty: f64,
    ) -> Option<Self> {
        let unit_box = UnitBox::around(a.iter().chain(b))?;
        let (penalty_a, penalty_b) = balanced_penalties(penalty, a.len(), b.len());
        let side = |points: &[UncertainPoint], class, penalty| {
            let sample =
                |&point| unit_box.sample_inside(&Sample { point, class, radius: RADIUS, penalty });
            points.iter().map(sample).collect::<Vec<_>>()
        };
        let samples = [side(a, Class::A, penalty_a), side(b, Class::B, penalty_b)].concat();
        Some(Self { samples, gamma })
    }

    /// A problem of the catalogue as it is.
    pub(super) fn of_problem(problem: &HardProblem) -> Self {
        let side = |class, points: &[UncertainPoint], radii: &[f64]| {
            let pairs = points.iter().zip(radii);
            pairs
                .map(|(&point, &radius)| Sample { point, class, radius, penalty: problem.penalty })
                .collect::<Vec<_>>()
        };
        let a = side(Class::A, &problem.points_a, &problem.radii_a);
        let b = side(Class::B, &problem.points_b, &problem.radii_b);
        Self { samples: [a, b].concat(), gamma: problem.gamma }
    }
}

/// A problem with its solution.
pub(super) struct Solved {
    problem: Problem,
    solution: Solution,
    /// Probabilities of the samples; none when they are not determined.
    pub(super) probabilities: Option<Vec<f64>>,
}

impl Solved {
    pub(super) fn new(posed: &Posed) -> Result<Self> {
        let problem = Problem::try_new(&posed.samples, Kernel::Gaussian { gamma: posed.gamma })?;
        let settings = Settings { relative_gap: RELATIVE_GAP, ..Settings::default() };
        let solution = problem.solve(&settings)?;
        let classifier = Classifier::try_new(&problem, &solution).ok();
        let of = |f: Classifier| -> Option<Vec<f64>> {
            posed.samples.iter().map(|s| f.probability(&s.point, s.class)).collect()
        };
        let probabilities = classifier.and_then(of);
        Ok(Self { problem, solution, probabilities })
    }

    /// The relative difference of the primal value from Clarabel's, where both reach the gap.
    pub(super) fn against_clarabel(&self) -> Result<Option<f64>> {
        let settings = Settings { relative_gap: RELATIVE_GAP, ..Settings::default() };
        let reference = Solver::try_new(settings)?.solve_with_clarabel(&self.problem);
        let both = !self.is_undecided() && reference.relative_gap <= RELATIVE_GAP;
        let difference = (self.solution.primal - reference.primal).abs();
        Ok(both.then(|| difference / self.solution.primal.abs()))
    }

    pub(super) fn status(&self) -> String {
        format!("{:?}", self.solution.status)
    }

    /// Who answered: SMO, the dense interior point method, or Clarabel.
    pub(super) fn rung(&self) -> String {
        format!("{:?}", self.solution.rung)
    }

    pub(super) fn steps(&self) -> usize {
        self.solution.effort.smo_steps
    }

    pub(super) fn gap(&self) -> f64 {
        self.solution.relative_gap
    }

    /// Whether there is no answer. A collapse is one: that nothing separates the pair.
    pub(super) fn is_undecided(&self) -> bool {
        !matches!(self.solution.status, Status::Converged | Status::Collapsed)
    }

    /// Whether SMO alone did not answer.
    pub(super) fn is_past_smo(&self) -> bool {
        self.solution.rung != Rung::Smo || self.is_undecided()
    }

    /// Whether the answer came from Clarabel, the fallback of the ladder.
    pub(super) fn fell_back(&self) -> bool {
        self.solution.rung == Rung::Clarabel
    }

    /// What must hold of any solution and does not.
    pub(super) fn faults(&self) -> Vec<String> {
        let solution = &self.solution;
        let mut faults = Vec::new();
        let numbers = [solution.bias, solution.primal, solution.dual, solution.relative_gap];
        let multipliers = solution.alpha.iter().chain(solution.v.iter().flatten());
        if !numbers.iter().chain(multipliers).all(|v| v.is_finite()) {
            faults.push("a number of the solution is not finite".into());
        }
        // The automatic budget, and twice the polish after an interior point method.
        let n = solution.alpha.len();
        if self.steps() > n * n / 2 + 50 + 20 * n {
            faults.push(format!("{} steps for {n} points", self.steps()));
        }
        let in_range = |p: &f64| (0.0..=1.0).contains(p);
        if !self.probabilities.iter().flatten().all(in_range) {
            faults.push("a probability is not one".into());
        }
        faults
    }
}

/// The largest difference of two lists of probabilities; none unless both are known.
pub(super) fn largest_difference(p: &Option<Vec<f64>>, q: &Option<Vec<f64>>) -> Option<f64> {
    let (p, q) = (p.as_ref()?, q.as_ref()?);
    Some(p.iter().zip(q).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max))
}

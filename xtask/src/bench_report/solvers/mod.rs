//! Leaf problems by our solver, by Clarabel, and without ellipsoids by linfa-svm.

mod cells;
mod plain;

use std::fmt::Write as _;

use anyhow::{Result, ensure};
use cloudtouch_geom::seed::derive;
use cloudtouch_svm::{Kernel, Problem, Rung, Sample, Settings, Solution, Solver};

use super::{
    Run, Section, plots,
    target::Target,
    timing::{median, p95, ratio, three_digits, time, timed},
};
use crate::common::table::Table;
use cells::{CELLS, Cell};
use plain::{Solved, linfa};

/// The relative gap that every solver is asked for.
const GAP: f64 = 1e-4;
/// More points of a side than this are solved once beside Clarabel, which takes seconds.
const REPEATED_UP_TO: usize = 40;

/// Problems of one cell and size by ours and by another solver.
pub(super) struct Compared {
    pub(super) cell: &'static str,
    pub(super) per_side: usize,
    ours: Vec<Solved>,
    other: Vec<Solved>,
    /// How many of ours SMO did not finish alone.
    past_smo: usize,
}

impl Compared {
    /// Median times of ours and of the other, with their 5th and 95th percentiles, s.
    pub(super) fn seconds(&self) -> [Vec<f64>; 2] {
        [&self.ours, &self.other].map(|list| list.iter().map(|s| s.seconds).collect())
    }

    /// The other's median over that of ours.
    fn speedup(&self) -> f64 {
        let [ours, other] = self.seconds();
        median(&other) / median(&ours)
    }
}

/// What is said before the tables.
const INTRODUCTION: &str = "Random leaf problems in the unit box: a plane against a cap, a wedge or a \
sheet that crosses it, a gap of −0.1 to 0.3. `easy`: γ 5, C 100, r 1, noise 1 to 2 %. `contact`: γ \
10, C 100, r 1, noise 1 to 5 %. `hard`: γ 20, C 1000, r 2 to 6, noise 5 to 10 %. Every solver is \
asked for a relative gap of 1e-4. The gap is recomputed from the multipliers, for all alike; *at the \
gap* counts the problems that reach it. Times include the preparation of the problem. The least of \
several times counts, but for more than 2 × 40 points beside Clarabel, which are solved once. The \
solvers take turns problem by problem. *Ratio*: the other's median time over ours.";

/// Measures the robust problems and those without ellipsoids.
pub(super) fn measure(run: &Run<'_>) -> Result<Section> {
    let robust = each(run.plan.robust, |cell, per_side, count| {
        let solves = if per_side <= REPEATED_UP_TO { run.plan.solves } else { 1 };
        compare(cell, (per_side, count), (run.seed, solves), |_| (), with_clarabel)
    })?;
    let exact = each(run.plan.exact, |cell, per_side, count| {
        let times = (run.seed, run.plan.solves);
        compare(cell, (per_side, count), times, |s| s.radius = 0.0, with_linfa)
    })?;
    let figure = run.figures.join("performance-solvers.svg");
    plots::solvers(&figure, &CELLS.map(|cell| cell.name), &robust)?;
    let mut text = format!("{INTRODUCTION}\n\n");
    write!(
        text,
        "### With ellipsoids, beside Clarabel\n\nOurs is SMO and, where that gives up, the dense \
         interior point method. Clarabel solves the same dual (eq. 13), asked for a tolerance a tenth \
         of the gap.\n\n{}\n![Times of solvers](figures/performance-solvers.svg)\n\nBars reach from \
         the 5th to the 95th percentile over problems.\n\n",
        table(&robust, "Clarabel")
    )?;
    write!(
        text,
        "### Without ellipsoids, beside linfa-svm\n\nThe same problems with r = 0. linfa-svm stops by \
         gradients, not by a gap: it gets the loosest tolerance that reaches the gap, and the search \
         for it is not timed.\n\n{}",
        table(&exact, "linfa-svm")
    )?;
    let mut targets = Vec::new();
    for (per_side, least) in [(40, 50.0), (200, 10.0)] {
        let what = format!(
            "2 × {per_side} points, gap 1e-4: ≥ {least:.0} × as fast as Clarabel, every cell"
        );
        targets.push(target(&robust, per_side, what, least));
    }
    for per_side in [40, 200] {
        let what = format!("2 × {per_side} points, r = 0: not slower than linfa-svm, every cell");
        targets.push(target(&exact, per_side, what, 1.0));
    }
    Ok(Section { title: "Leaf problems", text, targets })
}

fn each(
    sizes: &[(usize, usize)],
    compare: impl Fn(&Cell, usize, usize) -> Result<Compared>,
) -> Result<Vec<Compared>> {
    let mut all = Vec::new();
    for cell in &CELLS {
        for &(per_side, count) in sizes {
            all.push(compare(cell, per_side, count)?);
            eprintln!("bench-report: {} leaf problems of 2 × {per_side} points done", cell.name);
        }
    }
    Ok(all)
}

type Other = fn(&[Sample], f64, usize) -> Result<Solved>;

fn compare(
    cell: &Cell,
    (per_side, count): (usize, usize),
    (seed, repeats): (u64, usize),
    change: fn(&mut Sample),
    other: Other,
) -> Result<Compared> {
    let mut compared =
        Compared { cell: cell.name, per_side, ours: Vec::new(), other: Vec::new(), past_smo: 0 };
    for number in 0..count {
        let from = derive(derive(seed, 6, per_side as u64), number as u64, 0);
        let mut samples = cell.problem(per_side, from);
        samples.iter_mut().for_each(change);
        let (solved, rung) = ours(&samples, cell.gamma, repeats)?;
        compared.ours.push(solved);
        compared.past_smo += usize::from(rung != Rung::Smo);
        compared.other.push(other(&samples, cell.gamma, repeats)?);
    }
    Ok(compared)
}

fn ours(samples: &[Sample], gamma: f64, repeats: usize) -> Result<(Solved, Rung)> {
    let (solved, solution) = solved(samples, gamma, repeats, Solver::solve)?;
    Ok((solved, solution.rung))
}

fn with_clarabel(samples: &[Sample], gamma: f64, repeats: usize) -> Result<Solved> {
    Ok(solved(samples, gamma, repeats, Solver::solve_with_clarabel)?.0)
}

fn with_linfa(samples: &[Sample], gamma: f64, repeats: usize) -> Result<Solved> {
    linfa(samples, gamma, GAP, repeats)
}

fn solved(
    samples: &[Sample],
    gamma: f64,
    repeats: usize,
    solve: fn(&mut Solver, &Problem) -> Solution,
) -> Result<(Solved, Solution)> {
    ensure!(repeats > 0, "nothing is to be solved");
    let settings = Settings { relative_gap: GAP, ..Settings::default() };
    let mut solver = Solver::try_new(settings)?;
    let mut run =
        || Problem::try_new(samples, Kernel::Gaussian { gamma }).map(|p| solve(&mut solver, &p));
    let (solution, mut seconds) = timed(&mut run);
    for _ in 1..repeats {
        seconds = seconds.min(timed(&mut run).1);
    }
    let solution = solution?;
    Ok((Solved { seconds, gap: solution.relative_gap }, solution))
}

fn table(all: &[Compared], other: &str) -> Table {
    let mut header =
        vec!["cell", "points", "problems", "ours, median", "ours, p95", "past SMO", "at the gap"];
    let theirs = [format!("{other}, median"), format!("{other}, p95")];
    header.extend(theirs.iter().map(String::as_str));
    header.extend(["at the gap", "ratio"]);
    let mut table = Table::new(&header);
    for c in all {
        let [ours, other] = c.seconds();
        let at_the_gap = |list: &[Solved]| {
            format!("{} of {}", list.iter().filter(|s| s.gap <= GAP).count(), list.len())
        };
        table.row([
            c.cell.into(),
            format!("2 × {}", c.per_side),
            c.ours.len().to_string(),
            time(median(&ours)),
            time(p95(&ours)),
            c.past_smo.to_string(),
            at_the_gap(&c.ours),
            time(median(&other)),
            time(p95(&other)),
            at_the_gap(&c.other),
            ratio(c.speedup()),
        ]);
    }
    table
}

/// Met where every cell of that size meets it.
fn target(all: &[Compared], per_side: usize, what: String, least: f64) -> Target {
    let of_size: Vec<&Compared> = all.iter().filter(|c| c.per_side == per_side).collect();
    let worst = of_size.iter().map(|c| c.speedup()).fold(f64::INFINITY, f64::min);
    let worst = if of_size.is_empty() { f64::NAN } else { worst };
    let cells: Vec<String> =
        of_size.iter().map(|c| format!("{} {}", c.cell, three_digits(c.speedup()))).collect();
    Target::at_least(what, worst, least, |_| cells.join(", "))
}

#[cfg(test)]
mod tests {
    use super::{super::target, *};

    fn compared(cell: &'static str, ours: f64, other: f64) -> Compared {
        let solved = |seconds| vec![Solved { seconds, gap: 1e-5 }; 3];
        Compared { cell, per_side: 40, ours: solved(ours), other: solved(other), past_smo: 0 }
    }

    #[test]
    fn a_target_is_met_where_every_cell_meets_it() {
        let judged = |all: &[Compared], per_side| {
            target::table(&[target(all, per_side, "t".into(), 50.0)]).to_string()
        };
        let both = [compared("easy", 1e-4, 1e-2), compared("hard", 1e-3, 4e-2)];
        assert!(judged(&both[..1], 40).contains("| easy 100 | yes"));
        assert!(judged(&both, 40).contains("| easy 100, hard 40.0 | **no**"));
        assert!(judged(&both, 200).contains("| not measured | -"));
    }

    #[test]
    fn solvers_of_a_problem_agree() {
        let samples = CELLS[1].problem(10, 1);
        let kernel = Kernel::Gaussian { gamma: CELLS[1].gamma };
        let problem = Problem::try_new(&samples, kernel).unwrap();
        let settings = Settings { relative_gap: GAP, ..Settings::default() };
        let both = {
            let mut solver = Solver::try_new(settings).unwrap();
            [solver.solve(&problem), solver.solve_with_clarabel(&problem)]
        };
        assert!(both.iter().all(|s| s.relative_gap <= GAP));
        assert!((both[0].primal - both[1].primal).abs() <= 2.0 * GAP * both[0].primal);
    }
}

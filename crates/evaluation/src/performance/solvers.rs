//! Leaf problems by our solver, by Clarabel, and without ellipsoids by linfa-svm.

use anyhow::Result;
use cloudtouch_geom::seed::derive;
use cloudtouch_svm::{Kernel, Problem, Rung, Sample, Settings, Solution};

use super::{
    leaf_problems::{CELLS, Cell},
    linfa,
    scene::Scene,
    target::{Findings, Target},
    timing::{curve, least_of, ratio, three_digits, times},
};
use crate::{
    figure::{Axis, Figure, Panel},
    page::Section,
    statistics::median,
    table::Table,
};

/// The relative gap that every solver is asked for.
const GAP: f64 = 1e-4;
/// How often a problem is solved; the least time counts.
const REPEATS: usize = 3;
/// More points of a side than this are solved once beside Clarabel, which takes seconds.
const REPEATED_UP_TO: usize = 40;
/// Points of a side, and the number of problems of each cell, beside either peer.
const BESIDE_CLARABEL: [(usize, usize); 4] = [(20, 30), (40, 30), (100, 6), (200, 3)];
const BESIDE_LINFA: [(usize, usize); 2] = [(40, 30), (200, 15)];

/// The other solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Peer {
    /// On the same problems.
    Clarabel,
    /// On the same without ellipsoids.
    Linfa,
}

/// Problems of one cell and size by ours and by a peer.
struct Compared {
    cell: &'static str,
    per_side: usize,
    /// Of ours and of the peer, s.
    seconds: [Vec<f64>; 2],
    /// How many reach the gap.
    at_the_gap: [usize; 2],
    /// How many of ours SMO did not finish alone.
    past_smo: usize,
}

const INTRODUCTION: &str = "Random leaf problems in the unit box: a plane against a cap, a wedge or a \
sheet that crosses it, a gap of −0.1 to 0.3. `easy`: γ 5, C 100, r 1, noise 1 to 2 %. `contact`: γ \
10, C 100, r 1, noise 1 to 5 %. `hard`: γ 20, C 1000, r 2 to 6, noise 5 to 10 %. Every solver is \
asked for a relative gap of 1e-4. The gap is recomputed from the multipliers, for all alike; *at the \
gap* counts the problems that reach it, by ours and by the other. Times include the preparation of \
the problem. The least of several times counts, but for more than 2 × 40 points beside Clarabel, \
which are solved once. The solvers take turns problem by problem. *Ratio*: the other's median time \
over ours.";

impl Peer {
    fn name(self) -> &'static str {
        if self == Self::Clarabel { "Clarabel" } else { "linfa-svm" }
    }

    /// Every cell at every size.
    fn compare_all(self, seed: u64) -> Result<Vec<Compared>> {
        let sizes: &[(usize, usize)] =
            if self == Self::Clarabel { &BESIDE_CLARABEL } else { &BESIDE_LINFA };
        let all = CELLS.iter().flat_map(|cell| sizes.iter().map(move |&size| (cell, size)));
        all.map(|(cell, (per_side, count))| self.compare(cell, per_side, count, seed)).collect()
    }

    fn compare(self, cell: &Cell, per_side: usize, count: usize, seed: u64) -> Result<Compared> {
        let repeats = if self == Self::Linfa || per_side <= REPEATED_UP_TO { REPEATS } else { 1 };
        let mut compared = Compared {
            cell: cell.name,
            per_side,
            seconds: Default::default(),
            at_the_gap: [0; 2],
            past_smo: 0,
        };
        for number in 0..count {
            let from = derive(derive(seed, 6, per_side as u64), number as u64, 0);
            let mut samples = cell.problem(per_side, from);
            if self == Self::Linfa {
                samples.iter_mut().for_each(|sample| sample.radius = 0.0);
            }
            let (ours, seconds) = least_of(repeats, || solve(&samples, cell, Problem::solve))?;
            compared.past_smo += usize::from(ours.rung != Rung::Smo);
            let theirs = match self {
                Self::Clarabel => {
                    let run = || solve(&samples, cell, Problem::solve_with_clarabel);
                    let (solution, seconds) = least_of(repeats, run)?;
                    (solution.relative_gap, seconds)
                }
                Self::Linfa => linfa::solve(&samples, cell.gamma, GAP, repeats)?,
            };
            for (which, (gap, seconds)) in
                [(ours.relative_gap, seconds), theirs].into_iter().enumerate()
            {
                compared.seconds[which].push(seconds);
                compared.at_the_gap[which] += usize::from(gap <= GAP);
            }
        }
        eprintln!("bench-report: {} leaf problems of 2 × {per_side} points done", cell.name);
        Ok(compared)
    }
}

fn solve(
    samples: &[Sample],
    cell: &Cell,
    solve: fn(&Problem, &Settings) -> Solution,
) -> Result<Solution> {
    let problem = Problem::try_new(samples, Kernel::Gaussian { gamma: cell.gamma })?;
    Ok(solve(&problem, &Settings::with_relative_gap(GAP)?))
}

impl Compared {
    /// The other's median over that of ours.
    fn speedup(&self) -> f64 {
        median(&self.seconds[1]) / median(&self.seconds[0])
    }
}

/// Measures the robust problems and those without ellipsoids.
pub(super) fn measure(scene: &Scene) -> Findings {
    let robust = Peer::Clarabel.compare_all(scene.seed)?;
    let exact = Peer::Linfa.compare_all(scene.seed)?;
    let section = Section::new("Leaf problems")
        .text(INTRODUCTION)
        .text(
            "### With ellipsoids, beside Clarabel\n\nOurs is SMO and, where that gives up, the dense \
             interior point method. Clarabel solves the same dual (eq. 13), asked for a tolerance a \
             tenth of the gap.",
        )
        .text(table(&robust, Peer::Clarabel))
        .figure("performance-solvers", "Times of solvers", figure(&robust))
        .text("Bars reach from the 5th to the 95th percentile over problems.")
        .text(
            "### Without ellipsoids, beside linfa-svm\n\nThe same problems with r = 0. linfa-svm \
             stops by gradients, not by a gap: it gets the loosest tolerance that reaches the gap, \
             and the search for it is not timed.",
        )
        .text(table(&exact, Peer::Linfa));
    let mut targets = Vec::new();
    for (per_side, least) in [(40, 50.0), (200, 10.0)] {
        let what = format!("gap 1e-4: ≥ {least:.0} × as fast as Clarabel, every cell");
        targets.push(target(&robust, per_side, &what, least));
    }
    for per_side in [40, 200] {
        targets.push(target(&exact, per_side, "r = 0: not slower than linfa-svm, every cell", 1.0));
    }
    Ok((section, targets))
}

fn table(all: &[Compared], peer: Peer) -> Table {
    let mut header =
        ["cell", "points", "problems", "at the gap", "past SMO", "ours, median", "ours, p95"]
            .map(str::to_owned)
            .to_vec();
    header.extend(["median", "p95"].map(|part| format!("{}, {part}", peer.name())));
    header.push("ratio".into());
    let mut table = Table::new(header);
    for c in all {
        let problems = c.seconds[0].len();
        let points = format!("2 × {}", c.per_side);
        let [ours, theirs] = c.at_the_gap;
        let mut row = vec![c.cell.into(), points, problems.to_string()];
        row.extend([format!("{ours} and {theirs}"), c.past_smo.to_string()]);
        row.extend(c.seconds.iter().flat_map(|seconds| times(seconds)));
        row.push(ratio(c.speedup()));
        table.row(row);
    }
    table
}

/// Times over the points of a side, a panel for each cell.
fn figure(all: &[Compared]) -> Figure {
    let panel = |cell: &Cell| {
        let panel = Panel::new(Axis::log("points of a side"), Axis::log("time (ms)"));
        let of = |which: usize| -> Vec<(usize, Vec<f64>)> {
            let of_cell = all.iter().filter(|c| c.cell == cell.name);
            of_cell.map(|c| (c.per_side, c.seconds[which].clone())).collect()
        };
        let curves = [curve("ours", &of(0)), curve(Peer::Clarabel.name(), &of(1))];
        curves.into_iter().flatten().fold(panel.title(cell.name), Panel::series)
    };
    let figure = Figure::new("Solvers at a relative gap of 1e-4").columns(CELLS.len());
    CELLS.iter().map(panel).fold(figure, Figure::panel)
}

/// Met where every cell of that size meets it.
fn target(all: &[Compared], per_side: usize, what: &str, least: f64) -> Target {
    let of_size = || all.iter().filter(|c| c.per_side == per_side);
    let worst = of_size().map(Compared::speedup).reduce(f64::min).unwrap_or(f64::NAN);
    let cells: Vec<String> =
        of_size().map(|c| format!("{} {}", c.cell, three_digits(c.speedup()))).collect();
    let what = format!("2 × {per_side} points, {what}");
    Target::at_least(what, worst, least, |_| cells.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compared(cell: &'static str, ours: f64, other: f64) -> Compared {
        let seconds = [ours, other].map(|seconds| vec![seconds; 3]);
        Compared { cell, per_side: 40, seconds, at_the_gap: [3; 2], past_smo: 0 }
    }

    #[test]
    fn a_target_is_met_where_every_cell_meets_it() {
        let met = |all: &[Compared], per_side| target(all, per_side, "t", 50.0).met;
        let both = [compared("easy", 1e-4, 1e-2), compared("hard", 1e-3, 4e-2)];
        assert_eq!(met(&both[..1], 40), Some(true));
        assert_eq!(met(&both, 40), Some(false));
        assert_eq!(met(&both, 200), None);
    }

    #[test]
    fn solvers_of_a_problem_agree() {
        let samples = CELLS[1].problem(10, 1);
        let [ours, theirs] = [Problem::solve, Problem::solve_with_clarabel]
            .map(|with| solve(&samples, &CELLS[1], with).unwrap());
        assert!(ours.relative_gap <= GAP && theirs.relative_gap <= GAP);
        assert!((ours.primal - theirs.primal).abs() <= 2.0 * GAP * ours.primal);
    }
}

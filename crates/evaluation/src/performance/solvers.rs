//! Leaf problems by our solver and by Clarabel.

use anyhow::Result;
use cloudtouch_geom::seed::derive;
use cloudtouch_svm::{Kernel, Problem, Rung, Settings, Solution, Solver};

use super::{
    leaf_problems::{CELLS, Cell},
    target::{Findings, Target},
    timing::{curve, least_of, ratio, three_digits, times},
};
use crate::{
    figure::{Axis, Figure, Panel},
    page::Section,
    statistics::median,
    table::Table,
};

/// The relative gap that both are asked for.
const GAP: f64 = 1e-4;
/// Points of a side, problems of each cell, and how often each is solved; the least time counts.
const SIZES: [(usize, usize, usize); 4] = [(20, 30, 3), (40, 30, 3), (100, 6, 1), (200, 3, 1)];

/// Problems of one cell and size by ours and by Clarabel.
struct Compared {
    cell: &'static str,
    per_side: usize,
    /// Of ours and of Clarabel, s.
    seconds: [Vec<f64>; 2],
    /// How many reach the gap.
    at_the_gap: [usize; 2],
    /// How many of ours SMO did not finish alone.
    past_smo: usize,
}

const INTRODUCTION: &str = "Random leaf problems in the unit box: a plane against a cap, a wedge or a \
sheet that crosses it, a gap of −0.1 to 0.3. `easy`: γ 5, C 100, r 1, noise 1 to 2 %. `contact`: γ \
10, C 100, r 1, noise 1 to 5 %. `hard`: γ 20, C 1000, r 2 to 6, noise 5 to 10 %. Ours is SMO and, \
where that gives up, the dense interior point method; Clarabel solves the same dual (eq. 13), asked \
for a tolerance a tenth of the gap. The gap is recomputed from the multipliers for both alike; *at \
the gap* counts the problems that reach 1e-4. Times include the preparation of the problem; the \
solvers take turns problem by problem, three times up to 2 × 40 points. *Ratio*: Clarabel's median \
time over ours.";

/// Measures every cell at every size.
pub(super) fn measure(seed: u64) -> Findings {
    let all = CELLS.iter().flat_map(|cell| SIZES.iter().map(move |size| (cell, size)));
    let all: Vec<Compared> =
        all.map(|(cell, size)| Compared::measure(cell, *size, seed)).collect::<Result<_>>()?;
    let mut table = Table::new([
        "cell",
        "points",
        "problems",
        "at the gap",
        "past SMO",
        "ours, median",
        "ours, p95",
        "Clarabel, median",
        "Clarabel, p95",
        "ratio",
    ]);
    for c in &all {
        let [ours, theirs] = c.at_the_gap;
        let mut row = vec![c.cell.into(), format!("2 × {}", c.per_side)];
        row.extend([c.seconds[0].len().to_string(), format!("{ours} and {theirs}")]);
        row.push(c.past_smo.to_string());
        row.extend(c.seconds.iter().flat_map(|seconds| times(seconds)));
        row.push(ratio(c.speedup()));
        table.row(row);
    }
    let section = Section::new("Leaf problems").text(INTRODUCTION).text(table);
    let section = section.figure("performance-solvers", "Times of solvers", figure(&all));
    let targets = [(40, 50.0), (200, 10.0)].map(|(per_side, least)| {
        let of_size = || all.iter().filter(|c| c.per_side == per_side);
        let worst = of_size().map(Compared::speedup).fold(f64::INFINITY, f64::min);
        let cells: Vec<String> =
            of_size().map(|c| format!("{} {}", c.cell, three_digits(c.speedup()))).collect();
        let what = format!("2 × {per_side} points, gap 1e-4: ≥ {least} × Clarabel, every cell");
        Target::at_least(what, worst, least, |_| cells.join(", "))
    });
    Ok((section, targets.into()))
}

impl Compared {
    fn measure(
        cell: &Cell,
        (per_side, count, repeats): (usize, usize, usize),
        seed: u64,
    ) -> Result<Self> {
        let seconds = Default::default();
        let mut all = Self { cell: cell.name, per_side, seconds, at_the_gap: [0; 2], past_smo: 0 };
        for number in 0..count {
            let from = derive(derive(seed, 6, per_side as u64), number as u64, 0);
            for (which, with) in
                [Solver::solve, Solver::solve_with_clarabel].into_iter().enumerate()
            {
                let (solution, seconds) = least_of(repeats, || solve(cell, per_side, from, with))?;
                all.seconds[which].push(seconds);
                all.at_the_gap[which] += usize::from(solution.relative_gap <= GAP);
                all.past_smo += usize::from(which == 0 && solution.rung != Rung::Smo);
            }
        }
        Ok(all)
    }

    /// Clarabel's median over that of ours.
    fn speedup(&self) -> f64 {
        median(&self.seconds[1]) / median(&self.seconds[0])
    }
}

fn solve(
    cell: &Cell,
    per_side: usize,
    from: u64,
    with: fn(&mut Solver, &Problem) -> Solution,
) -> Result<Solution> {
    let samples = cell.problem(per_side, from);
    let problem = Problem::try_new(&samples, Kernel::Gaussian { gamma: cell.gamma })?;
    let settings = Settings { relative_gap: GAP, ..Settings::default() };
    Ok(with(&mut Solver::try_new(settings)?, &problem))
}

/// Times over the points of a side, a panel for each cell.
fn figure(all: &[Compared]) -> Figure {
    let panel = |cell: &Cell| {
        let panel = Panel::new(Axis::log("points of a side"), Axis::log("time (ms)"));
        let of = |which: usize| -> Vec<(usize, Vec<f64>)> {
            let of_cell = all.iter().filter(|c| c.cell == cell.name);
            of_cell.map(|c| (c.per_side, c.seconds[which].clone())).collect()
        };
        let curves = [curve("ours", &of(0)), curve("Clarabel", &of(1))];
        curves.into_iter().flatten().fold(panel.title(cell.name), Panel::series)
    };
    let figure = Figure::new("Solvers at a relative gap of 1e-4").columns(CELLS.len());
    CELLS.iter().map(panel).fold(figure, Figure::panel)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solvers_of_a_problem_agree() {
        let [ours, theirs] = [Solver::solve, Solver::solve_with_clarabel]
            .map(|with| solve(&CELLS[1], 10, 1, with).unwrap());
        assert!(ours.relative_gap <= GAP && theirs.relative_gap <= GAP);
        assert!((ours.primal - theirs.primal).abs() <= 2.0 * GAP * ours.primal);
    }
}

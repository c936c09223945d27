//! Leaf problems by our solver and by Clarabel.

use anyhow::Result;
use cloudtouch_geom::seed::{derive, unit};
use cloudtouch_geom::{UncertainPoint, Vector3};
use cloudtouch_svm::{Class, Kernel, Problem, Sample, Settings, Solution, Solver};
use cloudtouch_testkit::facing::patches_over_a_plane;

use super::timing::{least_of, ratio, three_digits, times, within};
use crate::SEED;
use crate::report::{Findings, Section, Table, Target};
use crate::statistics::median;

/// The relative gap that both are asked for.
const GAP: f64 = 1e-4;
/// Points of a side, problems of each cell, and how often each is solved; the least time counts.
const SIZES: [(usize, usize, usize); 4] = [(20, 30, 3), (40, 30, 3), (100, 6, 1), (200, 3, 1)];

/// A kind of leaf problem; lengths in sides of the unit box.
struct Cell {
    name: &'static str,
    /// γ of the Gaussian kernel.
    gamma: f64,
    /// C.
    penalty: f64,
    /// r, from and to.
    radius: [f64; 2],
    /// Standard deviation of the points, from and to.
    noise: [f64; 2],
}

const CELLS: [Cell; 3] = [
    Cell { name: "easy", gamma: 5.0, penalty: 100.0, radius: [1.0, 1.0], noise: [0.01, 0.02] },
    Cell { name: "contact", gamma: 10.0, penalty: 100.0, radius: [1.0, 1.0], noise: [0.01, 0.05] },
    Cell { name: "hard", gamma: 20.0, penalty: 1000.0, radius: [2.0, 6.0], noise: [0.05, 0.1] },
];

/// Problems of one cell and size by ours and by Clarabel.
struct Compared {
    cell: &'static str,
    per_side: usize,
    /// Of ours and of Clarabel, s.
    seconds: [Vec<f64>; 2],
    /// How many reach the gap.
    at_the_gap: [usize; 2],
}

const INTRODUCTION: &str = "Random leaf problems in the unit box: a plane against a cap, a wedge or a sheet that \
crosses it, a gap of −0.1 to 0.3. `easy`: γ 5, C 100, r 1, noise 1 to 2 %. `contact`: γ 10, C 100, r 1, noise 1 to 5 \
%. `hard`: γ 20, C 1000, r 2 to 6, noise 5 to 10 %. Ours is SMO and, where that gives up, the dense interior point \
method; Clarabel solves the same dual (eq. 13), asked for a tolerance a tenth of the gap. The gap is recomputed from \
the multipliers for both alike; *at the gap* counts the problems that reach 1e-4. Times include the preparation of \
the problem; the solvers take turns problem by problem, three times up to 2 × 40 points. *Ratio*: Clarabel's median \
time over ours.";

/// Measures every cell at every size.
pub(super) fn measure() -> Findings {
    let all = CELLS.iter().flat_map(|cell| SIZES.iter().map(move |size| (cell, size)));
    let all: Vec<Compared> =
        all.map(|(cell, size)| Compared::measure(cell, *size)).collect::<Result<_>>()?;
    const HEADER: &str = "cell, points, problems, at the gap, ours median, ours p95, \
                          Clarabel median, Clarabel p95, ratio";
    let mut table = Table::new(HEADER.split(", "));
    for c in &all {
        let [ours, theirs] = c.at_the_gap;
        let mut row = vec![c.cell.into(), format!("2 × {}", c.per_side)];
        row.extend([c.seconds[0].len().to_string(), format!("{ours} and {theirs}")]);
        row.extend(c.seconds.iter().flat_map(|seconds| times(seconds)));
        row.push(ratio(c.speedup()));
        table.row(row);
    }
    let section = Section::new("Leaf problems").text(INTRODUCTION).text(table);
    let patches = all.iter().filter(|c| c.per_side == 20 && c.cell != "hard");
    let patch = patches.map(|c| median(&c.seconds[0])).fold(0.0, f64::max);
    let patch = within("2 × 20 points, gap 1e-4, but for hard ones: median", patch, 60e-6);
    let compared = [(40, 50.0), (200, 10.0)].map(|(per_side, least)| {
        let of_size = || all.iter().filter(|c| c.per_side == per_side);
        let worst = of_size().map(Compared::speedup).fold(f64::INFINITY, f64::min);
        let cells: Vec<String> =
            of_size().map(|c| format!("{} {}", c.cell, three_digits(c.speedup()))).collect();
        let what = format!("2 × {per_side} points, gap 1e-4: ≥ {least} × Clarabel, every cell");
        Target::new(what, cells.join(", "), worst >= least)
    });
    Ok((section, [patch].into_iter().chain(compared).collect()))
}

impl Compared {
    fn measure(cell: &Cell, (per_side, count, repeats): (usize, usize, usize)) -> Result<Self> {
        let seconds = Default::default();
        let mut all = Self { cell: cell.name, per_side, seconds, at_the_gap: [0; 2] };
        for number in 0..count {
            let from = derive(derive(SEED, 6, per_side as u64), number as u64, 0);
            let samples = cell.problem(per_side, from);
            for (which, with) in
                [Solver::solve, Solver::solve_with_clarabel].into_iter().enumerate()
            {
                let (solution, seconds) = least_of(repeats, || solve(cell, &samples, with))?;
                all.seconds[which].push(seconds);
                all.at_the_gap[which] += usize::from(solution.relative_gap <= GAP);
            }
        }
        Ok(all)
    }

    /// Clarabel's median over that of ours.
    fn speedup(&self) -> f64 {
        median(&self.seconds[1]) / median(&self.seconds[0])
    }
}

impl Cell {
    /// A problem of this kind, with equal or lopsided noise.
    fn problem(&self, per_side: usize, from: u64) -> Vec<Sample> {
        let draw = |k| unit(derive(from, 0, k));
        let between = |[low, high]: [f64; 2], k| low + (high - low) * draw(k);
        let root = if draw(4) < 0.5 { Vector3::repeat(1.0) } else { Vector3::new(0.2, 0.5, 1.0) };
        let (gap, std) = (between([-0.1, 0.3], 0), root * between(self.noise, 1));
        let (radius, penalty) = (between(self.radius, 2), self.penalty);
        let sides = [Class::A, Class::B].into_iter();
        let sides = sides.zip(patches_over_a_plane(per_side, gap, &std, from));
        let of = |(class, points): (Class, Vec<UncertainPoint>)| {
            points.into_iter().map(move |point| Sample { point, class, radius, penalty })
        };
        sides.flat_map(of).collect()
    }
}

fn solve(
    cell: &Cell,
    samples: &[Sample],
    with: fn(&mut Solver, &Problem) -> Solution,
) -> Result<Solution> {
    let problem = Problem::new(samples, Kernel::Gaussian { gamma: cell.gamma })?;
    let settings = Settings { relative_gap: GAP, ..Settings::default() };
    Ok(with(&mut Solver::new(settings)?, &problem))
}

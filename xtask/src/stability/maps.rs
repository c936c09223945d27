//! Steps, gap and fallbacks of the solver over its settings, the noise, and units and offsets.

use std::path::Path;

use anyhow::{Context, Result};
use cloudtouch_geom::{UncertainPoint, Vector3};
use cloudtouch_svm::Rung;
use rayon::prelude::*;

use super::{
    heat_map::{Panel, Scale, Side, draw},
    leaf::{GAMMA, KINDS, Leaves, PENALTY, Solved, largest_difference, leaves, solve},
    sheet::{Sheet, small},
};
use crate::common::{statistics::quantile, table::Table};

/// Gap and noise of the harmless problems in the other two maps, box lengths.
const GAP: f64 = 0.05;
const STD: f64 = 0.02;

/// What the section says before its figures.
const INTRODUCTION: &str = "Each cell is six leaf problems of 40 points a side, in the unit box and \
with balanced penalties as in a query: a cap, a wedge and a slanted sheet over a plane, each with \
equal and with lopsided noise. Steps are the median, gaps and differences the largest of the six. \
*Past SMO*: the share that went on to the interior point method; *fallback*: the share that \
Clarabel had to answer, or that nothing answered. The outlined cell is the default.";

/// One grid of problems, before it is solved.
struct Map {
    file: &'static str,
    title: &'static str,
    text: &'static str,
    x: Side,
    y: Side,
    marked: (usize, usize),
    /// The largest change of a probability takes the place of what went past SMO.
    shows_change: bool,
}

/// What solving the problems of one cell took.
#[derive(Debug, Clone, Copy)]
struct Cell {
    steps: f64,
    gap: f64,
    past_smo: f64,
    fallback: f64,
    undecided: f64,
    /// Largest change of a probability against the problem that stays where it is.
    change: f64,
}

/// Solves all three maps, draws them and adds the section.
pub(super) fn run(sheet: &mut Sheet, folder: &Path) -> Result<()> {
    let mut text = INTRODUCTION.to_owned();
    let mut summary = Table::new(&[
        "map",
        "problems",
        "past SMO",
        "fallback",
        "undecided",
        "largest gap",
        "largest change of P",
    ]);
    let maps: [(Map, Vec<Vec<Cell>>, bool); 3] =
        [settings()?, noise()?, units()?].map(|(map, cells)| (map.0, cells, map.1));
    for (map, cells, is_default) in &maps {
        map.draw(folder, cells)?;
        text += &format!(
            "\n\n### {}\n\n{}\n\n![{}](figures/{})",
            map.title, map.text, map.title, map.file
        );
        let all: Vec<Cell> =
            cells.iter().flatten().filter(|c| !c.steps.is_nan()).copied().collect();
        let mean = |of: fn(&Cell) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
        let most = |of: fn(&Cell) -> f64| all.iter().map(of).fold(0.0, f64::max);
        let percent = |share: f64| format!("{:.2} %", 100.0 * share);
        let [fallback, undecided] = [mean(|c| c.fallback), mean(|c| c.undecided)];
        summary.row([
            map.title.into(),
            (all.len() * KINDS as usize).to_string(),
            percent(mean(|c| c.past_smo)),
            percent(fallback),
            percent(undecided),
            small(most(|c| c.gap)),
            if map.shows_change { small(most(|c| c.change)) } else { String::new() },
        ]);
        if *is_default {
            sheet.goal(
                format!("{}: fallbacks below 1 %, nothing undecided", map.title.to_lowercase()),
                format!("{} and {}", percent(fallback), percent(undecided)),
                fallback < 0.01 && undecided == 0.0,
            );
        }
    }
    sheet.section("Maps", format!("{text}\n\n### All cells\n\n{summary}"));
    Ok(())
}

/// A map and whether a default query can reach every cell, with its solved cells.
type Solution = ((Map, bool), Vec<Vec<Cell>>);

fn settings() -> Result<Solution> {
    let (gammas, penalties) = (-6..=6, -3..=9);
    let map = Map {
        file: "stability-settings.svg",
        title: "Kernel width and penalty",
        text: "A gap of 5 % of the box with noise of 2 %.",
        x: Side { name: "γ", labels: powers(gammas.clone()) },
        y: Side { name: "C", labels: powers(penalties.clone()) },
        marked: (7, 5),
        shows_change: false,
    };
    let at: Vec<(f64, f64)> = penalties
        .flat_map(|c| gammas.clone().map(move |g| (10_f64.powi(g), 10_f64.powi(c))))
        .collect();
    let columns = map.x.labels.len();
    let cells = grid(&at, columns, |&(gamma, penalty)| {
        cell(|kind| Some((solve(&leaves(GAP, STD, kind), gamma, penalty)?, None)))
    })?;
    Ok(((map, false), cells))
}

fn noise() -> Result<Solution> {
    let gaps: Vec<f64> = (0..13).map(|i| 0.04 * f64::from(i) - 0.16).collect();
    let stds = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5];
    let map = Map {
        file: "stability-noise.svg",
        title: "Noise and gap",
        text: "Default γ and C. Where noise is as large as the leaf, most problems collapse: that \
               is an answer.",
        x: Side {
            name: "gap (box lengths)",
            labels: gaps.iter().map(|g| format!("{g:.2}")).collect(),
        },
        y: Side { name: "std (box lengths)", labels: stds.iter().map(f64::to_string).collect() },
        marked: (5, 4),
        shows_change: false,
    };
    let at: Vec<(f64, f64)> =
        stds.iter().flat_map(|&std| gaps.iter().map(move |&gap| (gap, std))).collect();
    let cells = grid(&at, gaps.len(), |&(gap, std)| {
        cell(|kind| Some((solve(&leaves(gap, std, kind), GAMMA, PENALTY)?, None)))
    })?;
    Ok(((map, true), cells))
}

fn units() -> Result<Solution> {
    let scales = -6..=6;
    let offsets: Vec<f64> = std::iter::once(0.0).chain((0..=7).map(|e| 10_f64.powi(e))).collect();
    let map = Map {
        file: "stability-units.svg",
        title: "Scale and offset",
        text: "The same leaf scaled with its covariances, then moved by an offset along each axis. \
               Grey: coordinates are rounded by more than a thousandth of the noise, so that the \
               points themselves are other ones.",
        x: Side { name: "scale", labels: powers(scales.clone()) },
        y: Side {
            name: "offset (m)",
            labels: offsets
                .iter()
                .map(|o| if *o == 0.0 { "0".into() } else { format!("{o:.0e}") })
                .collect(),
        },
        marked: (6, 0),
        shows_change: true,
    };
    let at: Vec<(f64, f64)> = offsets
        .iter()
        .flat_map(|&offset| scales.clone().map(move |s| (10_f64.powi(s), offset)))
        .collect();
    let cells = grid(&at, 13, |&(scale, offset)| {
        if offset * f64::EPSILON > 1e-3 * STD * scale {
            return Some(Cell::nothing());
        }
        cell(|kind| {
            let still = leaves(GAP, STD, kind);
            let placed = placed(&still, scale, offset);
            let still = solve(&still, GAMMA, PENALTY)?;
            let solved = solve(&placed, GAMMA, PENALTY)?;
            let change = largest_difference(&still.probabilities, &solved.probabilities);
            Some((solved, change))
        })
    })?;
    Ok(((map, true), cells))
}

fn powers(exponents: std::ops::RangeInclusive<i32>) -> Vec<String> {
    exponents.map(|e| format!("1e{e}")).collect()
}

fn placed(leaves: &Leaves, scale: f64, offset: f64) -> Leaves {
    let place = |p: &UncertainPoint| UncertainPoint {
        mean: p.mean * scale + Vector3::repeat(offset),
        covariance: p.covariance.scaled(scale),
    };
    [0, 1].map(|side| leaves[side].iter().map(place).collect())
}

/// Solves the cells in parallel and splits them into rows.
fn grid(
    at: &[(f64, f64)],
    columns: usize,
    solve: impl Fn(&(f64, f64)) -> Option<Cell> + Sync + Send,
) -> Result<Vec<Vec<Cell>>> {
    let cells: Option<Vec<Cell>> = at.par_iter().map(solve).collect();
    let cells = cells.context("a leaf of finite points makes a problem")?;
    Ok(cells.chunks(columns).map(<[Cell]>::to_vec).collect())
}

/// Solves one problem of each kind.
fn cell(solve: impl Fn(u64) -> Option<(Solved, Option<f64>)>) -> Option<Cell> {
    let all: Vec<(Solved, Option<f64>)> = (0..KINDS).map(solve).collect::<Option<_>>()?;
    let share = |of: &dyn Fn(&Solved) -> bool| {
        all.iter().filter(|(solved, _)| of(solved)).count() as f64 / all.len() as f64
    };
    let steps: Vec<f64> = all.iter().map(|(s, _)| s.solution.effort.smo_steps as f64).collect();
    Some(Cell {
        steps: quantile(&steps, 0.5),
        gap: all.iter().map(|(s, _)| s.solution.relative_gap).fold(0.0, f64::max),
        past_smo: share(&|s| s.solution.rung != Rung::Smo || s.is_undecided()),
        fallback: share(&|s| s.fell_back() || s.is_undecided()),
        undecided: share(&Solved::is_undecided),
        change: all.iter().filter_map(|(_, change)| *change).fold(0.0, f64::max),
    })
}

impl Cell {
    /// A cell that has no problem to solve.
    fn nothing() -> Self {
        let none = f64::NAN;
        Self {
            steps: none,
            gap: none,
            past_smo: none,
            fallback: none,
            undecided: none,
            change: none,
        }
    }
}

impl Map {
    fn draw(&self, folder: &Path, cells: &[Vec<Cell>]) -> Result<()> {
        let panel = |title, scale, of: fn(&Cell) -> f64| Panel {
            title,
            scale,
            values: cells.iter().map(|row| row.iter().map(of).collect()).collect(),
        };
        let third = if self.shows_change {
            panel("largest change of a probability", Scale::Decades(-12, 0), |c| c.change)
        } else {
            panel("past SMO", Scale::Share, |c| c.past_smo)
        };
        let panels = [
            panel("steps", Scale::Decades(0, 5), |c| c.steps),
            panel("relative gap", Scale::Decades(-8, 0), |c| c.gap),
            third,
            panel("fallback", Scale::Share, |c| c.fallback),
        ];
        draw(&folder.join(self.file), &self.x, &self.y, self.marked, &panels)
    }
}

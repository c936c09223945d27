//! The solver over its settings, over noise and gap, and over units and offsets.

use anyhow::{Context, Result};
use cloudtouch_geom::{Pose, Vector3};
use rayon::prelude::*;

use super::{
    shapes::{Clouds, KINDS, clouds, placed},
    sheet::{Sheet, small},
    solver::{GAMMA, PENALTY, Posed, Solved, largest_difference},
};
use crate::{page::Section, statistics::median, table::Table};

/// Points of each side, as many as a leaf holds.
const POINTS: u64 = 40;
/// Gap and noise of harmless problems, box lengths.
const GAP: f64 = 0.05;
const STD: f64 = 0.02;

const INTRODUCTION: &str = "Leaf problems of 40 points a side, in the unit box and with balanced \
penalties as in a query: a cap, a wedge and a slanted sheet over a plane, each with equal and with \
lopsided noise. *Past SMO* went on to the interior point method; *fallback*: Clarabel had to answer, \
or nothing did. *Settings*: γ from 1e-6 to 1e6 and C from 1e-3 to 1e9, a gap of 5 % of the box, noise \
of 2 %; most of it is out of the reach of a default query, and no goal. *Noise and gap*: from an \
overlap of 16 % to a gap of 32 %, noise of 0.1 to 50 %; where noise is as large as the leaf, most \
problems collapse: that is an answer. *Scale and offset*: scaled by 1e-6 to 1e6 with the covariances, \
then moved by up to 1e7 m, unless that rounds coordinates by more than a thousandth of the noise; the \
change is against the problem that stays where it is.";

/// A solved problem, with the change of a probability against another one where there is one.
type Cell = (Solved, Option<f64>);

/// Solves all three grids and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let powers = |range: std::ops::RangeInclusive<i32>| range.map(|e| 10_f64.powi(e));
    let all_pairs = |x: Vec<f64>, y: Vec<f64>| -> Vec<(f64, f64)> {
        y.iter().flat_map(|&y| x.iter().map(move |&x| (x, y))).collect()
    };
    let settings = all_pairs(powers(-6..=6).collect(), powers(-3..=9).collect());
    let gaps = (0..13).map(|i| 0.04 * f64::from(i) - 0.16).collect();
    let noise = all_pairs(gaps, vec![0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5]);
    let offsets = std::iter::once(0.0).chain(powers(0..=7)).collect();
    let mut units = all_pairs(powers(-6..=6).collect(), offsets);
    units.retain(|(scale, offset)| offset * f64::EPSILON <= 1e-3 * STD * scale);

    let mut table = Table::new([
        "grid",
        "problems",
        "steps: median, most",
        "past SMO",
        "fallback",
        "undecided",
        "largest gap",
        "largest change of P",
    ]);
    let of_settings = solve_all(&settings, |kind, (gamma, penalty)| {
        Some((solve(&clouds(POINTS, GAP, STD, kind), gamma, penalty)?, None))
    })?;
    summarize(sheet, &mut table, "settings", &of_settings, false);
    let of_noise = solve_all(&noise, |kind, (gap, std)| {
        Some((solve(&clouds(POINTS, gap, std, kind), GAMMA, PENALTY)?, None))
    })?;
    summarize(sheet, &mut table, "noise and gap", &of_noise, true);
    let of_units = solve_all(&units, |kind, (scale, offset)| {
        let still = clouds(POINTS, GAP, STD, kind);
        let moved = solve(
            &placed(&still, &Pose::from_translation(Vector3::repeat(offset)), scale),
            GAMMA,
            PENALTY,
        )?;
        let still = solve(&still, GAMMA, PENALTY)?;
        let change = largest_difference(&still.probabilities, &moved.probabilities);
        Some((moved, change))
    })?;
    summarize(sheet, &mut table, "scale and offset", &of_units, true);
    sheet.sections.push(Section::new("Grids of problems").text(INTRODUCTION).text(table));
    Ok(())
}

/// One problem of each kind in each cell.
fn solve_all(
    cells: &[(f64, f64)],
    solve: impl Fn(u64, (f64, f64)) -> Option<Cell> + Sync,
) -> Result<Vec<Cell>> {
    let of_cell = |&at: &(f64, f64)| (0..KINDS).map(|kind| solve(kind, at)).collect::<Vec<_>>();
    let solved: Option<Vec<Cell>> = cells.par_iter().flat_map_iter(of_cell).collect();
    solved.context("a leaf of finite points makes a problem")
}

/// The row of a grid, and its goal if default queries reach all of it.
fn summarize(sheet: &mut Sheet, table: &mut Table, name: &str, cells: &[Cell], is_goal: bool) {
    let share = |of: fn(&Solved) -> bool| {
        cells.iter().filter(|(solved, _)| of(solved)).count() as f64 / cells.len() as f64
    };
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    let steps: Vec<f64> = cells.iter().map(|(solved, _)| solved.steps() as f64).collect();
    let fallback = share(|solved| solved.fell_back() || solved.is_undecided());
    let undecided = share(Solved::is_undecided);
    let most = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::NAN, f64::max);
    let change = most(&mut cells.iter().filter_map(|(_, change)| *change));
    table.row([
        name.to_owned(),
        cells.len().to_string(),
        format!("{:.0}, {:.0}", median(&steps), most(&mut steps.iter().copied())),
        percent(share(Solved::is_past_smo)),
        percent(fallback),
        percent(undecided),
        small(most(&mut cells.iter().map(|(solved, _)| solved.gap()))),
        if change.is_nan() { "-".into() } else { small(change) },
    ]);
    if is_goal {
        sheet.goal(
            format!("{name}: fallbacks below 1 %, nothing undecided"),
            format!("{} and {}", percent(fallback), percent(undecided)),
            fallback < 0.01 && undecided == 0.0,
        );
    }
}

fn solve([a, b]: &Clouds, gamma: f64, penalty: f64) -> Option<Solved> {
    Solved::new(&Posed::of_leaves([a, b], gamma, penalty)?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn leaves_far_apart_are_free_and_leaves_that_overlap_are_less_so() {
        for kind in 0..KINDS {
            let largest = |gap: f64| {
                let solved = solve(&clouds(POINTS, gap, 0.01, kind), GAMMA, PENALTY).unwrap();
                assert!(!solved.is_undecided());
                solved.probabilities.unwrap().into_iter().fold(0.0, f64::max)
            };
            let [far, within] = [0.3, -0.1].map(largest);
            // A kernel surface can bend between points of sheets that cross.
            assert!(far < 1e-3 && within > 0.05, "kind {kind}: {far} and {within}");
        }
    }
}

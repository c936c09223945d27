//! Observed rates of collisions against probabilities, with the number of answers below.

use std::path::Path;

use anyhow::Result;

use super::lines::{PANEL, Point, Series, draw_series, range_of};
use crate::{
    common::draw::{Axis, Style, figure, frame, guide, legend, legend_width},
    sweep::measures::Bin,
};

/// Height of the panel of counts, pixels.
const COUNTS: u32 = 190;

/// Rates of fewer answers than this are left out: they jump about and say nothing.
const FEWEST: usize = 10;

/// Draws the bins of each method or family, named.
///
/// A forecaster is calibrated where its bars reach the diagonal; bins of fewer than ten answers
/// show in the counts only. Counts have a logarithmic axis,
/// since most answers are near 0 or 1.
///
/// # Errors
///
/// When the file cannot be written.
pub(crate) fn reliability(path: &Path, title: &str, series: &[(String, Vec<Bin>)]) -> Result<()> {
    let names: Vec<(String, Style)> = series
        .iter()
        .enumerate()
        .map(|(number, (name, _))| (name.clone(), Style::of_series(number)))
        .collect();
    let rates = lines(series, FEWEST, |bin| Point {
        x: bin.mean,
        y: bin.observed,
        range: Some(bin.interval),
    });
    let counts =
        lines(series, 1, |bin| Point { x: bin.mean, y: (bin.count as f64).log10(), range: None });
    let largest = range_of(counts.iter().flat_map(|s| &s.points).map(|p| p.y)).end;
    let width = PANEL.0 + 40;
    let side = legend_width(names.iter().map(|(name, _)| name.as_str()));
    figure(path, (width + side, width + COUNTS), |area| {
        let (area, side) = area.split_horizontally(width);
        let (upper, lower) = area.split_vertically(width);
        let x = Axis::unit("collision probability (mean of the bin)");
        let mut chart = frame(&upper, title, &x, &Axis::unit("observed rate of collisions"))?;
        guide(&mut chart, (0.0, 0.0), (1.0, 1.0))?;
        for series in rates.iter().rev() {
            draw_series(&mut chart, series)?;
        }
        let y = Axis::logarithmic("answers", 0.0..largest.max(1.0));
        let mut chart = frame(&lower, "", &x, &y)?;
        for series in counts.iter().rev() {
            draw_series(&mut chart, series)?;
        }
        legend(&side, &names)
    })
}

/// A line for each series through its bins of at least so many answers.
fn lines(
    series: &[(String, Vec<Bin>)],
    fewest: usize,
    point: impl Fn(&Bin) -> Point,
) -> Vec<Series> {
    let line = |(number, (_, bins)): (usize, &(String, Vec<Bin>))| Series {
        style: Style::of_series(number),
        points: bins.iter().filter(|bin| bin.count >= fewest).map(&point).collect(),
    };
    series.iter().enumerate().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::{
        super::{lines::tests::drawn, samples},
        *,
    };
    use crate::sweep::measures;

    #[test]
    fn every_bin_is_a_point_below_and_above_when_it_has_enough_answers() {
        let answers = samples::answers(100);
        let series = ["a", "b"].map(|family| {
            let judged = samples::pick(&answers, |c| c.family == family);
            let bins = measures::reliability(&judged.samples()[0], &judged.clusters);
            (format!("family {family}"), bins)
        });
        let svg = drawn("reliability", |path| reliability(path, "ours", &series));
        // The first series has circles, also in the legend.
        let bins = &series[0].1;
        let rates = bins.iter().filter(|bin| bin.count >= FEWEST).count();
        assert!(0 < rates && rates < bins.len());
        assert_eq!(svg.matches("<circle").count(), bins.len() + rates + 1);
        assert!(svg.contains("family b") && svg.contains("observed rate of collisions"));
    }
}

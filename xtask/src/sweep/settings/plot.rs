//! The figure: time against error, the values of one setting in one colour.

use std::path::Path;

use anyhow::Result;
use plotters::prelude::*;

use super::changes::Setting;
use crate::{
    common::draw::{
        Area, Axis, GREY, Marker, Style, VERMILION, failed, figure, frame, legend, legend_width,
        spots,
    },
    sweep::plots::{
        Tradeoff,
        labels::place,
        lines::{Point, Series, draw_series, range_of},
        pareto::staircase,
    },
};

/// Size of a panel, pixels.
const PANEL: (u32, u32) = (560, 460);
/// Points nearer to the default than this have no label: it would hide others, pixels.
const CLOSE: i32 = 24;

/// What is drawn upward.
type ErrorOf = fn(&Tradeoff) -> f64;

/// Draws median time against Brier score and against 1 − AUC, with the front that nothing beats.
///
/// # Errors
///
/// When the file cannot be written.
pub(super) fn draw(path: &Path, settings: &[Setting], tradeoffs: &[Tradeoff]) -> Result<()> {
    let mut changed: Vec<&str> = settings.iter().skip(1).map(|s| s.changed).collect();
    changed.dedup();
    let style = |number| Style { line: false, ..Style::of_series(number) };
    let default = Style { color: VERMILION, line: false, marker: Some(Marker::Diamond) };
    let front = Style { color: GREY, line: true, marker: None };
    let mut names = vec![("default".to_owned(), default), ("front".to_owned(), front)];
    names.extend(changed.iter().enumerate().map(|(i, name)| ((*name).to_owned(), style(i))));
    let side = legend_width(names.iter().map(|(name, _)| name.as_str()));
    figure(path, (2 * PANEL.0 + side, PANEL.1), |area| {
        let (area, side) = area.split_horizontally(2 * PANEL.0);
        let parts = area.split_evenly((1, 2));
        let errors: [(&str, ErrorOf); 2] =
            [("Brier score", |t| t.brier.value), ("1 − AUC", |t| 1.0 - t.auc.value)];
        for (part, (name, error)) in parts.iter().zip(errors) {
            let points: Vec<(f64, f64)> =
                tradeoffs.iter().map(|t| (t.query_ms.log10(), error(t))).collect();
            let of_setting = |number: usize| {
                let is_of = |s: &Setting| s.changed == changed[number];
                let own = settings.iter().zip(&points).filter(|(s, _)| is_of(s));
                let points = own.map(|(_, &(x, y))| Point { x, y, range: None }).collect();
                Series { style: style(number), points }
            };
            let series: Vec<Series> = (0..changed.len()).map(of_setting).collect();
            panel(part, name, settings, &points, &series)?;
        }
        legend(&side, &names)
    })
}

fn panel(
    area: &Area<'_>,
    y_name: &str,
    settings: &[Setting],
    points: &[(f64, f64)],
    series: &[Series],
) -> Result<()> {
    let finite = || points.iter().filter(|p| p.0.is_finite() && p.1.is_finite());
    let times = range_of(finite().map(|p| p.0));
    let x = Axis::logarithmic("median query time (ms)", times.start - 0.1..times.end + 0.15);
    let y = Axis::new(y_name, range_of(finite().map(|p| p.1)), 3);
    let mut chart = frame(area, &format!("{y_name} against time"), &x, &y)?;
    let stairs = staircase(&finite().copied().collect::<Vec<_>>());
    chart.draw_series(LineSeries::new(stairs, GREY.mix(0.6).stroke_width(2))).map_err(failed)?;
    for series in series {
        draw_series(&mut chart, series)?;
    }
    spots(&mut chart, points.first().copied(), Marker::Diamond, 7, VERMILION)?;
    let pixels: Vec<(i32, i32)> = points.iter().map(|at| chart.backend_coord(at)).collect();
    let Some(&default) = pixels.first() else { return Ok(()) };
    let is_far = |p: (i32, i32)| (p.0 - default.0).abs().max((p.1 - default.1).abs()) > CLOSE;
    let names: Vec<&str> = settings
        .iter()
        .zip(&pixels)
        .map(|(s, &at)| if is_far(at) { s.value.as_str() } else { "" })
        .collect();
    let (columns, rows) = chart.plotting_area().get_pixel_range();
    let base = area.get_base_pixel();
    for (name, at) in names.iter().zip(place(&names, &pixels, &[], columns, rows)) {
        let font = ("sans-serif", 13).into_font();
        let text = Text::new((*name).to_owned(), (at.0 - base.0, at.1 - base.1), font);
        area.draw(&text).map_err(failed)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{super::changes, *};
    use crate::sweep::{measures::Estimate, plots::lines::tests::drawn};

    #[test]
    fn every_setting_is_a_point_in_both_panels_and_in_the_legend() {
        let settings = changes::all();
        let about = |value: f64| Estimate { value, low: value - 0.01, high: value + 0.01 };
        let tradeoff = |(i, setting): (usize, &Setting)| Tradeoff {
            name: setting.name(),
            query_ms: 1.0 + i as f64,
            brier: about(0.1 + 0.01 * (i % 5) as f64),
            auc: about(0.9),
            is_default: i == 0,
        };
        let tradeoffs: Vec<Tradeoff> = settings.iter().enumerate().map(tradeoff).collect();
        let svg = drawn("settings", |path| draw(path, &settings, &tradeoffs));
        let circles = |name| settings.iter().filter(|s| s.changed == name).count();
        // The first and the sixth of the changed settings are circles.
        assert_eq!(svg.matches("<circle").count(), 2 * (circles("n_max") + circles("C")) + 2);
        assert_eq!(svg.matches("\nγ\n").count(), 1);
        assert_eq!(svg.matches("\n80\n").count(), 2);
    }
}

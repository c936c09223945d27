//! Query time against error, with the trade-offs that nothing beats.

use std::path::Path;

use anyhow::Result;
use plotters::prelude::*;

use super::{
    labels::place,
    lines::{PANEL, range_of},
    pareto::{on_front, staircase},
};
use crate::{
    common::draw::{
        Area, Axis, BLUE, GREY, Marker, Style, VERMILION, failed, figure, frame, legend,
        legend_width, spots as draw_spots,
    },
    sweep::measures::Estimate,
};

/// One method or setting.
#[derive(Debug, Clone)]
pub(crate) struct Tradeoff {
    pub(crate) name: String,
    /// Time of a query, ms.
    pub(crate) query_ms: f64,
    pub(crate) brier: Estimate,
    pub(crate) auc: Estimate,
    /// Whether it is the setting that users get.
    pub(crate) is_default: bool,
}

/// Draws time against the Brier score and against 1 − AUC: down and to the left is better.
///
/// What has no such measure (a method without probabilities, say) is left out of that panel.
///
/// # Errors
///
/// When the file cannot be written.
pub(crate) fn speed(path: &Path, x_name: &str, all: &[Tradeoff]) -> Result<()> {
    let missed = |auc: Estimate| Estimate {
        value: 1.0 - auc.value,
        low: 1.0 - auc.high,
        high: 1.0 - auc.low,
    };
    let spots = |error: &dyn Fn(&Tradeoff) -> Estimate| -> Vec<Place> {
        let spot = |t: &Tradeoff| Place {
            name: t.name.clone(),
            x: t.query_ms.log10(),
            error: error(t),
            is_default: t.is_default,
        };
        all.iter().map(spot).filter(|s| s.x.is_finite() && s.error.value.is_finite()).collect()
    };
    let look = |color, marker, line| Style { color, line, marker };
    let names = [
        ("default".to_owned(), look(VERMILION, Some(Marker::Diamond), false)),
        ("on the front".to_owned(), look(BLUE, Some(Marker::Circle), true)),
        ("beaten".to_owned(), look(GREY, Some(Marker::Circle), false)),
    ];
    let width = 2 * PANEL.0 + 120;
    let side = legend_width(names.iter().map(|(name, _)| name.as_str()));
    figure(path, (width + side, PANEL.1 + 60), |area| {
        let (area, side) = area.split_horizontally(width);
        let parts = area.split_evenly((1, 2));
        draw_panel(&parts[0], x_name, "Brier score", &spots(&|t| t.brier))?;
        draw_panel(&parts[1], x_name, "1 − AUC", &spots(&|t| missed(t.auc)))?;
        legend(&side, &names)
    })
}

struct Place {
    name: String,
    /// Decadic logarithm of the time.
    x: f64,
    error: Estimate,
    is_default: bool,
}

fn draw_panel(area: &Area<'_>, x_name: &str, y_name: &str, spots: &[Place]) -> Result<()> {
    let times = range_of(spots.iter().map(|s| s.x));
    let x = Axis::logarithmic(x_name, times.start - 0.15..times.end + 0.15);
    let errors = range_of(spots.iter().flat_map(|s| [s.error.low, s.error.value, s.error.high]));
    let title = format!("{y_name} against time");
    let mut chart = frame(area, &title, &x, &Axis::new(y_name, 0.0..errors.end, 2))?;
    let points: Vec<(f64, f64)> = spots.iter().map(|s| (s.x, s.error.value)).collect();
    let stairs = staircase(&points);
    let line = LineSeries::new(stairs.clone(), BLUE.mix(0.5).stroke_width(2));
    chart.draw_series(line).map_err(failed)?;
    for (spot, is_on_front) in spots.iter().zip(on_front(&points)) {
        let color = if is_on_front { BLUE } else { GREY };
        let bar = vec![(spot.x, spot.error.low), (spot.x, spot.error.high)];
        let bar = PathElement::new(bar, color.mix(0.6).stroke_width(1));
        chart.draw_series([bar]).map_err(failed)?;
        let at = (spot.x, spot.error.value);
        if spot.is_default {
            draw_spots(&mut chart, [at], Marker::Diamond, 7, VERMILION)?;
        } else {
            draw_spots(&mut chart, [at], Marker::Circle, 5, color)?;
        }
    }
    // Names go where they hide neither a point nor one another.
    let pixels: Vec<(i32, i32)> = points.iter().map(|at| chart.backend_coord(at)).collect();
    let bars = spots.iter().map(|s| [(s.x, s.error.low), (s.x, s.error.high)]);
    let stairs = stairs.windows(2).map(|pair| [pair[0], pair[1]]);
    let lines: Vec<[i32; 4]> = bars
        .chain(stairs)
        .map(|ends| ends.map(|end| chart.backend_coord(&end)))
        .map(|[a, b]| [a.0.min(b.0) - 2, a.1.min(b.1) - 2, a.0.max(b.0) + 2, a.1.max(b.1) + 2])
        .collect();
    let (columns, rows) = chart.plotting_area().get_pixel_range();
    let names: Vec<&str> = spots.iter().map(|s| s.name.as_str()).collect();
    let base = area.get_base_pixel();
    for (spot, at) in spots.iter().zip(place(&names, &pixels, &lines, columns, rows)) {
        let font = ("sans-serif", 13).into_font();
        let font = if spot.is_default { font.style(FontStyle::Bold) } else { font };
        let at = (at.0 - base.0, at.1 - base.1);
        area.draw(&Text::new(spot.name.clone(), at, font)).map_err(failed)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{super::lines::tests::drawn, *};

    fn tradeoff(name: &str, query_ms: f64, brier: f64, auc: f64) -> Tradeoff {
        let about = |value: f64| Estimate { value, low: value - 0.01, high: value + 0.01 };
        let is_default = name == "calibrated";
        Tradeoff {
            name: name.to_owned(),
            query_ms,
            brier: about(brier),
            auc: about(auc),
            is_default,
        }
    }

    #[test]
    fn every_setting_is_named_in_both_panels() {
        let all = [
            tradeoff("calibrated", 8.0, 0.075, 0.967),
            tradeoff("calibrated, 4 threads", 3.0, 0.075, 0.967),
            tradeoff("paper", 55.0, 0.098, 0.954),
            tradeoff("oracle", 9.0, 0.054, 0.984),
            tradeoff("minimum distance", 0.4, 0.112, 0.922),
            tradeoff("5th smallest", 0.5, 0.108, 0.925),
            tradeoff("smoothed", 1.4, 0.087, 0.956),
            tradeoff("voxels 1 cm", 0.05, 0.16, 0.87),
            tradeoff("plain SVM", 70.0, f64::NAN, 0.93),
        ];
        let svg = drawn("speed", |path| speed(path, "median time of a query (ms)", &all));
        for t in &all {
            let count = svg.matches(&format!("\n{}\n", t.name)).count();
            assert_eq!(count, if t.brier.value.is_nan() { 1 } else { 2 }, "{}", t.name);
        }
        assert!(svg.contains("1 − AUC against time"));
    }
}

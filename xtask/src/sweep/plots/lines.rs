//! Panels of lines with markers, bars and bands, side by side with one legend.

use std::path::Path;

use anyhow::Result;
use plotters::prelude::*;

use crate::common::draw::{
    Axis, Chart, Style, failed, figure, frame, guide, legend, legend_width, spots,
};

/// Size of a panel, pixels.
pub(super) const PANEL: (u32, u32) = (430, 340);

/// One panel.
pub(crate) struct Panel {
    pub(crate) title: String,
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    /// Dashed lines.
    pub(crate) guides: Vec<[(f64, f64); 2]>,
    pub(crate) series: Vec<Series>,
}

/// One line.
pub(crate) struct Series {
    pub(crate) style: Style,
    pub(crate) points: Vec<Point>,
}

/// A point and how far its value may be off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) range: Option<[f64; 2]>,
}

/// Draws the panels in rows of so many; series are named once, at the right.
pub(crate) fn draw(
    path: &Path,
    columns: usize,
    panels: &[Panel],
    names: &[(String, Style)],
) -> Result<()> {
    let rows = panels.len().div_ceil(columns);
    let width = columns as u32 * PANEL.0;
    let side = legend_width(names.iter().map(|(name, _)| name.as_str()));
    figure(path, (width + side, rows as u32 * PANEL.1), |area| {
        let (area, side) = area.split_horizontally(width);
        for (part, panel) in area.split_evenly((rows, columns)).iter().zip(panels) {
            let mut chart = frame(part, &panel.title, &panel.x, &panel.y)?;
            for &[from, to] in &panel.guides {
                guide(&mut chart, from, to)?;
            }
            // The first series is drawn last: it is the one that must stay visible.
            for series in panel.series.iter().rev() {
                draw_series(&mut chart, series)?;
            }
        }
        legend(&side, names)
    })
}

/// One line with the ranges of its points and markers.
pub(crate) fn draw_series(chart: &mut Chart<'_, '_>, series: &Series) -> Result<()> {
    let Style { color, marker, line } = series.style;
    let ranges: Vec<(f64, [f64; 2])> =
        series.points.iter().filter_map(|p| Some((p.x, p.range?))).collect();
    let bars = ranges.iter().map(|&(x, [low, high])| {
        PathElement::new(vec![(x, low), (x, high)], color.mix(0.55).stroke_width(1))
    });
    chart.draw_series(bars).map_err(failed)?;
    let points = || series.points.iter().map(|p| (p.x, p.y));
    if line {
        chart.draw_series(LineSeries::new(points(), color.stroke_width(2))).map_err(failed)?;
    }
    if let Some(marker) = marker {
        spots(chart, points(), marker, 4, color)?;
    }
    Ok(())
}

/// A range that contains all values, with a little room; [0, 1] of nothing.
pub(crate) fn range_of(values: impl IntoIterator<Item = f64>) -> std::ops::Range<f64> {
    let finite = values.into_iter().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return 0.0..1.0;
    }
    let margin = (0.05 * (high - low)).max(1e-3);
    low - margin..high + margin
}

#[cfg(test)]
pub(crate) mod tests {
    use std::path::PathBuf;

    use super::*;

    /// Draws into a file of its own and gives its text; the file is kept where
    /// `XTASK_SAMPLE_FIGURES` names a folder, to be looked at.
    pub(crate) fn drawn(name: &str, draw: impl FnOnce(&Path) -> Result<()>) -> String {
        let kept = std::env::var_os("XTASK_SAMPLE_FIGURES").map(PathBuf::from);
        let folder = kept.clone().unwrap_or_else(std::env::temp_dir);
        let id = if kept.is_some() { 0 } else { std::process::id() };
        let path = folder.join(format!("{name}-{id}.svg"));
        draw(&path).unwrap();
        let svg = std::fs::read_to_string(&path).unwrap();
        if kept.is_none() {
            std::fs::remove_file(&path).unwrap();
        }
        svg
    }

    #[test]
    fn ranges_have_room_and_leave_out_what_is_undefined() {
        assert_eq!(range_of([f64::NAN, 0.0, 1.0]), -0.05..1.05);
        assert_eq!(range_of([0.5]), 0.499..0.501);
        assert_eq!(range_of([]), 0.0..1.0);
    }
}

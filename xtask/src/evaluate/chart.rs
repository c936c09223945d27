//! Charts of probabilities as SVG.

use std::path::Path;

use anyhow::Result;
use plotters::prelude::*;

use crate::common::draw::{Axis, Chart, GREY, Marker, Style, failed, figure, frame, guide, legend};

pub(super) const BLUE: RGBColor = RGBColor(31, 98, 180);
pub(super) const ORANGE: RGBColor = RGBColor(230, 126, 20);
pub(super) const GREEN: RGBColor = RGBColor(40, 150, 60);
pub(super) const RED: RGBColor = RGBColor(205, 40, 35);
const PURPLE: RGBColor = RGBColor(130, 70, 170);

/// Size of one of several panels, pixels.
const PANEL: [u32; 2] = [430, 330];

/// A labelled point of a curve.
#[derive(Debug, Clone)]
pub(super) struct Mark {
    name: String,
    color: RGBColor,
}

impl Mark {
    /// The colour of a label of the case file.
    pub(super) fn of_label(label: Option<&str>) -> Self {
        let name = label.unwrap_or("no label");
        let color = match name {
            "free" => GREEN,
            "near" => RGBColor(90, 190, 200),
            "contact" => RGBColor(240, 190, 30),
            "shallow" => PURPLE,
            "collision" => RED,
            _ => GREY,
        };
        Self { name: name.into(), color }
    }
}

/// A probability with its bounds along x (mm).
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) color: RGBColor,
    /// x, probability, bounds.
    pub(super) points: Vec<(f64, f64, [f64; 2])>,
    /// One for each point, or none.
    pub(super) marks: Vec<Mark>,
}

/// One pose: signed distance (mm), probability, whether it is a collision.
pub(super) type Dot = (f64, f64, bool);

/// Probability against the advance, first contact marked at zero.
pub(super) fn approach(path: &Path, title: &str, curves: &[Curve]) -> Result<()> {
    let all = || curves.iter().flat_map(|c| &c.points).map(|p| p.0);
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
    let x = Axis::new("advance past first contact (mm)", low - 3.0..high + 3.0, 0);
    let mut entries: Vec<(String, Style)> = Vec::new();
    for curve in curves {
        entries.push((curve.name.clone(), line(curve.color)));
    }
    for mark in curves.iter().flat_map(|c| &c.marks) {
        if !entries.iter().any(|(name, _)| *name == mark.name) {
            entries.push((mark.name.clone(), dot(mark.color)));
        }
    }
    figure(path, (820, 430), |area| {
        // The legend stands to the right of the curves.
        let (area, side) = area.split_horizontally(620);
        let mut chart = frame(&area, title, &x, &Axis::unit("collision probability"))?;
        guide(&mut chart, (0.0, -0.03), (0.0, 1.03))?;
        // The first curve is drawn last: its points must stay visible.
        for curve in curves.iter().rev() {
            draw_curve(&mut chart, curve)?;
        }
        legend(&side, &entries)
    })
}

fn draw_curve(chart: &mut Chart<'_, '_>, curve: &Curve) -> Result<()> {
    let band = curve.points.iter().map(|&(x, _, [low, _])| (x, low));
    let back = curve.points.iter().rev().map(|&(x, _, [_, high])| (x, high));
    let polygon: Vec<(f64, f64)> = band.chain(back).collect();
    chart.draw_series([Polygon::new(polygon, curve.color.mix(0.18))]).map_err(failed)?;
    let line = curve.points.iter().map(|&(x, p, _)| (x, p));
    chart.draw_series(LineSeries::new(line, curve.color.stroke_width(2))).map_err(failed)?;
    let dots = curve.points.iter().enumerate().map(|(i, &(x, p, _))| {
        let mark = curve.marks.get(i);
        let (size, color) = mark.map_or((2, curve.color), |mark| (5, mark.color));
        Circle::new((x, p), size, color.filled())
    });
    chart.draw_series(dots).map_err(failed)?;
    Ok(())
}

/// Probability against signed distance, one panel for each condition, two in a row.
pub(super) fn scatter(path: &Path, panels: &[(String, Vec<Dot>)]) -> Result<()> {
    let rows = panels.len().div_ceil(2);
    let width = 2 * PANEL[0];
    let all = || panels.iter().flat_map(|(_, dots)| dots).map(|dot| dot.0);
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
    let margin = 0.03 * (high - low);
    let x = Axis::new("signed distance (mm)", low - margin..high + margin, 0);
    figure(path, (width + 110, rows as u32 * PANEL[1]), |area| {
        let (area, side) = area.split_horizontally(width);
        for (part, (title, dots)) in area.split_evenly((rows, 2)).iter().zip(panels) {
            let mut chart = frame(part, title, &x, &Axis::unit("collision probability"))?;
            guide(&mut chart, (0.0, -0.03), (0.0, 1.03))?;
            let circles = dots.iter().map(|&(x, p, collides)| {
                Circle::new((x, p), 4, if collides { RED } else { BLUE }.mix(0.65).filled())
            });
            chart.draw_series(circles).map_err(failed)?;
        }
        legend(&side, &[("collision".into(), dot(RED)), ("apart".into(), dot(BLUE))])
    })
}

fn line(color: RGBColor) -> Style {
    Style { color, line: true, marker: None }
}

fn dot(color: RGBColor) -> Style {
    Style { color, line: false, marker: Some(Marker::Circle) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn charts_are_svg_with_one_circle_for_each_pose() {
        let path = std::env::temp_dir().join(format!("xtask-chart-{}.svg", std::process::id()));
        scatter(&path, &[("a".into(), vec![(-10.0, 0.9, true), (10.0, 0.1, false)])]).unwrap();
        let svg = std::fs::read_to_string(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        // Two poses and two legend entries.
        assert_eq!(svg.matches("<circle").count(), 4, "{svg}");
        assert!(svg.contains("signed distance (mm)"));
    }
}

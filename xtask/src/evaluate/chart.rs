//! Charts of probabilities as SVG.

use std::path::Path;

use anyhow::{Result, anyhow};
use plotters::{coord::types::RangedCoordf64, prelude::*};

pub(super) const BLUE: RGBColor = RGBColor(31, 98, 180);
pub(super) const ORANGE: RGBColor = RGBColor(230, 126, 20);
pub(super) const GREEN: RGBColor = RGBColor(40, 150, 60);
pub(super) const RED: RGBColor = RGBColor(205, 40, 35);
const GREY: RGBColor = RGBColor(120, 120, 120);
const PURPLE: RGBColor = RGBColor(130, 70, 170);

/// Size of one of several panels, pixels.
const PANEL: [u32; 2] = [430, 330];

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

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
    let area = SVGBackend::new(path, (820, 430)).into_drawing_area();
    area.fill(&WHITE).map_err(failed)?;
    let all = || curves.iter().flat_map(|c| &c.points).map(|p| p.0);
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
    // The legend stands to the right of the curves.
    let (area, legend) = area.split_horizontally(620);
    let mut chart = frame(&area, title, low - 3.0..high + 3.0, "advance past first contact (mm)")?;
    first_contact(&mut chart)?;
    // The first curve is drawn last: its points must stay visible.
    for curve in curves.iter().rev() {
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
    }
    let mut entries: Vec<Entry> = Vec::new();
    for curve in curves {
        entries.push(Entry { name: &curve.name, color: curve.color, is_line: true });
    }
    for mark in curves.iter().flat_map(|c| &c.marks) {
        if !entries.iter().any(|e| e.name == mark.name) {
            entries.push(Entry { name: &mark.name, color: mark.color, is_line: false });
        }
    }
    draw_legend(&legend, &entries)?;
    area.present().map_err(failed)
}

/// Probability against signed distance, one panel for each condition, two in a row.
pub(super) fn scatter(path: &Path, panels: &[(String, Vec<Dot>)]) -> Result<()> {
    let rows = panels.len().div_ceil(2);
    let width = 2 * PANEL[0];
    let size = (width + 110, rows as u32 * PANEL[1]);
    let area = SVGBackend::new(path, size).into_drawing_area();
    area.fill(&WHITE).map_err(failed)?;
    let (area, legend) = area.split_horizontally(width);
    let all = || panels.iter().flat_map(|(_, dots)| dots).map(|dot| dot.0);
    let (low, high) = (all().fold(f64::MAX, f64::min), all().fold(f64::MIN, f64::max));
    let margin = 0.03 * (high - low);
    for (part, (title, dots)) in area.split_evenly((rows, 2)).iter().zip(panels) {
        let mut chart = frame(part, title, low - margin..high + margin, "signed distance (mm)")?;
        first_contact(&mut chart)?;
        let circles = dots.iter().map(|&(x, p, collides)| {
            Circle::new((x, p), 4, if collides { RED } else { BLUE }.mix(0.65).filled())
        });
        chart.draw_series(circles).map_err(failed)?;
    }
    draw_legend(
        &legend,
        &[
            Entry { name: "collision", color: RED, is_line: false },
            Entry { name: "apart", color: BLUE, is_line: false },
        ],
    )?;
    area.present().map_err(failed)
}

/// Axes for a probability over a length in mm.
fn frame<'a, 'b>(
    area: &'a Area<'b>,
    title: &str,
    x: std::ops::Range<f64>,
    x_name: &str,
) -> Result<Chart<'a, 'b>> {
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 17))
        .margin(10)
        .x_label_area_size(42)
        .y_label_area_size(48)
        .build_cartesian_2d(x, -0.03..1.03)
        .map_err(failed)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.1))
        .x_desc(x_name)
        .y_desc("collision probability")
        .y_labels(11)
        .y_label_formatter(&|p| format!("{p:.1}"))
        .x_label_formatter(&|x| format!("{x:.0}"))
        .axis_desc_style(("sans-serif", 14))
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(failed)?;
    Ok(chart)
}

/// A dashed line where the surfaces first touch.
fn first_contact(chart: &mut Chart<'_, '_>) -> Result<()> {
    let line = [(0.0, -0.03), (0.0, 1.03)];
    let dashed = DashedLineSeries::new(line, 5, 4, GREY.stroke_width(1));
    chart.draw_series(dashed).map_err(failed)?;
    Ok(())
}

struct Entry<'a> {
    name: &'a str,
    color: RGBColor,
    is_line: bool,
}

fn draw_legend(area: &Area<'_>, entries: &[Entry<'_>]) -> Result<()> {
    for (row, entry) in entries.iter().enumerate() {
        let y = 45 + 24 * row as i32;
        if entry.is_line {
            let line = vec![(6, y), (26, y)];
            area.draw(&PathElement::new(line, entry.color.stroke_width(3))).map_err(failed)?;
        } else {
            area.draw(&Circle::new((16, y), 5, entry.color.filled())).map_err(failed)?;
        }
        let style = ("sans-serif", 14).into_font();
        area.draw(&Text::new(entry.name.to_owned(), (34, y - 7), style)).map_err(failed)?;
    }
    Ok(())
}

/// Plotters' errors borrow from the drawing area, so only their text is kept.
fn failed(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("draw a chart: {error}")
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

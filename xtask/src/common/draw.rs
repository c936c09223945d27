//! What all figures share: axes, markers, legends, colours that the colour-blind can tell apart.

use std::{ops::Range, path::Path};

use anyhow::{Result, anyhow};
use plotters::{
    coord::{Shift, types::RangedCoordf64},
    prelude::*,
};

use super::files::write_whole;

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(crate) type Chart<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

pub(crate) const GREY: RGBColor = RGBColor(120, 120, 120);
/// The colours of Okabe and Ito, without the yellow that white paper swallows.
pub(crate) const BLUE: RGBColor = RGBColor(0, 114, 178);
pub(crate) const VERMILION: RGBColor = RGBColor(213, 94, 0);
const GREEN: RGBColor = RGBColor(0, 158, 115);
const ORANGE: RGBColor = RGBColor(230, 159, 0);
const PURPLE: RGBColor = RGBColor(204, 121, 167);
const SKY: RGBColor = RGBColor(86, 180, 233);

/// Row of a legend, pixels.
const LEGEND_ROW: i32 = 24;

/// The shape of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Marker {
    Circle,
    Square,
    Triangle,
    Diamond,
    /// A triangle on its tip.
    Wedge,
}

/// How a series looks in a figure and in its legend.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Style {
    pub(crate) color: RGBColor,
    pub(crate) line: bool,
    pub(crate) marker: Option<Marker>,
}

impl Style {
    /// The look of the series with this number: neighbours differ in colour and in shape.
    pub(crate) fn of_series(number: usize) -> Self {
        use Marker::{Circle, Diamond, Square, Triangle, Wedge};
        let colors = [BLUE, VERMILION, GREEN, ORANGE, PURPLE, BLACK, SKY, GREY];
        let markers = [Circle, Square, Triangle, Diamond, Wedge];
        let marker = Some(markers[number % markers.len()]);
        Self { color: colors[number % colors.len()], line: true, marker }
    }
}

/// One axis.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    /// What it shows, with the unit.
    pub(crate) name: String,
    pub(crate) range: Range<f64>,
    labels: Labels,
}

/// What the numbers along an axis are.
#[derive(Debug, Clone, Copy)]
enum Labels {
    /// The values, with so many digits after the point.
    Values(usize),
    /// Powers of ten whose exponents are the values.
    Powers,
    /// Nothing: the places along it have no value.
    None,
}

impl Axis {
    pub(crate) fn new(name: &str, range: Range<f64>, digits: usize) -> Self {
        Self { name: name.to_owned(), range, labels: Labels::Values(digits) }
    }

    /// The axis of decadic logarithms, labelled with the numbers themselves.
    pub(crate) fn logarithmic(name: &str, range: Range<f64>) -> Self {
        Self { name: name.to_owned(), range, labels: Labels::Powers }
    }

    /// An axis along which places have no value.
    pub(crate) fn unlabelled(name: &str, range: Range<f64>) -> Self {
        Self { name: name.to_owned(), range, labels: Labels::None }
    }

    /// The axis of a share or probability.
    pub(crate) fn unit(name: &str) -> Self {
        Self::new(name, -0.03..1.03, 1)
    }

    fn label(&self, value: f64) -> String {
        match self.labels {
            Labels::None => String::new(),
            Labels::Values(digits) => format!("{value:.digits$}"),
            Labels::Powers => {
                // Two digits that mean something.
                let digits = (1.0 - value.floor()).max(0.0) as usize;
                let text = format!("{:.digits$}", 10_f64.powf(value));
                let whole = |t: &str| t.trim_end_matches('0').trim_end_matches('.').to_owned();
                if text.contains('.') { whole(&text) } else { text }
            }
        }
    }

    /// How many labels there may be; few decades are better than their fractions.
    fn label_count(&self) -> usize {
        match self.labels {
            Labels::Values(_) => 11,
            Labels::Powers => 5,
            Labels::None => 2,
        }
    }
}

/// Draws a figure of this size in pixels on white and writes it whole.
pub(crate) fn figure(
    path: &Path,
    size: (u32, u32),
    draw: impl FnOnce(&Area<'_>) -> Result<()>,
) -> Result<()> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&WHITE).map_err(failed)?;
        draw(&area)?;
        area.present().map_err(failed)?;
    }
    write_whole(path, svg)
}

/// Titled axes with faint lines.
pub(crate) fn frame<'a, 'b>(
    area: &'a Area<'b>,
    title: &str,
    x: &Axis,
    y: &Axis,
) -> Result<Chart<'a, 'b>> {
    let mut chart = ChartBuilder::on(area)
        .caption(title, ("sans-serif", 17))
        .margin(10)
        .x_label_area_size(42)
        .y_label_area_size(52)
        .build_cartesian_2d(x.range.clone(), y.range.clone())
        .map_err(failed)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.1))
        .x_desc(&x.name)
        .y_desc(&y.name)
        .x_labels(x.label_count())
        .y_labels(y.label_count())
        .x_label_formatter(&|v| x.label(*v))
        .y_label_formatter(&|v| y.label(*v))
        .axis_desc_style(("sans-serif", 14))
        .label_style(("sans-serif", 13))
        .draw()
        .map_err(failed)?;
    Ok(chart)
}

/// A dashed grey line.
pub(crate) fn guide(chart: &mut Chart<'_, '_>, from: (f64, f64), to: (f64, f64)) -> Result<()> {
    let dashed = DashedLineSeries::new([from, to], 5, 4, GREY.stroke_width(1));
    chart.draw_series(dashed).map_err(failed)?;
    Ok(())
}

impl Marker {
    /// Its corners about its place, pixels; none for the circle.
    fn corners(self, size: i32) -> Vec<(i32, i32)> {
        let corners: &[(i32, i32)] = match self {
            Self::Circle => &[],
            Self::Square => &[(-5, -5), (5, -5), (5, 5), (-5, 5)],
            Self::Triangle => &[(0, -7), (7, 5), (-7, 5)],
            Self::Diamond => &[(0, -7), (7, 0), (0, 7), (-7, 0)],
            Self::Wedge => &[(0, 7), (7, -5), (-7, -5)],
        };
        corners.iter().map(|(x, y)| (x * size / 5, y * size / 5)).collect()
    }
}

/// Filled points of this shape and half width in pixels.
pub(crate) fn spots(
    chart: &mut Chart<'_, '_>,
    points: impl IntoIterator<Item = (f64, f64)>,
    marker: Marker,
    size: i32,
    color: impl Into<ShapeStyle>,
) -> Result<()> {
    let style = color.into().filled();
    let points = points.into_iter();
    if marker == Marker::Circle {
        chart.draw_series(points.map(|at| Circle::new(at, size, style))).map_err(failed)?;
    } else {
        let corners = marker.corners(size);
        let polygon = |at| EmptyElement::at(at) + Polygon::new(corners.clone(), style);
        chart.draw_series(points.map(polygon)).map_err(failed)?;
    }
    Ok(())
}

/// Width in pixels that a legend of these names takes.
pub(crate) fn legend_width<'a>(names: impl IntoIterator<Item = &'a str>) -> u32 {
    names.into_iter().map(text_width).max().unwrap_or(0) + 50
}

/// About how wide a text of 14 pixels height is.
pub(crate) fn text_width(text: &str) -> u32 {
    (7.4 * text.chars().count() as f64).ceil() as u32
}

/// Names beside the look of their series, from the top of the area.
pub(crate) fn legend(area: &Area<'_>, entries: &[(String, Style)]) -> Result<()> {
    for (row, (name, style)) in entries.iter().enumerate() {
        let y = 45 + LEGEND_ROW * row as i32;
        if style.line {
            let line = vec![(6, y), (26, y)];
            area.draw(&PathElement::new(line, style.color.stroke_width(3))).map_err(failed)?;
        }
        if let Some(marker) = style.marker {
            let (at, filled) = ((16, y), style.color.filled());
            if marker == Marker::Circle {
                area.draw(&Circle::new(at, 5, filled)).map_err(failed)?;
            } else {
                let corners = Polygon::new(marker.corners(5), filled);
                area.draw(&(EmptyElement::at(at) + corners)).map_err(failed)?;
            }
        }
        let font = ("sans-serif", 14).into_font();
        area.draw(&Text::new(name.clone(), (34, y - 7), font)).map_err(failed)?;
    }
    Ok(())
}

/// Plotters' errors borrow from the drawing area, so only their text is kept.
pub(crate) fn failed(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("draw a chart: {error}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_labelled_with_what_they_are() {
        let axis = Axis::logarithmic("time (ms)", -3.0..3.0);
        let labels = [-3.0, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0].map(|v| axis.label(v));
        assert_eq!(labels, ["0.001", "0.1", "0.32", "1", "3.2", "10", "32", "100"]);
        assert_eq!(Axis::unit("share").label(0.25), "0.2");
    }

    #[test]
    fn neighbouring_series_differ_in_colour_and_shape() {
        for number in 0..12 {
            let [a, b] = [number, number + 1].map(Style::of_series);
            assert!(a.color != b.color && a.marker != b.marker, "{number}");
        }
    }
}

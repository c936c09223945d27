//! Drawing with plotters.

use std::ops::Range;

use anyhow::Result;
use plotters::coord::Shift;
use plotters::prelude::*;

use super::{Axis, Figure, GREY, Panel, Place};

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Marker<'a> = DynElement<'static, SVGBackend<'a>, Place>;

const TITLE_HEIGHT: u32 = 34;
const FONT: (&str, u32) = ("sans-serif", 16);

/// The colours of Okabe and Ito, without the yellow that white paper swallows.
const PALETTE: [RGBColor; 4] =
    [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(230, 159, 0)];

/// A name with its colour in every panel. Which of them it is decides on its marker.
type Look<'a> = (&'a str, RGBColor);

impl Figure {
    /// Draws it as SVG.
    pub fn svg(&self) -> Result<String> {
        let looks = looks(self);
        let columns = self.columns.min(self.panels.len()).max(1);
        let rows = self.panels.len().div_ceil(columns);
        let grid = (columns as u32 * self.panel_size.0, rows as u32 * self.panel_size.1);
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, (grid.0, grid.1 + TITLE_HEIGHT))
                .into_drawing_area();
            area.fill(&WHITE)?;
            let area = area.titled(&self.title, ("sans-serif", 20))?;
            for (panel, area) in self.panels.iter().zip(area.split_evenly((rows, columns))) {
                draw_panel(&area, panel, &looks)?;
            }
            area.present()?;
        }
        Ok(svg)
    }
}

/// The looks of all names in the order in which they first occur: neighbours differ in colour and in shape.
fn looks(figure: &Figure) -> Vec<Look<'_>> {
    let mut looks: Vec<Look<'_>> = Vec::new();
    let series = figure.panels.iter().flat_map(|panel| &panel.series);
    for series in series.filter(|series| !series.name.is_empty()) {
        if looks.iter().all(|(name, _)| *name != series.name) {
            let color = series.color.unwrap_or(PALETTE[looks.len() % PALETTE.len()]);
            looks.push((&series.name, color));
        }
    }
    looks
}

fn draw_panel(area: &Area<'_>, panel: &Panel, looks: &[Look<'_>]) -> Result<()> {
    let area = area.titled(&panel.title, ("sans-serif", 17))?;
    let places = || panel.series.iter().flat_map(|series| series.marks.iter().flatten());
    let x = panel.x.reach(places().map(|place| place.0));
    let y = panel.y.reach(places().map(|place| place.1));
    let mut chart = ChartBuilder::on(&area)
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(54)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.1))
        .x_desc(&panel.x.name)
        .y_desc(&panel.y.name)
        .x_labels(9)
        .y_labels(9)
        .x_label_formatter(&label)
        .y_label_formatter(&label)
        .axis_desc_style(FONT)
        .label_style(FONT)
        .draw()?;
    for series in &panel.series {
        let number = looks.iter().position(|(name, _)| *name == series.name);
        let color = series.color.or(number.map(|number| looks[number].1)).unwrap_or(GREY);
        let has_marks = series.marks.iter().any(|mark| !mark.is_empty());
        if let Some(place) = series.name_at.filter(|_| has_marks) {
            let style = FONT.into_font().color(&color);
            chart.draw_series([Text::new(series.name.clone(), place, style)])?;
        }
        for mark in &series.marks {
            let is_finite = |place: &Place| place.0.is_finite() && place.1.is_finite();
            let places: Vec<Place> = mark.iter().copied().filter(is_finite).collect();
            if let Some(opacity) = series.fill {
                let area = Polygon::new(places.clone(), color.mix(opacity));
                chart.draw_series([area])?;
            }
            if series.line {
                let line = PathElement::new(places.clone(), color.stroke_width(2));
                chart.draw_series([line])?;
            }
            if series.points {
                let number = number.unwrap_or(0);
                let marker = |at| marker(number, at, series.size, color.mix(0.8).filled());
                chart.draw_series(places.into_iter().map(marker))?;
            }
        }
    }
    Ok(())
}

/// The marker of the series with this number.
fn marker<'a>(number: usize, at: Place, size: u32, style: ShapeStyle) -> Marker<'a> {
    match number % 3 {
        0 => Circle::new(at, size, style).into_dyn(),
        1 => TriangleMarker::new(at, size + 1, style).into_dyn(),
        _ => Cross::new(at, size, style.stroke_width(2)).into_dyn(),
    }
}

impl Axis {
    /// From where to where it reaches when it has to show these values.
    fn reach(&self, values: impl Iterator<Item = f64>) -> Range<f64> {
        if let Some(range) = &self.range {
            return range.clone();
        }
        let finite = values.filter(|value| value.is_finite());
        let (low, high) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        match high - low {
            width if width > 0.0 => low - 0.05 * width..high + 0.05 * width,
            0.0 => low - 0.5..high + 0.5,
            _ => 0.0..1.0,
        }
    }
}

/// A number at an axis, without digits that say nothing; never −0.
fn label(value: &f64) -> String {
    format!("{}", (value * 1e4).round() / 1e4 + 0.0)
}

#[cfg(test)]
mod tests {
    use super::super::Series;
    use super::*;

    #[test]
    fn labels_say_what_stands_there_and_what_cannot_be_shown_does_not_widen_an_axis() {
        let labels = [-1e-17, 0.001, 0.2, 0.25, -3.0, 1e6].map(|value| label(&value));
        assert_eq!(labels, ["0", "0.001", "0.2", "0.25", "-3", "1000000"]);
        let values = [0.0, f64::INFINITY, 2.0, f64::NAN];
        assert_eq!(Axis::linear("x").reach(values.into_iter()), -0.1..2.1);
        assert_eq!(Axis::linear("x").reach([].into_iter()), 0.0..1.0);
        assert_eq!(Axis::linear("x").reach([3.0].into_iter()), 2.5..3.5);
    }

    #[test]
    fn names_stand_where_they_are_wanted_and_neighbours_differ() {
        let of = |name: &str| Series::points(name, [(1.0, 2.0)]);
        let panel = |series| {
            let (x, y) = (Axis::linear("x"), Axis::linear("y"));
            Panel { title: String::new(), x, y, series }
        };
        let band = Series::band("a", [(1.0, 1.0, 3.0), (2.0, 1.0, 3.0)]);
        let panels =
            [panel(vec![of("a").named_at(1.0, 2.5), band, of("")]), panel(vec![of("b"), of("a")])];
        let figure = Figure::new("Two", panels);
        let looks = looks(&figure);
        assert_eq!(looks.iter().map(|(name, _)| *name).collect::<Vec<_>>(), ["a", "b"]);
        assert!(looks[0].1 != looks[1].1);
        let svg = figure.svg().unwrap();
        assert_eq!([">\na\n<", ">\nb\n<"].map(|name| svg.matches(name).count()), [1, 0]);
    }
}

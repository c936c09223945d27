//! Drawing with plotters.

use std::{ops::Range, path::Path};

use anyhow::{Result, anyhow};
use cloudtouch_io::write_atomically;
use plotters::{
    coord::{Shift, types::RangedCoordf64},
    element::{Drawable, PointCollection},
    prelude::*,
};

use super::{
    axis::text_width,
    data::{Figure, Kind, Panel, Place, Series, palette},
};

type Svg<'a> = SVGBackend<'a>;
type Area<'a> = DrawingArea<Svg<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, Svg<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

const TITLE_HEIGHT: u32 = 34;
/// Row of the legend, pixels.
const LEGEND_ROW: u32 = 24;
const FONT: (&str, u32) = ("sans-serif", 13);

/// How a name looks wherever it stands.
struct Look<'a> {
    name: &'a str,
    /// Which marker its points get.
    number: usize,
    color: RGBColor,
    line: bool,
    points: bool,
}

impl Figure {
    /// Draws it as SVG.
    ///
    /// # Errors
    /// When plotters cannot draw, as in panels smaller than their labels.
    pub fn svg(&self) -> Result<String> {
        let looks = looks(self);
        let columns = self.columns.min(self.panels.len()).max(1);
        let rows = self.panels.len().div_ceil(columns);
        let grid = (columns as u32 * self.panel_size.0, rows as u32 * self.panel_size.1);
        let legend = looks.iter().map(|look| text_width(look.name) + 50).max().unwrap_or(0);
        let mut svg = String::new();
        {
            let height = grid.1.max(LEGEND_ROW * (looks.len() as u32 + 1)) + TITLE_HEIGHT;
            let area = Svg::with_string(&mut svg, (grid.0 + legend, height)).into_drawing_area();
            area.fill(&WHITE).map_err(failed)?;
            let area = area.titled(&self.title, ("sans-serif", 19)).map_err(failed)?;
            let (left, right) = area.split_horizontally(grid.0);
            let (top, _) = left.split_vertically(grid.1);
            for (panel, area) in self.panels.iter().zip(top.split_evenly((rows, columns))) {
                draw_panel(&area, panel, &looks)?;
            }
            draw_legend(&right, &looks)?;
            right.present().map_err(failed)?;
        }
        Ok(svg)
    }

    /// Writes it as SVG, the whole file or nothing.
    ///
    /// # Errors
    /// As [`svg`](Self::svg), and when the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<()> {
        let svg = self.svg()?;
        Ok(write_atomically(path, |out| out.write_all(svg.as_bytes()))?)
    }
}

/// The looks of all names in the order in which they first occur: neighbours differ in colour and
/// in shape.
fn looks(figure: &Figure) -> Vec<Look<'_>> {
    let mut looks: Vec<Look<'_>> = Vec::new();
    let series = figure.panels.iter().flat_map(|panel| &panel.series);
    for series in series.filter(|series| !series.name.is_empty()) {
        let number = looks.len();
        let at = looks.iter().position(|look| look.name == series.name).unwrap_or_else(|| {
            let color = palette::SERIES[number % palette::SERIES.len()];
            looks.push(Look { name: &series.name, number, color, line: false, points: false });
            number
        });
        let look = &mut looks[at];
        look.color = series.color.unwrap_or(look.color);
        look.points |= matches!(series.kind, Kind::Points | Kind::Curve);
        look.line |= series.kind != Kind::Points;
    }
    looks
}

fn draw_panel(area: &Area<'_>, panel: &Panel, looks: &[Look<'_>]) -> Result<()> {
    let area = match panel.title.as_str() {
        "" => area.clone(),
        title => area.titled(title, ("sans-serif", 15)).map_err(failed)?,
    };
    let places = || panel.series.iter().flat_map(|series| series.marks.iter().flatten());
    let is_bars = |series: &Series| series.kind == Kind::Bars;
    let bottom = panel.series.iter().any(is_bars).then_some(0.0);
    let mut x = panel.x.reach(places().map(|place| place.0));
    let mut y = panel.y.reach(places().map(|place| place.1).chain(bottom));
    if panel.equal_aspect {
        let (width, height) = axes(&area, panel, &x, &y)?.plotting_area().dim_in_pixel();
        let [width, height] = [width, height].map(f64::from);
        let unit = ((x.end - x.start) / width).max((y.end - y.start) / height);
        (x, y) = (widened(&x, unit * width), widened(&y, unit * height));
    }
    let mut chart = axes(&area, panel, &x, &y)?;
    let mut mesh = chart.configure_mesh();
    if !panel.x.is_shown() {
        mesh.disable_x_mesh().disable_x_axis();
    }
    if !panel.y.is_shown() {
        mesh.disable_y_mesh().disable_y_axis();
    }
    mesh.light_line_style(TRANSPARENT)
        .bold_line_style(BLACK.mix(0.1))
        .x_desc(&panel.x.name)
        .y_desc(&panel.y.name)
        .x_labels(panel.x.label_count())
        .y_labels(panel.y.label_count())
        .x_label_formatter(&|place| panel.x.label(*place, &x))
        .y_label_formatter(&|place| panel.y.label(*place, &y))
        .axis_desc_style(FONT)
        .label_style(FONT)
        .draw()
        .map_err(failed)?;
    panel.series.iter().try_for_each(|series| draw_series(&mut chart, panel, series, looks))
}

fn axes<'a, 'b>(
    area: &'a Area<'b>,
    panel: &Panel,
    x: &Range<f64>,
    y: &Range<f64>,
) -> Result<Chart<'a, 'b>> {
    ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(if panel.x.is_shown() { 40 } else { 4 })
        .y_label_area_size(panel.y.label_width())
        .build_cartesian_2d(x.clone(), y.clone())
        .map_err(failed)
}

/// As wide as this about the same middle.
fn widened(range: &Range<f64>, width: f64) -> Range<f64> {
    let middle = 0.5 * (range.start + range.end);
    middle - 0.5 * width..middle + 0.5 * width
}

fn draw_series(
    chart: &mut Chart<'_, '_>,
    panel: &Panel,
    series: &Series,
    looks: &[Look<'_>],
) -> Result<()> {
    let look = looks.iter().find(|look| look.name == series.name);
    let color = series.color.or(look.map(|look| look.color)).unwrap_or(palette::GREY);
    let number = look.map_or(0, |look| look.number);
    let color = color.mix(series.opacity);
    let (filled, size) = (color.filled(), series.size);
    let stroke = match series.kind {
        // Upright lines as wide as a bar keep its width apart from the units of x.
        Kind::Bars => color.stroke_width(size),
        Kind::Dashes => color.stroke_width(1),
        _ => color.stroke_width(2),
    };
    let bottom = chart.as_coord_spec().get_y_range().start.max(panel.y.place(0.0));
    for (number_of_mark, mark) in series.marks.iter().enumerate() {
        let places = mark.iter().map(|&(x, y)| (panel.x.place(x), panel.y.place(y)));
        let places: Vec<Place> =
            places.filter(|place| place.0.is_finite() && place.1.is_finite()).collect();
        match (series.kind, &places[..]) {
            (Kind::Line, _) => draw(chart, [PathElement::new(places, stroke)]),
            (Kind::Dashes, _) => draw(chart, DashedLineSeries::new(places, 5, 4, stroke)),
            (Kind::Points, _) => draw_markers(chart, places, number, size, filled),
            (Kind::Curve, _) => draw(chart, [PathElement::new(places.clone(), stroke)])
                .and_then(|()| draw_markers(chart, places, number, size, filled)),
            (Kind::Bars, _) => {
                let bar = |(x, y)| PathElement::new([(x, bottom), (x, y)], stroke);
                draw(chart, places.into_iter().map(bar))
            }
            (Kind::Area, _) => draw(chart, [Polygon::new(places, filled)]),
            (Kind::Arrow, &[from, to]) => {
                let [tail, head] = [from, to].map(|place| chart.backend_coord(&place));
                let tip = Polygon::new(tip(tail, head, 2.0 * f64::from(size)), filled);
                draw(chart, [PathElement::new(places, stroke)])
                    .and_then(|()| draw(chart, std::iter::once(EmptyElement::at(to) + tip)))
            }
            (Kind::Words, &[at]) => {
                let font = FONT.into_font().color(&color);
                draw(chart, [Text::new(series.words[number_of_mark].clone(), at, font)])
            }
            // Its place is not in sight.
            (Kind::Arrow | Kind::Words, _) => Ok(()),
        }?;
    }
    Ok(())
}

fn draw<'a, 'b, E, R>(chart: &mut Chart<'a, 'b>, elements: E) -> Result<()>
where
    E: IntoIterator<Item = R>,
    for<'c> &'c R: PointCollection<'c, Place>,
    R: Drawable<Svg<'b>>,
{
    chart.draw_series(elements).map(drop).map_err(failed)
}

/// Corners of an arrow's tip about its head, pixels.
fn tip(tail: (i32, i32), head: (i32, i32), length: f64) -> Vec<(i32, i32)> {
    let [x, y] = [head.0 - tail.0, head.1 - tail.1].map(f64::from);
    let norm = x.hypot(y).max(1.0);
    let (x, y) = (length * x / norm, length * y / norm);
    let corner = |side: f64| ((-x - 0.5 * side * y) as i32, (-y + 0.5 * side * x) as i32);
    vec![(0, 0), corner(1.0), corner(-1.0)]
}

/// The marker of the series with this number at each place.
fn draw_markers(
    chart: &mut Chart<'_, '_>,
    places: Vec<Place>,
    number: usize,
    size: u32,
    style: ShapeStyle,
) -> Result<()> {
    match corners(number, size) {
        None => draw(chart, places.into_iter().map(|at| Circle::new(at, size, style))),
        Some(corners) => {
            let polygon = |at| EmptyElement::at(at) + Polygon::new(corners.clone(), style);
            draw(chart, places.into_iter().map(polygon))
        }
    }
}

/// Corners of a marker about its place, pixels; none of a circle.
fn corners(number: usize, size: u32) -> Option<Vec<(i32, i32)>> {
    let corners: &[(i32, i32)] = match number % 5 {
        0 => return None,
        1 => &[(-5, -5), (5, -5), (5, 5), (-5, 5)],
        2 => &[(0, -7), (7, 5), (-7, 5)],
        3 => &[(0, -7), (7, 0), (0, 7), (-7, 0)],
        _ => &[(0, 7), (7, -5), (-7, -5)],
    };
    Some(corners.iter().map(|(x, y)| (x * size as i32 / 5, y * size as i32 / 5)).collect())
}

/// Names beside the look of their series, from the top of the area.
fn draw_legend(area: &Area<'_>, looks: &[Look<'_>]) -> Result<()> {
    for (row, look) in looks.iter().enumerate() {
        let y = (LEGEND_ROW * row as u32 + 20) as i32;
        if look.line {
            let line = vec![(6, y), (26, y)];
            area.draw(&PathElement::new(line, look.color.stroke_width(3))).map_err(failed)?;
        }
        if look.points {
            let (at, style) = ((16, y), look.color.filled());
            match corners(look.number, 5) {
                None => area.draw(&Circle::new(at, 5, style)),
                Some(corners) => area.draw(&(EmptyElement::at(at) + Polygon::new(corners, style))),
            }
            .map_err(failed)?;
        }
        let font = FONT.into_font();
        area.draw(&Text::new(look.name.to_owned(), (34, y - 7), font)).map_err(failed)?;
    }
    Ok(())
}

/// Plotters' errors borrow from the drawing area, so only their text is kept.
fn failed(error: impl std::fmt::Display) -> anyhow::Error {
    anyhow!("draw a figure: {error}")
}

#[cfg(test)]
mod tests {
    use super::{super::axis::Axis, *};

    #[test]
    fn one_name_is_one_row_of_the_legend_and_neighbours_differ() {
        let of = |name: &str| Series::points(name, [(1.0, 2.0)]);
        let panel = || Panel::new(Axis::linear("x"), Axis::log("y"));
        let whiskers = Series::whiskers("a", [(1.0, 1.0, 3.0)]);
        let figure = Figure::new("Two")
            .panel(panel().series(of("a")).series(whiskers).series(of("")))
            .panel(panel().series(of("b")).series(of("a")));
        let looks = looks(&figure);
        assert_eq!(looks.iter().map(|look| look.name).collect::<Vec<_>>(), ["a", "b"]);
        assert!(looks[0].color != looks[1].color && looks[0].line && !looks[1].line);
        let svg = figure.svg().unwrap();
        assert_eq!([">\na\n<", ">\nb\n<"].map(|name| svg.matches(name).count()), [1, 1]);
    }

    #[test]
    fn a_unit_is_as_long_along_both_axes_where_that_is_asked_for() {
        let square = vec![(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let panel = Panel::new(Axis::hidden(), Axis::hidden())
            .series(Series::polygons("", [square]))
            .equal_aspect();
        let svg = Figure::new("").panel(panel).svg().unwrap();
        let line = svg.lines().find(|line| line.starts_with("<polygon")).unwrap();
        let points = line.split('"').find(|text| text.contains(',')).unwrap();
        let numbers: Vec<f64> =
            points.split([',', ' ']).filter_map(|number| number.parse().ok()).collect();
        let [width, height] = [numbers[2] - numbers[0], numbers[1] - numbers[5]];
        assert!((width - height).abs() <= 1.0 && width > 100.0, "{line}");
    }
}

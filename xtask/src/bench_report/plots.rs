//! The figures: times by class of pose, by points of the scene, by points of a leaf.

use std::path::Path;

use anyhow::Result;
use plotters::style::BLACK;

use super::{
    growth::Grown,
    method::{DISTANCE, LAZY, MESHES},
    poses::{Class, Posed},
    room::Asked,
    solvers::Compared,
    timing::median,
};
use crate::{
    common::{
        draw::{Axis, Style},
        statistics::quantile,
    },
    sweep::plots::lines::{Panel, Point, Series, draw, range_of},
};

/// Half the height over which the marks of one method are spread, rows.
const SPREAD: f64 = 0.28;
/// Half the height of the bar at the median, rows.
const BAR: f64 = 0.42;

/// A panel for each class of pose, a row for each method, a mark for each pose.
pub(super) fn strips(path: &Path, asked: &[Asked], poses: &[Posed]) -> Result<()> {
    let x = logarithmic("query (ms)", asked.iter().flat_map(|a| &a.seconds));
    let rows = asked.len() as f64;
    let panel = |class: Class| Panel {
        title: format!("{} poses", class.name()),
        x: x.clone(),
        y: Axis::unlabelled("methods, as in the legend", -0.6..rows - 0.4),
        guides: Vec::new(),
        series: asked
            .iter()
            .enumerate()
            .flat_map(|(number, a)| {
                strip(number, rows - 1.0 - number as f64, &a.of(poses, Some(class)))
            })
            .collect(),
    };
    let names: Vec<(String, Style)> =
        asked.iter().enumerate().map(|(i, a)| (a.name.to_owned(), marks(i))).collect();
    draw(path, 3, &Class::ALL.map(panel), &names)
}

fn strip(number: usize, row: f64, seconds: &[f64]) -> [Series; 2] {
    let style = marks(number);
    let spread = |i: usize| SPREAD * (2.0 * (i % 7) as f64 / 6.0 - 1.0);
    let mark =
        |(i, &s): (usize, &f64)| Point { x: milliseconds(s), y: row + spread(i), range: None };
    let middle = median(seconds);
    let bar = Point { x: milliseconds(middle), y: row, range: Some([row - BAR, row + BAR]) };
    [
        // Drawn last, so that it stays visible.
        Series {
            style: Style { color: BLACK, marker: None, line: false },
            points: if middle.is_nan() { Vec::new() } else { vec![bar] },
        },
        Series { style, points: seconds.iter().enumerate().map(mark).collect() },
    ]
}

fn marks(number: usize) -> Style {
    Style { line: false, ..Style::of_series(number) }
}

/// Time of a query over the points of the scene, both logarithmic.
pub(super) fn growth(path: &Path, grown: &[Grown]) -> Result<()> {
    let methods = [LAZY, DISTANCE, MESHES];
    let curve = |name: &str| -> Vec<Point> {
        grown.iter().map(|g| point((g.points as f64).log10(), g.of(name))).collect()
    };
    let series: Vec<Vec<Point>> = methods.iter().map(|name| curve(name)).collect();
    let x =
        Axis::logarithmic("points of the scene", range_of(series.iter().flatten().map(|p| p.x)));
    let panel = Panel {
        title: "prepared query against 10,000 points".into(),
        x,
        y: times_of(&series),
        guides: Vec::new(),
        series: styled(series),
    };
    draw(path, 1, &[panel], &names(&methods))
}

/// Time of a solve over the points of a side, both logarithmic, a panel for each cell.
pub(super) fn solvers(path: &Path, cells: &[&str], all: &[Compared]) -> Result<()> {
    let curves = |cell: &str| -> Vec<Vec<Point>> {
        let of_cell = || all.iter().filter(|c| c.cell == cell);
        [0, 1]
            .map(|which| {
                of_cell().map(|c| point((c.per_side as f64).log10(), &c.seconds()[which])).collect()
            })
            .to_vec()
    };
    let every: Vec<Vec<Point>> = cells.iter().flat_map(|cell| curves(cell)).collect();
    let x = range_of(every.iter().flatten().map(|p| p.x));
    let panel = |cell: &&str| Panel {
        title: (*cell).to_owned(),
        x: Axis::logarithmic("points of a side", x.clone()),
        y: times_of(&every),
        guides: Vec::new(),
        series: styled(curves(cell)),
    };
    let panels: Vec<Panel> = cells.iter().map(panel).collect();
    draw(path, cells.len(), &panels, &names(&["ours", "Clarabel"]))
}

/// Median and 5th to 95th percentile in logarithms of milliseconds.
fn point(x: f64, seconds: &[f64]) -> Point {
    let [low, y, high] = [0.05, 0.5, 0.95].map(|q| milliseconds(quantile(seconds, q)));
    Point { x, y, range: Some([low, high]) }
}

fn milliseconds(seconds: f64) -> f64 {
    (1e3 * seconds).log10()
}

fn logarithmic<'a>(name: &str, seconds: impl Iterator<Item = &'a f64>) -> Axis {
    Axis::logarithmic(name, range_of(seconds.map(|s| milliseconds(*s))))
}

fn times_of(series: &[Vec<Point>]) -> Axis {
    let ends = series.iter().flatten().flat_map(|p| p.range.unwrap_or([p.y; 2]));
    Axis::logarithmic("time (ms)", range_of(ends))
}

fn styled(series: Vec<Vec<Point>>) -> Vec<Series> {
    let line = |(number, points): (usize, Vec<Point>)| Series {
        style: Style::of_series(number),
        points: points.into_iter().filter(|p| p.y.is_finite()).collect(),
    };
    series.into_iter().enumerate().map(line).collect()
}

fn names(names: &[&str]) -> Vec<(String, Style)> {
    names.iter().enumerate().map(|(i, name)| ((*name).to_owned(), Style::of_series(i))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_the_median_with_its_spread() {
        let seconds: Vec<f64> = (1..=20).map(|i| 1e-3 * f64::from(i)).collect();
        let p = point(4.0, &seconds);
        assert_eq!((p.x, p.y), (4.0, 1.0));
        assert_eq!(p.range, Some([0.0, 19_f64.log10()]));
    }

    #[test]
    fn a_strip_has_a_mark_for_each_pose_in_its_row() {
        let [bar, marks] = strip(1, 2.0, &[1e-3, 1e-2, 1e-3]);
        assert_eq!((bar.points[0].x, bar.points[0].range), (0.0, Some([1.58, 2.42])));
        assert!(marks.points.iter().all(|p| (p.y - 2.0).abs() < 0.5));
        assert_eq!(marks.points.len(), 3);
        let [bar, marks] = strip(1, 2.0, &[]);
        assert!(bar.points.is_empty() && marks.points.is_empty());
    }
}

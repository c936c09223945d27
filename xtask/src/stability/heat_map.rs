//! Heat maps: a grid of cells for each measure, with one colour bar each.

use std::path::Path;

use anyhow::Result;
use plotters::{
    prelude::*,
    style::text_anchor::{HPos, Pos, VPos},
};

use crate::common::draw::{Area, GREY, failed, figure};

/// A side of the grid.
pub(super) struct Side {
    /// What varies along it, with the unit.
    pub(super) name: &'static str,
    /// One label for each cell.
    pub(super) labels: Vec<String>,
}

/// One grid of values.
pub(super) struct Panel {
    pub(super) title: &'static str,
    /// By row, then by column; NaN where there is nothing to show.
    pub(super) values: Vec<Vec<f64>>,
    pub(super) scale: Scale,
}

/// How values become colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scale {
    /// Decades from 10^low to 10^high; smaller values have the lowest colour.
    Decades(i32, i32),
    /// A share from 0 to 1.
    Share,
}

/// Space around the cells of a panel, pixels.
const LEFT: i32 = 78;
const RIGHT: i32 = 96;
const TOP: i32 = 40;
const BOTTOM: i32 = 66;
/// Largest side of a cell, pixels.
const CELL: i32 = 30;
const PANELS_PER_ROW: usize = 2;
/// Steps of the colour bar.
const BAR_STEPS: i32 = 64;

/// Draws panels over one grid, two in a row; `marked` (column, row) is outlined.
pub(super) fn draw(
    path: &Path,
    x: &Side,
    y: &Side,
    marked: (usize, usize),
    panels: &[Panel],
) -> Result<()> {
    let (columns, rows) = (x.labels.len() as i32, y.labels.len() as i32);
    let width = LEFT + CELL * columns + RIGHT;
    let height = TOP + CELL * rows + BOTTOM;
    let lines = panels.len().div_ceil(PANELS_PER_ROW);
    let size = (width as u32 * PANELS_PER_ROW as u32, height as u32 * lines as u32);
    figure(path, size, |area| {
        for (part, panel) in area.split_evenly((lines, PANELS_PER_ROW)).iter().zip(panels) {
            cells(part, panel, rows, marked)?;
            names(part, panel.title, x, y)?;
            bar(part, panel.scale, columns, rows)?;
        }
        Ok(())
    })
}

/// The corner of a cell; rows count from below.
fn corner(column: i32, row: i32, rows: i32) -> (i32, i32) {
    (LEFT + CELL * column, TOP + CELL * (rows - 1 - row))
}

fn cells(area: &Area<'_>, panel: &Panel, rows: i32, marked: (usize, usize)) -> Result<()> {
    for (row, values) in panel.values.iter().enumerate() {
        for (column, &value) in values.iter().enumerate() {
            let (left, top) = corner(column as i32, row as i32, rows);
            let cell = [(left, top), (left + CELL - 1, top + CELL - 1)];
            let color = panel.scale.place(value).map_or(RGBColor(225, 225, 225), color);
            area.draw(&Rectangle::new(cell, color.filled())).map_err(failed)?;
        }
    }
    let (left, top) = corner(marked.0 as i32, marked.1 as i32, rows);
    let outline = [(left, top), (left + CELL - 1, top + CELL - 1)];
    let style = RGBColor(213, 94, 0).stroke_width(3);
    area.draw(&Rectangle::new(outline, style)).map_err(failed)
}

fn names(area: &Area<'_>, title: &str, x: &Side, y: &Side) -> Result<()> {
    let (columns, rows) = (x.labels.len() as i32, y.labels.len() as i32);
    let (middle, bottom) = (LEFT + CELL * columns / 2, TOP + CELL * rows);
    let centred = Pos::new(HPos::Center, VPos::Center);
    let font = |size: i32| ("sans-serif", size).into_font();
    let write = |text: &str, at: (i32, i32), style: TextStyle<'_>| {
        area.draw(&Text::new(text.to_owned(), at, style)).map_err(failed)
    };
    write(title, (middle, TOP / 2), font(16).into_text_style(area).pos(centred))?;
    let small = font(11).into_text_style(area);
    for (column, label) in x.labels.iter().enumerate() {
        let at = (LEFT + CELL * column as i32 + CELL / 2, bottom + 12);
        write(label, at, small.pos(centred))?;
    }
    for (row, label) in y.labels.iter().enumerate() {
        let at = (LEFT - 6, corner(0, row as i32, rows).1 + CELL / 2);
        write(label, at, small.pos(Pos::new(HPos::Right, VPos::Center)))?;
    }
    let medium = font(14).into_text_style(area).pos(centred);
    write(x.name, (middle, bottom + 36), medium.clone())?;
    let turned = medium.transform(FontTransform::Rotate270);
    write(y.name, (18, TOP + CELL * rows / 2), turned)
}

fn bar(area: &Area<'_>, scale: Scale, columns: i32, rows: i32) -> Result<()> {
    let (left, height) = (LEFT + CELL * columns + 16, CELL * rows);
    let at = |share: f64| TOP + height - (share * f64::from(height)).round() as i32;
    for step in 0..BAR_STEPS {
        let [low, high] = [step, step + 1].map(|s| f64::from(s) / f64::from(BAR_STEPS));
        let part = [(left, at(high)), (left + 14, at(low))];
        let style = color(0.5 * (low + high)).filled();
        area.draw(&Rectangle::new(part, style)).map_err(failed)?;
    }
    let font = ("sans-serif", 11).into_font().into_text_style(area);
    let style = font.pos(Pos::new(HPos::Left, VPos::Center));
    for (share, label) in scale.ticks() {
        let y = at(share);
        let tick = vec![(left + 14, y), (left + 18, y)];
        area.draw(&PathElement::new(tick, GREY.stroke_width(1))).map_err(failed)?;
        area.draw(&Text::new(label, (left + 22, y), style.clone())).map_err(failed)?;
    }
    Ok(())
}

impl Scale {
    /// Where a value lies from 0 to 1; none for NaN.
    fn place(self, value: f64) -> Option<f64> {
        let share = match self {
            Self::Decades(low, high) => (value.log10() - f64::from(low)) / f64::from(high - low),
            Self::Share => value,
        };
        (!share.is_nan()).then(|| share.clamp(0.0, 1.0))
    }

    fn ticks(self) -> Vec<(f64, String)> {
        match self {
            Self::Decades(low, high) => {
                let every = ((high - low) / 6).max(1) as usize;
                let at = |e: i32| (f64::from(e - low) / f64::from(high - low), format!("1e{e}"));
                (low..=high).step_by(every).map(at).collect()
            }
            Self::Share => {
                (0..=4).map(|i| (0.25 * f64::from(i), format!("{} %", 25 * i))).collect()
            }
        }
    }
}

/// The colour of a value from 0 to 1: the map viridis, in which lightness rises evenly.
fn color(share: f64) -> RGBColor {
    const ANCHORS: [[f64; 3]; 5] = [
        [68.0, 1.0, 84.0],
        [59.0, 82.0, 139.0],
        [33.0, 145.0, 140.0],
        [94.0, 201.0, 98.0],
        [253.0, 231.0, 37.0],
    ];
    let along = share * (ANCHORS.len() - 1) as f64;
    let first = (along.floor() as usize).min(ANCHORS.len() - 2);
    let part = along - first as f64;
    let [r, g, b] = std::array::from_fn(|k| {
        let [low, high] = [ANCHORS[first][k], ANCHORS[first + 1][k]];
        (low + part * (high - low)).round() as u8
    });
    RGBColor(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_their_place_and_colour() {
        let decades = Scale::Decades(-8, 0);
        assert_eq!(decades.place(1e-4), Some(0.5));
        assert_eq!((decades.place(0.0), decades.place(f64::NAN)), (Some(0.0), None));
        assert_eq!(Scale::Share.place(0.25), Some(0.25));
        assert_eq!((color(0.0), color(0.5)), (RGBColor(68, 1, 84), RGBColor(33, 145, 140)));
        assert_eq!(color(1.0), RGBColor(253, 231, 37));
    }

    #[test]
    fn a_map_has_a_rectangle_for_each_cell() {
        let path = std::env::temp_dir().join(format!("heat-map-{}.svg", std::process::id()));
        let side = |name, count: usize| Side { name, labels: vec!["1".into(); count] };
        let panel = Panel { title: "t", values: vec![vec![0.5; 3]; 2], scale: Scale::Share };
        draw(&path, &side("x", 3), &side("y", 2), (1, 1), &[panel]).unwrap();
        let svg = std::fs::read_to_string(&path).unwrap();
        std::fs::remove_file(&path).unwrap();
        // Background, cells, outline and colour bar.
        assert_eq!(svg.matches("<rect").count(), 1 + 6 + 1 + BAR_STEPS as usize);
    }
}

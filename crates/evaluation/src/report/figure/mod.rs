//! One kind of figure for every report: panels with axes, and series of marks as plain data.
//!
//! Series of one name look alike in all panels of a figure, and their name stands beside them where
//! it is wanted; those without a name are grey.

mod draw;

use std::ops::Range;

pub use plotters::style::RGBColor;

/// A place in a panel, in the units of its axes.
pub type Place = (f64, f64);

/// The grey of what has no name.
pub const GREY: RGBColor = RGBColor(120, 120, 120);

/// Panels in a grid under one title.
#[derive(Debug, Clone)]
pub struct Figure {
    pub(crate) title: String,
    pub(crate) panels: Vec<Panel>,
    /// Panels side by side.
    pub columns: usize,
    /// Width and height of a panel, pixels.
    pub panel_size: (u32, u32),
}

/// Axes and what is drawn in them, in order.
#[derive(Debug, Clone)]
pub struct Panel {
    /// What stands over it.
    pub title: String,
    /// The lower axis.
    pub x: Axis,
    /// The left axis.
    pub y: Axis,
    /// What is drawn, the last on top.
    pub series: Vec<Series>,
}

/// One axis.
#[derive(Debug, Clone)]
pub struct Axis {
    /// What it shows, with the unit.
    pub(crate) name: String,
    /// Its values; as far as what is drawn where it is not given.
    pub range: Option<Range<f64>>,
}

/// Marks of one look.
#[derive(Debug, Clone, Default)]
pub struct Series {
    pub(crate) name: String,
    /// Whether a line goes through the places of a mark.
    pub(crate) line: bool,
    /// Whether there is a marker at each.
    pub(crate) points: bool,
    /// Opacity of the area within them.
    pub(crate) fill: Option<f64>,
    /// What each mark goes through.
    pub(crate) marks: Vec<Vec<Place>>,
    /// Another colour than the next of the palette.
    pub color: Option<RGBColor>,
    /// Half the width of markers, pixels.
    pub size: u32,
    /// Where the name begins, if there are marks.
    pub(crate) name_at: Option<Place>,
}

impl Figure {
    /// Two panels side by side.
    pub fn new(title: &str, panels: impl IntoIterator<Item = Panel>) -> Self {
        let panels = panels.into_iter().collect();
        Self { title: title.to_owned(), panels, columns: 2, panel_size: (480, 360) }
    }
}

impl Axis {
    /// Values.
    pub fn linear(name: &str) -> Self {
        Self { name: name.to_owned(), range: None }
    }

    /// A share or probability.
    pub fn unit(name: &str) -> Self {
        Self { range: Some(-0.03..1.03), ..Self::linear(name) }
    }
}

impl Series {
    /// Marks that nothing shows yet.
    fn new(name: &str, marks: impl IntoIterator<Item = Vec<Place>>) -> Self {
        let (name, marks) = (name.to_owned(), marks.into_iter().collect());
        Self { name, marks, size: 4, ..Self::default() }
    }

    /// The same with its name written from this place on, in the units of the axes.
    pub fn named_at(self, x: f64, y: f64) -> Self {
        Self { name_at: Some((x, y)), ..self }
    }

    /// A line through the places in order.
    pub fn line(name: &str, places: impl IntoIterator<Item = Place>) -> Self {
        Self { line: true, ..Self::new(name, [places.into_iter().collect()]) }
    }

    /// A marker at each place.
    pub fn points(name: &str, places: impl IntoIterator<Item = Place>) -> Self {
        Self { points: true, ..Self::new(name, [places.into_iter().collect()]) }
    }

    /// A line through the places in order with a marker at each.
    pub fn curve(name: &str, places: impl IntoIterator<Item = Place>) -> Self {
        Self { points: true, ..Self::line(name, places) }
    }

    /// The area between two curves, to see through: x, and y from and to.
    pub fn band(name: &str, spans: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        let spans: Vec<_> = spans.into_iter().collect();
        let back = spans.iter().rev().map(|&(x, _, high)| (x, high));
        let edge = spans.iter().map(|&(x, low, _)| (x, low)).chain(back).collect();
        Self { fill: Some(0.25), ..Self::new(name, [edge]) }
    }

    /// Filled polygons.
    pub fn polygons(name: &str, polygons: impl IntoIterator<Item = Vec<Place>>) -> Self {
        Self { fill: Some(1.0), ..Self::new(name, polygons) }
    }
}

//! What a figure shows, as plain data.

use plotters::style::RGBColor;

use super::axis::Axis;

/// A place in a panel, in the units of its axes.
pub type Place = (f64, f64);

/// The colours of Okabe and Ito, without the yellow that white paper swallows.
pub mod palette {
    #![allow(missing_docs, reason = "each is called what it is")]
    use super::RGBColor;

    pub const BLUE: RGBColor = RGBColor(0, 114, 178);
    pub const VERMILION: RGBColor = RGBColor(213, 94, 0);
    pub const GREEN: RGBColor = RGBColor(0, 158, 115);
    pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
    pub const PURPLE: RGBColor = RGBColor(204, 121, 167);
    pub const BLACK: RGBColor = RGBColor(0, 0, 0);
    pub const SKY: RGBColor = RGBColor(86, 180, 233);
    pub const GREY: RGBColor = RGBColor(120, 120, 120);

    pub(in super::super) const SERIES: [RGBColor; 8] =
        [BLUE, VERMILION, GREEN, ORANGE, PURPLE, BLACK, SKY, GREY];
}

/// Panels in a grid under one title, with one legend at their right.
#[derive(Debug, Clone)]
pub struct Figure {
    pub(super) title: String,
    pub(super) panels: Vec<Panel>,
    pub(super) columns: usize,
    /// Width and height of a panel, pixels.
    pub(super) panel_size: (u32, u32),
}

/// Axes and what is drawn in them, in order.
#[derive(Debug, Clone)]
pub struct Panel {
    pub(super) title: String,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) series: Vec<Series>,
    pub(super) equal_aspect: bool,
}

/// Marks of one look.
#[derive(Debug, Clone)]
pub struct Series {
    pub(super) name: String,
    pub(super) kind: Kind,
    /// What each mark goes through.
    pub(super) marks: Vec<Vec<Place>>,
    /// What is written at each mark.
    pub(super) words: Vec<String>,
    pub(super) color: Option<RGBColor>,
    pub(super) opacity: f64,
    pub(super) size: u32,
}

/// How the places of a mark are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Line,
    Dashes,
    Points,
    /// A line with points.
    Curve,
    /// From 0 to each place.
    Bars,
    Area,
    Arrow,
    Words,
}

impl Figure {
    /// No panels yet; up to two side by side.
    pub fn new(title: &str) -> Self {
        Self { title: title.to_owned(), panels: Vec::new(), columns: 2, panel_size: (480, 360) }
    }

    /// Adds a panel, from left to right and then downwards.
    #[must_use]
    pub fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// So many panels side by side.
    #[must_use]
    pub fn columns(self, columns: usize) -> Self {
        Self { columns: columns.max(1), ..self }
    }

    /// Width and height of each panel, pixels.
    #[must_use]
    pub fn panel_size(self, width: u32, height: u32) -> Self {
        Self { panel_size: (width, height), ..self }
    }
}

impl Panel {
    /// An empty panel.
    pub fn new(x: Axis, y: Axis) -> Self {
        Self { title: String::new(), x, y, series: Vec::new(), equal_aspect: false }
    }

    /// Its title.
    #[must_use]
    pub fn title(self, title: &str) -> Self {
        Self { title: title.to_owned(), ..self }
    }

    /// Draws this over what is there.
    #[must_use]
    pub fn series(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Makes a unit as long along x as along y, by showing more along one of them.
    #[must_use]
    pub fn equal_aspect(self) -> Self {
        Self { equal_aspect: true, ..self }
    }
}

impl Series {
    fn new(name: &str, kind: Kind, marks: impl IntoIterator<Item = Vec<Place>>) -> Self {
        let (name, marks) = (name.to_owned(), marks.into_iter().collect());
        Self { name, kind, marks, words: Vec::new(), color: None, opacity: 1.0, size: 4 }
    }

    /// A line through the places in order.
    pub fn line(name: &str, places: impl IntoIterator<Item = Place>) -> Self {
        Self::new(name, Kind::Line, [places.into_iter().collect()])
    }

    /// A dashed line through the places in order, grey and without a name: a bound, a diagonal.
    pub fn guide(places: impl IntoIterator<Item = Place>) -> Self {
        Self::new("", Kind::Dashes, [places.into_iter().collect()])
    }

    /// A marker at each place.
    pub fn points(name: &str, places: impl IntoIterator<Item = Place>) -> Self {
        Self::new(name, Kind::Points, [places.into_iter().collect()])
    }

    /// A line through the places in order with a marker at each.
    pub fn curve(name: &str, places: impl IntoIterator<Item = Place>) -> Self {
        Self::new(name, Kind::Curve, [places.into_iter().collect()])
    }

    /// Upright bars of error: x, and y from and to.
    pub fn whiskers(name: &str, spans: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        let ends = spans.into_iter().map(|(x, low, high)| vec![(x, low), (x, high)]);
        Self::new(name, Kind::Line, ends)
    }

    /// The area between two curves: x, and y from and to.
    pub fn band(name: &str, spans: impl IntoIterator<Item = (f64, f64, f64)>) -> Self {
        let spans: Vec<_> = spans.into_iter().collect();
        let back = spans.iter().rev().map(|&(x, _, high)| (x, high));
        let edge = spans.iter().map(|&(x, low, _)| (x, low)).chain(back).collect();
        Self::polygons(name, [edge]).opacity(0.25)
    }

    /// Bars from 0 to the places, [`size`](Self::size) pixels wide.
    pub fn bars(name: &str, places: impl IntoIterator<Item = Place>) -> Self {
        Self::new(name, Kind::Bars, [places.into_iter().collect()]).size(14)
    }

    /// Filled polygons.
    pub fn polygons(name: &str, polygons: impl IntoIterator<Item = Vec<Place>>) -> Self {
        Self::new(name, Kind::Area, polygons)
    }

    /// Arrows from the first place to the second.
    pub fn arrows(name: &str, arrows: impl IntoIterator<Item = [Place; 2]>) -> Self {
        Self::new(name, Kind::Arrow, arrows.into_iter().map(Vec::from))
    }

    /// Words that start at their place.
    pub fn notes(notes: impl IntoIterator<Item = (Place, String)>) -> Self {
        let (marks, words): (Vec<_>, _) = notes.into_iter().map(|(at, w)| (vec![at], w)).unzip();
        Self { words, ..Self::new("", Kind::Words, marks) }.color(palette::BLACK)
    }

    /// Another colour than the next of the palette.
    #[must_use]
    pub fn color(self, color: RGBColor) -> Self {
        Self { color: Some(color), ..self }
    }

    /// From 0, unseen, to 1.
    #[must_use]
    pub fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// Half the width of markers or the width of bars, pixels.
    #[must_use]
    pub fn size(self, size: u32) -> Self {
        Self { size, ..self }
    }
}

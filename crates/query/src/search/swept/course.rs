//! At which poses about its own B is looked at.

use cloudtouch_geom::{BoxDrift, Drift, Matrix3, Point3, Vector3};

/// What poses B may be at, or A as B sees it: what [`Drift`] says of those along a motion is said of any of them.
#[derive(Debug, Clone, Copy)]
pub(super) enum Course {
    /// Along a motion.
    Along(Drift),
    /// Anywhere about the pose.
    Anywhere(Anywhere),
}

/// Any pose that takes no point of B far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Anywhere {
    /// No piece of B gets farther from its place than this, m, ...
    pub way: f64,
    /// ... and no unit vector turns by more: the length of the difference.
    pub turn: f64,
    /// How far discs and edges reach from the pieces of what moves, m.
    pub reach: f64,
    /// Of A as B sees it: a place within B, and how far from a piece of B what it meets can be, m.
    pub lever: Option<(Point3, f64)>,
}

impl Anywhere {
    /// How far what is within a radius of a place gets, m: what is beside B turns about it.
    fn within(&self, place: &Point3, radius: f64) -> f64 {
        let lever = |(middle, most): (Point3, f64)| ((place - middle).norm() + radius).min(most);
        self.way + self.turn * self.lever.map_or(0.0, lever)
    }
}

impl Course {
    /// Where a point is headed, m.
    pub(super) fn first_order(&self, place: &Point3) -> Vector3 {
        match self {
            Self::Along(drift) => drift.first_order(place),
            Self::Anywhere(_) => Vector3::zeros(),
        }
    }

    /// How far beside that it gets, m.
    pub(super) fn beyond_first_order(&self, place: &Point3) -> f64 {
        match self {
            Self::Along(drift) => drift.beyond_first_order(place, 0.0),
            Self::Anywhere(about) => about.within(place, 0.0),
        }
    }

    /// Which share of that may be along a unit vector.
    pub(super) fn across_axis(&self, direction: &Vector3) -> f64 {
        match self {
            Self::Along(drift) => drift.across_axis(direction),
            Self::Anywhere(_) => 1.0,
        }
    }

    /// How far along a unit vector a point gets from its place at most, m.
    pub(super) fn along(&self, direction: &Vector3, place: &Point3) -> f64 {
        match self {
            Self::Along(drift) => drift.along(direction, place),
            Self::Anywhere(about) => about.within(place, 0.0),
        }
    }

    /// How far in any direction, m.
    pub(super) fn in_any_direction(&self, place: &Point3) -> f64 {
        match self {
            Self::Along(drift) => drift.in_any_direction(place),
            Self::Anywhere(about) => about.within(place, 0.0),
        }
    }

    /// By how much a unit vector turns at most, as a length of the difference.
    pub(super) fn turn(&self) -> f64 {
        match self {
            Self::Along(drift) => drift.turn(),
            Self::Anywhere(about) => about.turn,
        }
    }

    /// What it does to a box, given by its middle and its half axes (columns).
    pub(super) fn of_box(&self, middle: &Point3, half_axes: &Matrix3) -> BoxCourse {
        match self {
            Self::Along(drift) => BoxCourse::Along(drift.of_box(middle, half_axes, 0.0)),
            Self::Anywhere(about) => {
                // Discs end beyond their middles.
                let of_pieces = about.within(middle, half_axes.norm());
                BoxCourse::Anywhere(of_pieces + about.turn * about.reach)
            }
        }
    }
}

/// How far what is in a box gets.
#[derive(Debug, Clone, Copy)]
pub(super) enum BoxCourse {
    Along(BoxDrift),
    /// In any direction, m.
    Anywhere(f64),
}

impl BoxCourse {
    /// Along a unit vector, either way, m.
    pub(super) fn along(&self, direction: &Vector3) -> f64 {
        match self {
            Self::Along(drift) => drift.along(direction),
            Self::Anywhere(way) => *way,
        }
    }
}

//! A plane that pieces of the other body may pass while one of the two drifts.

use cloudtouch_geom::{Point3, Vector3};

use super::course::Course;
use super::track::{Direction, Track};

/// A plane, looked at between two times.
pub(super) struct Plane<'a> {
    direction: Direction,
    place: &'a Point3,
    times: [f64; 2],
    turn: f64,
}

/// Of two places above a plane, m.
pub(super) struct Heights {
    /// Halfway between the times.
    pub at: [f64; 2],
    /// What they change by until either.
    pub changes: [f64; 2],
    /// The first is above the second by no less and no more than this.
    pub apart: [f64; 2],
}

/// Where a place gets to, and how well its height is known, m.
pub(super) struct Known {
    pub track: Track,
    pub to: f64,
}

impl<'a> Plane<'a> {
    /// Through a place, across a unit normal; `drift` is that of what passes.
    pub(super) fn new(normal: Vector3, place: &'a Point3, times: [f64; 2], drift: &Course) -> Self {
        Self { direction: Direction::new(normal, drift), place, times, turn: drift.turn() }
    }

    /// Of two places that are so far apart, m.
    pub(super) fn heights(&self, tracks: [&Track; 2], distance: f64) -> Heights {
        let Direction { n, across } = self.direction;
        let [from, to] = self.times;
        let home = tracks.map(|track| n.dot(&(track.place - self.place)));
        let turn = self.turn * across * distance;
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let slopes = tracks.map(|track| track.way.dot(&n));
        Heights {
            at: [0, 1].map(|k| home[k] + middle * slopes[k]),
            changes: [0, 1].map(|k| half * slopes[k].abs() + across * tracks[k].beside),
            apart: [home[0] - home[1] - turn, home[0] - home[1] + turn],
        }
    }

    /// How clearly two places get to different sides at most, in deviations.
    pub(super) fn clear(&self, [one, other]: [&Known; 2]) -> f64 {
        let distance = (one.track.place - other.track.place).norm();
        let Heights { at, changes, apart } = self.heights([&one.track, &other.track], distance);
        let clear = |above: f64, below: f64, apart: f64| {
            (above / one.to).min(below / other.to).min(apart / (one.to + other.to))
        };
        let first_above = clear(at[0] + changes[0], changes[1] - at[1], apart[1]);
        let second_above = clear(changes[0] - at[0], at[1] + changes[1], -apart[0]);
        first_above.max(second_above).max(0.0)
    }
}

//! How clearly two places could get to different sides of a plane while they drift.

use cloudtouch_geom::{Drift, Point3, Vector3};

use super::track::{Direction, Track};

/// A plane that something passes between two times, with how well the ends of an edge are known across it,
/// m; `drift` is that of what passes.
pub(super) struct Sides<'a> {
    pub normal: Vector3,
    pub place: &'a Point3,
    pub times: [f64; 2],
    pub stds: [f64; 2],
    pub drift: &'a Drift,
}

impl Sides<'_> {
    /// How clearly two places, each with its track and how well it is known, get to different sides at most.
    pub(super) fn clear(&self, pair: [&(Point3, Track, f64); 2]) -> f64 {
        let direction = Direction::new(self.normal, self.drift);
        let (middle, half) =
            (0.5 * (self.times[0] + self.times[1]), 0.5 * (self.times[1] - self.times[0]));
        let home = pair.map(|(place, _, _)| self.normal.dot(&(place - self.place)));
        let slopes = pair.map(|(_, track, _)| track.way.dot(&self.normal));
        let heights = [0, 1].map(|k| home[k] + middle * slopes[k]);
        let changes = [0, 1].map(|k| half * slopes[k].abs() + direction.across * pair[k].1.beside);
        let turn = self.drift.turn() * direction.across * (pair[0].0 - pair[1].0).norm();
        let known = pair.map(|(_, _, known)| known);
        let one_way = |sign: f64| {
            let most = [sign * heights[0] + changes[0], changes[1] - sign * heights[1]];
            let apart = sign * (home[0] - home[1]) + turn;
            (most[0] / known[0]).min(most[1] / known[1]).min(apart / (known[0] + known[1]))
        };
        one_way(1.0).max(one_way(-1.0)).max(0.0)
    }
}

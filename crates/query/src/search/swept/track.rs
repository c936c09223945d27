//! Where a point gets to against the other body while one of them drifts.

use cloudtouch_geom::{Point3, Vector3};

use crate::cloud::Ball;

use super::course::Course;

use crate::search::compare::facet::Facet;
use crate::search::compare::triangle::nearest_to_origin;

/// How often the nearest place of a facet and the time of it are looked for in turn.
const TURNS: usize = 3;
/// What times and distances are rounded by, relative.
const ROUNDING: f64 = 1e-9;

/// A straight way through a place, and how far beside it the point may be, m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Track {
    pub place: Point3,
    pub way: Vector3,
    pub beside: f64,
}

/// A unit vector, with what a turn takes of it: [`Course::across_axis`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Direction {
    pub n: Vector3,
    pub across: f64,
}

impl Direction {
    pub(super) fn new(n: Vector3, drift: &Course) -> Self {
        Self { n, across: drift.across_axis(&n) }
    }
}

impl Track {
    pub(super) fn of(place: &Point3, drift: &Course) -> Self {
        let (way, beside) = (drift.first_order(place), drift.beyond_first_order(place));
        Self { place: *place, way, beside }
    }

    /// How far along a direction it gets from its place at most, either way, m.
    pub(super) fn along(&self, direction: &Direction) -> f64 {
        self.way.dot(&direction.n).abs() + direction.across * self.beside
    }

    /// How far in any direction, m.
    pub(super) fn in_any_direction(&self) -> f64 {
        self.way.norm() + self.beside
    }

    /// From when to when it may be within a distance of a place, as the s from −1 to 1; `None` where it
    /// never is.
    pub(super) fn times_near(&self, place: &Point3, distance: f64) -> Option<[f64; 2]> {
        let reach = (distance + self.beside) * (1.0 + ROUNDING);
        let offset = self.place - place;
        let (slope, curvature) = (offset.dot(&self.way), self.way.norm_squared());
        let nearest = offset.norm_squared() - reach * reach;
        if curvature <= f64::MIN_POSITIVE {
            return (nearest <= 0.0).then_some([-1.0, 1.0]);
        }
        let root = slope * slope - curvature * nearest;
        if root < 0.0 {
            return None;
        }
        let half = root.sqrt() * (1.0 + ROUNDING) / curvature;
        let (from, to) = (-slope / curvature - half, -slope / curvature + half);
        (from <= 1.0 && to >= -1.0).then(|| [from.max(-1.0), to.min(1.0)])
    }

    /// Whether it gets within a distance of a ball, m; never no by rounding.
    pub(super) fn gets_to(&self, ball: &Ball, distance: f64) -> bool {
        ball.is_within(&self.nearest_to(&ball.middle), distance + self.beside)
    }

    fn nearest_to(&self, place: &Point3) -> Point3 {
        self.place + self.way * nearest_time(&(self.place - place), &self.way)
    }
}

/// A straight piece that drifts stays at least so far from a place, m.
pub(super) fn piece_keeps_off([from, to]: &[Point3; 2], place: &Point3, drift: &Course) -> f64 {
    let ways = [from, to].map(|end| drift.first_order(end));
    let way = 0.5 * (ways[0] + ways[1]);
    let beside = [from, to].map(|end| drift.beyond_first_order(end));
    let [p, q] = [from, to].map(|end| end - place);
    // All it passes is about the parallelogram along the mean way.
    let halves = [[p - way, p + way, q + way], [p - way, q + way, q - way]];
    let nearest = halves.iter().map(|half| nearest_to_origin(half).norm()).fold(f64::MAX, f64::min);
    nearest - 0.5 * (ways[0] - ways[1]).norm() - beside[0].max(beside[1])
}

/// A facet, and where its corners get to.
#[derive(Debug, Clone, Copy)]
pub(super) struct SweptFacet<'a> {
    pub facet: &'a Facet,
    pub corners: &'a [Track; 3],
}

impl SweptFacet<'_> {
    /// Whether some of it gets between two heights along a direction, m.
    pub(super) fn gets_between(&self, [low, high]: [f64; 2], direction: &Direction) -> bool {
        let (mut is_above, mut is_below) = (true, true);
        for corner in self.corners {
            let (at, room) = (direction.n.dot(&corner.place.coords), corner.along(direction));
            is_above &= at - room > high;
            is_below &= at + room < low;
        }
        !is_above && !is_below
    }
}

/// A place and a facet that come nearer to one another or part.
pub(super) struct Approach<'a> {
    pub place: &'a Point3,
    pub facet: &'a Facet,
    pub drifting: Drifting<'a>,
    pub drift: &'a Course,
}

/// Which of the two drifts, and where it gets to.
#[derive(Debug, Clone, Copy)]
pub(super) enum Drifting<'a> {
    Place(&'a Track),
    Corners(&'a [Track; 3]),
}

impl Approach<'_> {
    /// How far the facet keeps from the place along a unit vector, away from it, m.
    pub(super) fn gap_along(&self, n: &Direction) -> f64 {
        let heights = self.facet.corners.map(|corner| n.n.dot(&(corner - self.place)));
        let least = |gaps: [f64; 3]| gaps.into_iter().fold(f64::INFINITY, f64::min);
        match self.drifting {
            Drifting::Place(track) => least(heights) - track.along(n),
            Drifting::Corners(tracks) => least([0, 1, 2].map(|k| heights[k] - tracks[k].along(n))),
        }
    }

    /// Where the facet is headed as seen from the place, m, as if it did not turn about that.
    pub(super) fn way(&self) -> Vector3 {
        match self.drifting {
            Drifting::Place(track) => -track.way,
            Drifting::Corners(_) => self.drift.first_order(self.place),
        }
    }

    /// They stay at least so far apart, m; less than zero says nothing.
    pub(super) fn keep_off(&self) -> f64 {
        let offsets = self.facet.corners.map(|corner| corner - self.place);
        let along = |n| self.gap_along(&Direction::new(n, self.drift));
        directions(&offsets, &self.way()).map(along).fold(0.0, f64::max)
    }
}

/// Unit vectors that part the origin from a triangle carried along a way and back: each step points
/// at the nearest place so far.
pub(super) fn directions<'a>(
    corners: &'a [Vector3; 3],
    way: &'a Vector3,
) -> impl Iterator<Item = Vector3> + 'a {
    let mut time = 0.0;
    (0..TURNS).map_while(move |_| {
        let nearest = nearest_to_origin(&corners.map(|corner| corner + way * time));
        time = nearest_time(&(nearest - way * time), way);
        nearest.try_normalize(0.0)
    })
}

/// The s from −1 to 1 at which δ + s·u is shortest.
pub(super) fn nearest_time(offset: &Vector3, way: &Vector3) -> f64 {
    least_at(offset.dot(way), way.norm_squared())
}

/// Where 2·s·slope + s²·curvature is least, s from −1 to 1.
pub(super) fn least_at(slope: f64, curvature: f64) -> f64 {
    if curvature > 0.0 { (-slope / curvature).clamp(-1.0, 1.0) } else { 0.0 }
}

//! Boxes about what is in a leaf: most of what another leaf could meet there is told by one of them.

use cloudtouch_geom::{Matrix3, Point3, Vector3};

use super::course::{BoxCourse, Course};
use super::track::{Direction, SweptFacet};

/// A box, in the frame of A.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hull {
    middle: Point3,
    /// Half its size along each of its axes, as columns.
    half_axes: Matrix3,
    /// How far what is in it gets.
    drift: BoxCourse,
}

/// What heights are rounded by, relative to the size of the box and its way.
const ROUNDING: f64 = 1e-9;

impl Hull {
    /// About places, each with how far what is there reaches along each of the axes (columns), m; `None`
    /// about nothing.
    pub(super) fn around(
        axes: &Matrix3,
        places: impl Iterator<Item = (Point3, Vector3)>,
        drift: &Course,
    ) -> Option<Self> {
        let span = places
            .map(|(place, reach)| {
                let at = axes.tr_mul(&place.coords);
                (at - reach, at + reach)
            })
            .reduce(|(low, high), (from, to)| (low.inf(&from), high.sup(&to)));
        span.map(|(low, high)| {
            let middle = Point3::from(axes * (0.5 * (low + high)));
            let half_axes = axes * Matrix3::from_diagonal(&(0.5 * (high - low)));
            Self { middle, half_axes, drift: drift.of_box(&middle, &half_axes) }
        })
    }

    /// Between which heights everything in it is along a unit vector, m; never too narrow by rounding.
    pub(super) fn heights(&self, n: &Vector3) -> [f64; 2] {
        let (height, half) = (n.dot(&self.middle.coords), self.half_axes.tr_mul(n).abs().sum());
        let room = half + ROUNDING * (half + height.abs());
        [height - room, height + room]
    }

    /// The same wherever it gets.
    pub(super) fn heights_on_the_way(&self, n: &Vector3) -> [f64; 2] {
        let ([low, high], room) = (self.heights(n), self.drift.along(n));
        [low - room, high + room]
    }

    /// Whether two boxes may meet while the second drifts, as far as one direction tells.
    pub(super) fn meets_along(&self, drifting: &Self, n: &Vector3) -> bool {
        let ([low, high], [from, to]) = (self.heights(n), drifting.heights_on_the_way(n));
        from <= high && to >= low
    }

    /// Whether a triangle of the other body may meet it, as far as the plane of the triangle and one
    /// direction tell.
    pub(super) fn meets_facet(&self, swept: &SweptFacet<'_>, direction: &Direction) -> bool {
        swept.gets_between(self.heights(&direction.n), direction) && self.meets_plane_of(swept)
    }

    /// As far as the plane of the triangle tells.
    pub(super) fn meets_plane_of(&self, SweptFacet { facet, .. }: &SweptFacet<'_>) -> bool {
        facet.normal.is_none_or(|n| {
            let ([low, high], at) = (self.heights_on_the_way(&n), n.dot(&facet.corners[0].coords));
            low <= at && at <= high
        })
    }
}

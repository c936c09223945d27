//! Boxes about what is in a leaf: most of what another leaf could meet there is told by one of them.

use cloudtouch_geom::{Drift, Matrix3, Point3, Vector3};

use super::super::facet::Facet;

/// A box, in the frame of A.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hull {
    middle: Point3,
    /// Half its size along each of its axes, as columns.
    half_axes: Matrix3,
}

/// What heights are rounded by, relative to the size of the box and its way.
const ROUNDING: f64 = 1e-9;

impl Hull {
    /// About places, each with how far what is there reaches along each of the axes (columns), m; `None`
    /// about nothing.
    pub(super) fn around(
        axes: &Matrix3,
        places: impl Iterator<Item = (Point3, Vector3)>,
    ) -> Option<Self> {
        let span = places
            .map(|(place, reach)| {
                let at = axes.tr_mul(&place.coords);
                (at - reach, at + reach)
            })
            .reduce(|(low, high), (from, to)| (low.inf(&from), high.sup(&to)));
        span.map(|(low, high)| Self {
            middle: Point3::from(axes * (0.5 * (low + high))),
            half_axes: axes * Matrix3::from_diagonal(&(0.5 * (high - low))),
        })
    }

    /// Between which heights above a place everything in it keeps along a unit vector while one of the two
    /// drifts, m.
    pub(super) fn heights(&self, n: &Vector3, place: &Point3, drift: &Drift) -> [f64; 2] {
        let height = n.dot(&(self.middle - place));
        let half = self.half_axes.tr_mul(n).abs().sum()
            + drift.along_of_box(n, &self.middle, &self.half_axes, 0.0);
        let room = half + ROUNDING * (half + height.abs());
        [height - room, height + room]
    }

    /// Whether anything in it may get to the plane of a triangle; one without a plane is anywhere.
    pub(super) fn gets_to_plane(&self, facet: &Facet, drift: &Drift) -> bool {
        facet.normal.is_none_or(|n| {
            let [low, high] = self.heights(&n, &facet.corners[0], drift);
            low <= 0.0 && high >= 0.0
        })
    }
}

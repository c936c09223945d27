//! A triangle of a mesh: an exact piece of surface.

use cloudtouch_geom::{Motion, Point3, Vector3};

use crate::cloud::Surfel;

use super::meeting::{are_beyond, beyond_along};
use super::triangle::nearest_to_origin;
use super::whitening::Whitening;

/// A triangle in the local frame of A.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Facet {
    /// Index in the prepared mesh.
    pub triangle: u32,
    pub corners: [Point3; 3],
    /// Unit normal by the turn of its corners; `None` for a degenerate one.
    pub normal: Option<Vector3>,
}

/// Where an edge passes through a facet.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Pierced {
    pub place: Point3,
    /// Heights of the two ends above the facet, m: of unequal sign.
    pub heights: [f64; 2],
}

impl Facet {
    pub(in crate::search) fn new(triangle: u32, corners: [Point3; 3]) -> Self {
        let [p, q, r] = corners;
        let normal = (q - p).cross(&(r - p)).try_normalize(0.0);
        Self { triangle, corners, normal }
    }

    /// The same in another frame.
    pub(in crate::search) fn moved(&self, motion: &Motion) -> Self {
        Self {
            corners: self.corners.map(|corner| motion.point(&corner)),
            normal: self.normal.map(|normal| motion.vector(&normal)),
            ..*self
        }
    }

    /// The height of a place above its plane, m; zero where it has none.
    pub(in crate::search) fn height(&self, place: &Point3) -> f64 {
        self.normal.map_or(0.0, |normal| normal.dot(&(place - self.corners[0])))
    }

    /// The way to it from a place, m.
    pub(in crate::search) fn way_from(&self, place: &Point3) -> Vector3 {
        nearest_to_origin(&self.corners.map(|corner| corner - place))
    }

    /// Where the straight line between two ends passes through it; its border counts.
    pub(in crate::search) fn pierced_by(&self, ends: &[Point3; 2]) -> Option<Pierced> {
        let normal = self.normal?;
        let heights = ends.map(|end| self.height(&end));
        if heights[0] * heights[1] >= 0.0 {
            return None;
        }
        let share = heights[0] / (heights[0] - heights[1]);
        let place = ends[0] + (ends[1] - ends[0]) * share;
        let is_inside = |k: usize| {
            let (from, to) = (self.corners[k], self.corners[(k + 1) % 3]);
            (to - from).cross(&(place - from)).dot(&normal) >= 0.0
        };
        (0..3).all(is_inside).then_some(Pierced { place, heights })
    }

    /// How many deviations a surfel is from being within a margin (m) of the facet; negative where it is
    /// within it: across the plane that separates them best, or along the shortest way.
    pub(in crate::search) fn deviations_beyond(
        &self,
        surfel: &Surfel,
        whitening: &Whitening,
        margin: f64,
    ) -> f64 {
        let mean = surfel.point.mean;
        let covariance = surfel.point.covariance.matrix();
        let offsets = self.corners.map(|corner| corner - mean);
        let whitened = nearest_to_origin(&offsets.map(|offset| whitening.apply(&offset)));
        let separating = whitening.apply(&whitened);
        let by_plane = beyond_along((&covariance, &whitening.undo(&whitened)), &separating, margin);
        let shortest = nearest_to_origin(&offsets);
        // Of either place all others of the facet lie beyond the plane across that direction. Along the way to
        // the first, which may be far off in a large facet, they do not.
        by_plane.max(beyond_along((&covariance, &shortest), &shortest, margin))
    }

    /// Squared Mahalanobis distance from a surfel to the nearest place of the facet and the way
    /// there, where that is below `limit`.
    pub(in crate::search) fn squared_deviations(
        &self,
        surfel: &Surfel,
        whitening: &Whitening,
        limit: f64,
    ) -> Option<(f64, Vector3)> {
        let mean = surfel.point.mean;
        let height = self.height(&mean);
        // No direction has more variance than this: most pairs end here.
        if height * height > limit * surfel.most_variance {
            return None;
        }
        // PERF: of the others most are apart across the facet.
        let variance = self.normal.map(|normal| whitening.variance_along(&normal));
        if variance.is_some_and(|variance| are_beyond(height, variance, limit)) {
            return None;
        }
        let corners = self.corners.map(|corner| whitening.apply(&(corner - mean)));
        let nearest = nearest_to_origin(&corners);
        let squared = nearest.norm_squared();
        (squared < limit).then(|| (squared, whitening.undo(&nearest)))
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, UncertainPoint, unit};
    use cloudtouch_noise::Refined;
    use proptest::prelude::*;

    use super::*;

    /// Of no fitted surface.
    fn piece(point: UncertainPoint) -> Surfel {
        Surfel::new(0, &Refined { point, spacing: 1.0, normal: None, shared: 0.0 })
    }

    fn vector() -> impl Strategy<Value = Vector3> {
        (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(|(x, y, z)| Vector3::new(x, y, z))
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn the_way_to_a_facet_ends_on_it_and_is_as_long_as_said(
            a in vector(), b in vector(), c in vector(), axis in vector(), mean in vector(),
        ) {
            prop_assume!((b - a).cross(&(c - a)).norm() > 1e-3 && axis.norm() > 1e-3);
            let covariance = Covariance::from_axis(&unit(&axis).unwrap(), 0.1, 0.4);
            let surfel = piece(UncertainPoint { mean: Point3::from(mean), covariance });
            let facet = Facet::new(0, [a, b, c].map(Point3::from));
            let whitening = Whitening::of_any(&covariance);
            let (squared, way) = facet.squared_deviations(&surfel, &whitening, 1e6).unwrap();
            prop_assert!(facet.height(&(surfel.point.mean + way)).abs() < 1e-9);
            let back = whitening.apply(&way).norm_squared();
            prop_assert!((back - squared).abs() < 1e-9 * (1.0 + squared));
        }

        /// By the nearest place alone.
        #[test]
        fn a_facet_is_left_out_by_its_height_only_where_it_has_more_deviations(
            a in vector(), b in vector(), c in vector(), axis in vector(),
            stds in prop::array::uniform2(1e-4..0.5_f64), limit in 0.0..40.0_f64,
        ) {
            prop_assume!((b - a).cross(&(c - a)).norm() > 1e-3 && axis.norm() > 1e-3);
            let covariance = Covariance::from_axis(&unit(&axis).unwrap(), stds[0], stds[1]);
            let surfel = piece(UncertainPoint { mean: Point3::origin(), covariance });
            let facet = Facet::new(0, [a, b, c].map(Point3::from));
            let whitening = Whitening::of_any(&covariance);
            let squared = nearest_to_origin(&[a, b, c].map(|v| whitening.apply(&v))).norm_squared();
            let found = facet.squared_deviations(&surfel, &whitening, limit);
            prop_assert_eq!(found.map(|(squared, _)| squared), (squared < limit).then_some(squared));
        }

        /// A large facet was told to be beyond a margin that its nearest place is within: by the way to
        /// another place, which is nearer in deviations.
        #[test]
        fn what_is_nearer_than_a_margin_is_not_beyond_it(
            a in vector(), b in vector(), c in vector(), axis in vector(),
            nearer in 0.0..1.0_f64, stds in prop::array::uniform2(0.001..0.5_f64),
        ) {
            prop_assume!((b - a).cross(&(c - a)).norm() > 1e-3 && axis.norm() > 1e-3);
            let covariance = Covariance::from_axis(&unit(&axis).unwrap(), stds[0], stds[1]);
            let surfel = piece(UncertainPoint { mean: Point3::origin(), covariance });
            let distance = nearest_to_origin(&[a, b, c]).norm();
            let facet = Facet::new(0, [a, b, c].map(Point3::from));
            let of = |margin| {
                facet.deviations_beyond(&surfel, &Whitening::of_any(&covariance), margin)
            };
            prop_assert!(of(distance * (1.0 + nearer) + 1e-9) < 0.0);
            // And what is farther is, however little.
            prop_assert!(distance == 0.0 || of(distance * (1.0 - nearer) * (1.0 - 1e-9)) > 0.0);
        }
    }

    #[test]
    fn an_edge_passes_a_facet_inside_its_border_only() {
        let facet = Facet::new(
            0,
            [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, 0.0)),
        );
        let upright = |x: f64, y: f64| [Point3::new(x, y, -1.0), Point3::new(x, y, 2.0)];
        let pierced = facet.pierced_by(&upright(0.2, 0.3)).unwrap();
        assert_eq!((pierced.place, pierced.heights), (Point3::new(0.2, 0.3, 0.0), [-1.0, 2.0]));
        assert!(facet.pierced_by(&upright(0.6, 0.6)).is_none());
        assert!(
            facet.pierced_by(&[Point3::new(0.2, 0.3, 1.0), Point3::new(0.2, 0.3, 2.0)]).is_none()
        );
    }

    #[test]
    fn exact_pieces_at_one_place_are_no_deviations_apart() {
        let whitening = Whitening::of_any(&Covariance::zero());
        let surfel = piece(UncertainPoint::exact(Point3::new(0.2, 0.3, 0.0)));
        let facet = |z: f64| {
            Facet::new(0, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, z)))
        };
        let (squared, _) = facet(0.0).squared_deviations(&surfel, &whitening, 9.0).unwrap();
        assert!(squared < 1e-6, "{squared}");
        assert!(facet(1e-6).squared_deviations(&surfel, &whitening, 9.0).is_none());
    }
}

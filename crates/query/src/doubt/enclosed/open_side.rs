//! A side of a place without any point, told by the boxes of a tree: most places beside a scan have one,
//! and so need no look at all of its points.

use cloudtouch_bvh::{Obb, Tree, Visit};
use cloudtouch_geom::{Matrix3, Point3, Vector3};

/// Sides are pyramids along three axes, as wide as this times their height to either hand.
const SLOPE: f64 = 0.5;
/// The distance of a face is this times what is measured across the axis: 1 / √(1 + SLOPE²).
const ALONG: f64 = 0.894_427_190_999_915_9;
/// So much wider, and boxes so much larger, that rounding cannot leave a point out.
const ROUNDING: f64 = 1e-9;

/// Whether one of the six pyramids along these axes (columns) with their tops at a place holds no point, and has none so
/// near its faces (m) either; `points` by their indices in the tree.
pub(super) fn has_open_side(
    tree: &Tree,
    (points, near): (&[Point3], f64),
    (place, axes): (&Point3, &Matrix3),
) -> bool {
    let offset = |to: &Point3| axes.tr_mul(&(to - place));
    // PERF: away from most of the points nothing is the likeliest.
    let middle = tree.root().map_or_else(Vector3::zeros, |root| offset(&root.obb().centre));
    let mut sides = Side::all(near);
    sides.sort_by(|p, q| p.along(&middle).total_cmp(&q.along(&middle)));
    sides.into_iter().any(|side| {
        let mut is_open = true;
        tree.visit_nodes(|node| {
            if !is_open || !side.may_hold(&node.obb(), offset, axes) {
                return Visit::Prune;
            }
            let mut all = node.primitive_indices().iter();
            if node.is_leaf() && all.any(|&index| side.holds(&offset(&points[index as usize]))) {
                is_open = false;
            }
            Visit::Descend
        });
        is_open
    })
}

/// The directions that are nearest to one of an axis, to the half of what lies between it and the others, and
/// what is near them. Offsets are from its top, by the axes.
#[derive(Clone, Copy)]
struct Side {
    axis: usize,
    toward: f64,
    /// What is so far beside it or behind its top counts, m.
    near: f64,
}

impl Side {
    fn all(near: f64) -> [Self; 6] {
        [0, 1, 2, 3, 4, 5].map(|k| Self {
            axis: k / 2,
            toward: if k % 2 == 0 { 1.0 } else { -1.0 },
            near,
        })
    }

    fn along(self, offset: &Vector3) -> f64 {
        self.toward * offset[self.axis]
    }

    /// How far a place is within each of its four faces, and before its top, m: by unit normals.
    fn within_faces(self, offset: &Vector3) -> [f64; 5] {
        let before = self.along(offset);
        let half = ALONG * SLOPE * (1.0 + ROUNDING) * before;
        let [p, q] = [1, 2].map(|k| ALONG * offset[(self.axis + k) % 3]);
        [half - p, half + p, half - q, half + q, before]
    }

    fn holds(self, offset: &Vector3) -> bool {
        self.within_faces(offset).iter().all(|&within| within >= -self.near)
    }

    /// Whether some place of a box may be in it: not where a face parts them.
    fn may_hold(self, obb: &Obb, offset: impl Fn(&Point3) -> Vector3, axes: &Matrix3) -> bool {
        let offset = offset(&obb.centre);
        let mut most = self.within_faces(&offset);
        let size = obb.half_extents.lp_norm(1);
        let least = -(self.near + ROUNDING * (offset.lp_norm(1) + size));
        // PERF: most are told by the ball about them.
        let radius = obb.radius() * (1.0 + ROUNDING);
        if most.iter().any(|&most| most + radius < least) {
            return false;
        }
        for (axis, half) in obb.axes.column_iter().zip(&obb.half_extents) {
            let along = self.within_faces(&axes.tr_mul(&axis));
            for (most, along) in most.iter_mut().zip(along) {
                *most += half * along.abs();
            }
        }
        most.iter().all(|&most| most >= least)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_bvh::{Primitive, TreeSettings};
    use cloudtouch_geom::seed::{derive, unit};
    use cloudtouch_geom::{Covariance, Pose, UncertainPoint};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

        /// By looking at every point.
        #[test]
        fn a_side_is_open_where_it_holds_no_point(
            seed in any::<u64>(),
            count in 20_u64..400,
            // Beyond .3 the most of a ball is missing.
            up_to in -0.9..1.0_f64,
            place in prop::array::uniform3(-0.7..0.7_f64),
            turn in prop::array::uniform3(-3.0..3.0_f64),
            near in prop_oneof![Just(0.0), 0.0..0.1_f64],
        ) {
            let draw = |i, k| 2.0 * unit(derive(seed, i, k)) - 1.0;
            let drawn = (0..count).map(|i| Vector3::new(draw(i, 0), draw(i, 1), draw(i, 2)));
            let points: Vec<Point3> = drawn
                .filter_map(|p| p.try_normalize(0.01))
                .filter(|p| p.x + 0.3 * p.y < up_to)
                .map(Point3::from)
                .collect();
            prop_assume!(!points.is_empty());
            let covariance = Covariance::isotropic(1e-3);
            let primitive = |&mean: &Point3| Primitive::point(UncertainPoint { mean, covariance });
            let tree = Tree::build(points.iter().map(primitive).collect(), &TreeSettings::default());
            let place = Point3::from(Vector3::from(place));
            let axes = *Pose::from_translation_rpy(Vector3::zeros(), turn).rotation().to_rotation_matrix().matrix();
            let is_empty = |side: Side| !points.iter().any(|p| side.holds(&axes.tr_mul(&(p - place))));
            let expected = Side::all(near).into_iter().any(is_empty);
            let found = has_open_side(&tree.unwrap(), (&points, near), (&place, &axes));
            prop_assert_eq!(found, expected);
        }
    }
}

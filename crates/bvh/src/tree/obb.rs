//! Oriented boxes: containment, projections, and the ways a box grows.

use cloudtouch_geom::{Matrix3, Motion, Point3, Pose, Vector3};
use wide::f64x4;

/// An oriented bounding box; extents may be zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obb {
    /// The middle, m.
    pub centre: Point3,
    /// Unit axes as columns, orthogonal and right-handed.
    ///
    /// In a tree the first is the direction of largest variance, along which a node is split, and
    /// the last that of smallest variance, the normal of a flat patch.
    pub axes: Matrix3,
    /// Half the length along each axis, m; not negative.
    pub half_extents: Vector3,
}

/// Where places are along axes, from an origin, m; the fourth is zero.
pub(crate) fn in_frame(axes: &Matrix3, origin: &Point3) -> impl Fn(&Point3) -> f64x4 + use<> {
    // PERF: all three axes at once.
    let [x, y, z] = [0, 1, 2].map(|k| {
        let row = axes.row(k);
        f64x4::from([row[0], row[1], row[2], 0.0])
    });
    let origin = *origin;
    move |place| {
        let offset = place - origin;
        x * f64x4::splat(offset.x) + y * f64x4::splat(offset.y) + z * f64x4::splat(offset.z)
    }
}

impl Obb {
    /// The box spanned by `axes` that holds all `corners`; `origin` should be near them.
    ///
    /// Grown by the rounding of [`Self::to_local`], so that every corner passes [`Self::contains`].
    pub(crate) fn enclosing<'a>(
        axes: Matrix3,
        origin: Point3,
        corners: impl Iterator<Item = &'a Point3>,
    ) -> Self {
        let in_frame = in_frame(&axes, &origin);
        let mut low = f64x4::splat(f64::INFINITY);
        let mut high = f64x4::splat(f64::NEG_INFINITY);
        for corner in corners {
            let local = in_frame(corner);
            low = low.fast_min(local);
            high = high.fast_max(local);
        }
        let [low, high] = [low, high].map(|lanes| {
            let [x, y, z, _] = lanes.to_array();
            Vector3::new(x, y, z)
        });
        let centre = origin + axes * (0.5 * (low + high));
        Self { centre, axes, half_extents: 0.5 * (high - low) }.with_rounding()
    }

    /// Grows by what rounding can move a corner when it is expressed along the axes.
    fn with_rounding(mut self) -> Self {
        let size = self.centre.coords.lp_norm(1) + self.half_extents.sum();
        self.half_extents.add_scalar_mut(4.0 * f64::EPSILON * size);
        self
    }

    /// Coordinates of a point along the axes, from the centre, m.
    pub fn to_local(&self, point: &Point3) -> Vector3 {
        self.axes.tr_mul(&(point - self.centre))
    }

    /// Whether the point lies in the box or on its faces.
    pub fn contains(&self, point: &Point3) -> bool {
        let local = self.to_local(point);
        (0..3).all(|k| local[k].abs() <= self.half_extents[k])
    }

    /// Half the length (m) of the projection of the box on a unit vector.
    pub fn half_width_along(&self, direction: &Vector3) -> f64 {
        self.axes.tr_mul(direction).abs().dot(&self.half_extents)
    }

    /// Half the diagonal, m: every point of the box is at most this far from the centre.
    pub fn radius(&self) -> f64 {
        self.half_extents.norm()
    }

    /// The same box seen from another frame.
    pub fn transformed(&self, pose: &Pose) -> Self {
        self.moved(&Motion::from(pose))
    }

    /// The same by a motion that moves many boxes.
    pub fn moved(&self, motion: &Motion) -> Self {
        Self {
            centre: motion.point(&self.centre),
            axes: motion.rotation() * self.axes,
            half_extents: self.half_extents,
        }
    }

    /// Grows just enough to hold `point`, keeping the axes.
    pub(crate) fn include(&mut self, point: &Point3) {
        if self.contains(point) {
            return;
        }
        let local = self.to_local(point);
        let low = local.inf(&-self.half_extents);
        let high = local.sup(&self.half_extents);
        self.centre += self.axes * (0.5 * (low + high));
        self.half_extents = 0.5 * (high - low);
        *self = self.with_rounding();
    }

    /// Grows to hold every point of the box moved by any part of `offset`.
    pub(crate) fn extend(&mut self, offset: &Vector3) {
        let local = self.axes.tr_mul(offset);
        self.centre += 0.5 * offset;
        self.half_extents += 0.5 * local.abs();
        *self = self.with_rounding();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tilted_box() -> Obb {
        let pose = Pose::from_translation_rpy(Vector3::new(5e6, 4e5, 30.0), [0.3, 1.0, -2.0]);
        Obb {
            centre: Point3::origin(),
            axes: Matrix3::identity(),
            half_extents: Vector3::new(0.3, 0.2, 0.0),
        }
        .transformed(&pose)
    }

    #[test]
    fn including_a_point_grows_only_toward_it() {
        let mut grown = tilted_box();
        let before = grown;
        let outside = before.centre + before.axes.column(0) * 0.7;
        grown.include(&outside);
        assert!(grown.contains(&outside) && grown.contains(&before.centre));
        assert!((grown.half_extents - Vector3::new(0.5, 0.2, 0.0)).amax() < 1e-7);
        let again = grown;
        grown.include(&outside);
        assert_eq!(grown, again);
    }

    #[test]
    fn extending_sweeps_the_box() {
        let mut grown = tilted_box();
        let before = grown;
        let offset = Vector3::new(0.1, -0.2, 0.05);
        grown.extend(&offset);
        for part in [0.0, 0.5, 1.0] {
            for sign in [-1.0, 1.0] {
                let corner = before.centre + before.axes * (before.half_extents * sign);
                assert!(grown.contains(&(corner + offset * part)));
            }
        }
        assert!(
            (grown.half_width_along(&before.axes.column(0).into_owned())
                - (0.3 + 0.5 * before.axes.column(0).dot(&offset).abs()))
            .abs()
                < 1e-7
        );
    }
}

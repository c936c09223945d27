//! A straight way from a place.

use cloudtouch_bvh::Obb;
use cloudtouch_geom::{Point3, Vector3};

/// Rounding of a box, relative.
const ROUNDING: f64 = 1e-9;

/// A straight way from a place.
pub(super) struct Way {
    from: Point3,
    /// Unit length.
    along: Vector3,
    /// m; may be infinite.
    length: f64,
}

impl Way {
    /// So long, m; none in no direction.
    pub(super) fn toward(from: &Point3, direction: &Vector3, length: f64) -> Option<Self> {
        Some(Self { from: *from, along: direction.try_normalize(0.0)?, length })
    }

    /// Where it passes a plane.
    pub(super) fn meets_plane(&self, place: &Point3, normal: &Vector3) -> Option<Point3> {
        // Along the plane that is nowhere, or no number.
        let at = normal.dot(&(place - self.from)) / normal.dot(&self.along);
        (at > 0.0 && at < self.length).then(|| self.from + at * self.along)
    }

    /// m.
    pub(super) fn distance_to(&self, place: &Point3) -> f64 {
        let at = (place - self.from).dot(&self.along).clamp(0.0, self.length);
        (self.from + at * self.along - place).norm()
    }

    /// Whether it comes so near (m) to a box along each of its axes, as it does where it comes so near to a place
    /// in it.
    pub(super) fn may_pass(&self, obb: &Obb, near: f64) -> bool {
        let from = obb.to_local(&self.from);
        let along = obb.axes.tr_mul(&self.along);
        let near = near + ROUNDING * (from.lp_norm(1) + obb.half_extents.sum());
        let (mut first, mut last) = (0.0_f64, self.length);
        for k in 0..3 {
            let half = obb.half_extents[k] + near;
            if along[k] == 0.0 && from[k].abs() > half {
                return false;
            }
            if along[k] != 0.0 {
                let [one, other] = [-half, half].map(|face| (face - from[k]) / along[k]);
                first = first.max(one.min(other));
                last = last.min(one.max(other));
            }
        }
        first <= last
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;
    use cloudtouch_geom::seed::{derive, unit};

    use super::*;

    /// By looking at many places of the box.
    #[test]
    fn a_way_near_a_place_of_a_box_may_pass_the_box() {
        let mut passes = [0; 2];
        for draw in 0..2000 {
            let drawn = |k| 2.0 * unit(derive(draw, k, 2)) - 1.0;
            let vector = |k| Vector3::new(drawn(k), drawn(k + 1), drawn(k + 2));
            let pose =
                Pose::from_translation_rpy(vector(0), [3.0 * drawn(3), drawn(4), 3.0 * drawn(5)]);
            let half_extents = vector(6).abs();
            let axes = *pose.rotation().to_rotation_matrix().matrix();
            let obb = Obb { centre: pose.transform_point(&Point3::origin()), axes, half_extents };
            let length = if draw % 2 == 0 { f64::INFINITY } else { 3.0 * drawn(9).abs() };
            let axis = Vector3::ith(draw as usize % 3, 1.0);
            let from = Point3::from(2.0 * vector(13));
            let toward = obb.centre - from + vector(10);
            let direction = if draw % 5 == 0 { axes * axis } else { toward };
            let way = Way::toward(&from, &direction, length).expect("a direction");
            let near = 0.1 * drawn(16).abs();
            let of_box = |k: u64| {
                let at = |axis: u64| 2.0 * unit(derive(draw, 20 + k, axis)) - 1.0;
                let corner = half_extents.component_mul(&Vector3::new(at(0), at(1), at(2)));
                pose.transform_point(&Point3::from(corner))
            };
            let is_near = (0..60).any(|k| way.distance_to(&of_box(k)) <= near);
            assert!(!is_near || way.may_pass(&obb, near), "{draw}");
            passes[0] += usize::from(is_near);
            passes[1] += usize::from(!way.may_pass(&obb, near));
        }
        assert!(passes.iter().all(|&count| count > 100), "{passes:?}");
    }

    #[test]
    fn a_plane_is_met_between_the_ends_only() {
        let way =
            |length| Way::toward(&Point3::origin(), &Vector3::z(), length).expect("a direction");
        let at = Point3::new(3.0, 0.0, 2.0);
        assert_eq!(way(2.5).meets_plane(&at, &Vector3::z()), Some(Point3::new(0.0, 0.0, 2.0)));
        assert_eq!(way(1.5).meets_plane(&at, &Vector3::z()), None);
        assert_eq!(way(2.5).meets_plane(&Point3::new(0.0, 0.0, -1.0), &Vector3::z()), None);
        assert_eq!(way(2.5).meets_plane(&at, &Vector3::x()), None);
        assert_eq!(way(2.5).meets_plane(&Point3::origin(), &Vector3::x()), None);
    }
}

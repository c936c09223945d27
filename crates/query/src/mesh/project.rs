//! The nearest place on a mesh, and how far it is.

use cloudtouch_geom::Point3;
use parry3d_f64::math;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::Segment;

use super::prepare::{Mesh, vector};
use super::side::Side;

/// Where a point projects to on the surface of a mesh, in the mesh's local frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Projection {
    /// The nearest point of the surface.
    pub point: Point3,
    /// The triangle it lies on; `None` for a point that is not finite.
    pub triangle: Option<usize>,
    /// Distance to it, m; negative inside.
    pub signed_distance: f64,
}

impl Mesh {
    /// Distance from a point in the mesh's file frame to the surface, m; negative inside a mesh
    /// without a border, never negative for an open one. NaN for a point that is not finite.
    ///
    /// Where closed parts overlap is inside, a cavity and both sides of a sheet with its own back
    /// face are outside: see decision 4.
    pub fn signed_distance(&self, point: &Point3) -> f64 {
        self.project(&(point - self.origin())).signed_distance
    }

    /// Whether a point (file frame) is inside or within `padding` metres of the surface.
    pub(crate) fn is_within(&self, point: &Point3, padding: f64) -> bool {
        self.distance_within(point, padding).is_some()
    }

    /// How far a place is from the surface, m, less than zero inside, where it is no farther than that.
    pub(crate) fn distance_within(&self, point: &Point3, most: f64) -> Option<f64> {
        let local = point - self.origin();
        let is_near = self.distance_to_box(&local) <= most;
        let away = is_near.then(|| self.project(&local).signed_distance);
        away.filter(|away| *away <= most)
    }

    /// The nearest surface point to a point in the local frame.
    pub(crate) fn project(&self, point: &Point3) -> Projection {
        if !point.iter().all(|v| v.is_finite()) {
            return Projection { point: *point, triangle: None, signed_distance: f64::NAN };
        }
        let (nearest, triangle) = self.nearest(point);
        let distance = (point - nearest).norm();
        let signed_distance = if self.encloses(point) { -distance } else { distance };
        Projection { point: nearest, triangle: Some(triangle), signed_distance }
    }

    /// The nearest place of the surface to a finite place in the local frame, and its triangle.
    pub(crate) fn nearest(&self, local: &Point3) -> (Point3, usize) {
        let (projection, (triangle, _)) =
            self.surface().project_local_point_and_get_location(vector(local), false);
        let nearest = Point3::new(projection.point.x, projection.point.y, projection.point.z);
        (nearest, triangle as usize)
    }

    /// How far (m) a finite place in the local frame is from the surface.
    pub(crate) fn distance(&self, local: &Point3) -> f64 {
        (local - self.nearest(local).0).norm()
    }

    /// Whether every place within a distance (m) of this one, in the local frame, is outside, as far as that is told
    /// at once; no too where it takes a closer look.
    pub(crate) fn is_surely_clear_of(&self, local: &Point3, distance: f64) -> bool {
        let to_box = self.distance_to_box(local);
        let [low, high] = self.corners_of_box();
        // The way on from the nearest place of the box turns by a right angle at least.
        to_box > distance || to_box.hypot(self.clear_around(&local.sup(&low).inf(&high))) > distance
    }

    /// Whether every place within a distance (m) of a straight way, in the local frame, is outside, as far
    /// as so many halvings of the way tell at once; no too where it takes a closer look.
    pub(crate) fn is_surely_clear_of_way(
        &self,
        [from, to]: [&Point3; 2],
        distance: f64,
        halvings: u32,
    ) -> bool {
        let middle = nalgebra::center(from, to);
        self.is_surely_clear_of(&middle, distance + 0.5 * (to - from).norm())
            || (halvings > 0
                && self.is_surely_clear_of_way([from, &middle], distance, halvings - 1)
                && self.is_surely_clear_of_way([&middle, to], distance, halvings - 1))
    }

    /// Whether every place within a distance (m) of a straight way, in the local frame, is outside.
    pub(crate) fn is_clear_of_way(&self, [from, to]: [&Point3; 2], distance: f64) -> bool {
        /// Distances end within a few times 1e-7 of the size.
        const ROUNDING: f64 = 1e-6;
        let length = (to - from).norm();
        if length == 0.0 || self.encloses(from) {
            return false;
        }
        let (way, here) = (Segment::new(vector(from), vector(to)), math::Pose::IDENTITY);
        let size = length + self.surface().local_aabb().extents().length();
        parry3d_f64::query::distance(&here, &way, &here, self.surface())
            .is_ok_and(|apart| apart.distance > distance + ROUNDING * size)
    }

    /// Whether a place in the local frame is inside. A bucket surrounds more than three quarters of
    /// what it holds, and yet that is not inside it: an open mesh encloses nothing.
    pub(crate) fn encloses(&self, local: &Point3) -> bool {
        self.has_solids() && self.side(local) == Side::Inside
    }
}

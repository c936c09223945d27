//! Whether a surface is all around a place, whichever way its triangles are turned.

use cloudtouch_geom::{Point3, Vector3};
use parry3d_f64::math::Vector;
use parry3d_f64::query::{Ray, RayCast};
use parry3d_f64::shape::Triangle;

use super::prepare::Mesh;
use crate::spiral::direction;

/// Directions that are looked in, ...
const DIRECTIONS: usize = 200;
/// ... one this far from the next in their order, so that the first few are all over the sphere.
const STEP: usize = 89;

impl Mesh {
    /// Whether so large a share of the directions from a place in the local frame end on the surface, or where a
    /// triangle of it is missing.
    pub(crate) fn is_all_around(&self, place: &Point3, share: f64) -> bool {
        let vector = |v: Vector3| Vector::new(v.x, v.y, v.z);
        let missing: Vec<Triangle> =
            self.missing.iter().map(|corners| corners.map(|p| vector(p.coords)).into()).collect();
        let most_open = ((1.0 - share) * DIRECTIONS as f64) as usize;
        let is_open = |k: &usize| {
            let ray = Ray::new(
                vector(place.coords),
                vector(direction(k * STEP % DIRECTIONS, DIRECTIONS)),
            );
            !self.surface().intersects_local_ray(&ray, f64::MAX)
                && !missing.iter().any(|filled| filled.intersects_local_ray(&ray, f64::MAX))
        };
        // PERF: where much is open, a few directions tell.
        (0..DIRECTIONS).filter(is_open).nth(most_open).is_none()
    }
}

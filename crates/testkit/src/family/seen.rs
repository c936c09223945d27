//! The part of a surface that sensors at given places see.

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};
use parry3d_f64::query::{Ray, RayCast};

use crate::{
    exact::{ExactMesh, parry_vector},
    scene::{sphere, subdivide_to_max_edge},
    surface::scaled_normal,
};

/// A hit this close to the point looked at is the point itself, m.
const ROUNDING: f64 = 1e-5;

/// The surface cut into triangles with edges up to `max_edge` metres, those whose middle is seen
/// from its outer side at one of the places at least.
///
/// # Panics
/// When nothing is seen.
pub(super) fn seen_from(body: &ExactMesh, places: &[Point3], max_edge: f64) -> TriangleMesh {
    let fine = subdivide_to_max_edge(body.mesh(), max_edge);
    let seen = (0..fine.triangles().len()).filter(|&t| {
        let corners = fine.corners(t);
        let middle =
            Point3::from((corners[0].coords + corners[1].coords + corners[2].coords) / 3.0);
        let normal = scaled_normal(&corners);
        places.iter().any(|p| (p - middle).dot(&normal) > 0.0 && in_sight(body, p, &middle))
    });
    let triangles = seen.map(|t| fine.triangles()[t]).collect();
    TriangleMesh::new(fine.vertices().to_vec(), triangles).expect("some of the surface is seen")
}

/// Whether nothing of the body is between the two points.
pub(super) fn in_sight(body: &ExactMesh, from: &Point3, point: &Point3) -> bool {
    let path = point - from;
    let ray = Ray::new(parry_vector(&from.coords), parry_vector(&path));
    // The ray's parameter is 1 at the point.
    body.shape().cast_local_ray(&ray, 1.0 - ROUNDING / path.norm(), false).is_none()
}

/// Forty-two places evenly around a body, twice its diagonal from the middle of its box.
pub(super) fn all_around(body: &TriangleMesh) -> Vec<Point3> {
    let (low, high) = body.bounding_box().expect("a mesh has vertices");
    let middle: Vector3 = nalgebra::center(&low, &high).coords;
    let sides = sphere(2.0 * (high - low).norm(), 1);
    sides.vertices().iter().map(|p| p + middle).collect()
}

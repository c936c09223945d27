//! Points on the surface of a mesh.

use cloudtouch_geom::{Point3, TriangleMesh, Vector3, seed};
use rand::RngExt;

/// A point of a surface and what is true there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceSample {
    /// Where it is, m, in the mesh's frame.
    pub position: Point3,
    /// The unit normal of its triangle, outward when the mesh is oriented outward.
    pub normal: Vector3,
    /// Which triangle it lies on.
    pub triangle: usize,
}

/// `count` points with equal share per area, stratified: the surface is cut into `count` pieces of
/// equal area in triangle order, one point in each.
///
/// # Panics
/// When the mesh has no area.
pub fn sample_surface(mesh: &TriangleMesh, count: usize, seed: u64) -> Vec<SurfaceSample> {
    let mut rng = seed::generator(seed);
    let mut total = 0.0;
    let area_up_to: Vec<f64> = (0..mesh.triangles().len())
        .map(|t| {
            total += 0.5 * scaled_normal(&mesh.corners(t)).norm();
            total
        })
        .collect();
    assert!(total > 0.0, "a mesh without area cannot be sampled");
    (0..count)
        .map(|i| {
            let area = total * (i as f64 + rng.random::<f64>()) / count as f64;
            // The first triangle that ends beyond it: one without area is never chosen.
            let triangle = area_up_to.partition_point(|&a| a <= area).min(area_up_to.len() - 1);
            let corners = mesh.corners(triangle);
            SurfaceSample {
                position: point_inside(&corners, rng.random(), rng.random()),
                normal: scaled_normal(&corners).normalize(),
                triangle,
            }
        })
        .collect()
}

/// The positions alone.
pub fn positions(samples: &[SurfaceSample]) -> Vec<Point3> {
    samples.iter().map(|s| s.position).collect()
}

/// The area of a mesh, m².
pub fn area(mesh: &TriangleMesh) -> f64 {
    (0..mesh.triangles().len()).map(|t| 0.5 * scaled_normal(&mesh.corners(t)).norm()).sum()
}

/// The volume a closed, outward oriented mesh encloses, m³; negative when oriented inward.
pub fn volume(mesh: &TriangleMesh) -> f64 {
    (0..mesh.triangles().len())
        .map(|t| {
            let [a, b, c] = mesh.corners(t).map(|p| p.coords);
            a.cross(&b).dot(&c) / 6.0
        })
        .sum()
}

/// The normal with twice the triangle's area as length.
pub(crate) fn scaled_normal([a, b, c]: &[Point3; 3]) -> Vector3 {
    (b - a).cross(&(c - a))
}

/// Two uniform numbers to a uniform point of a triangle.
fn point_inside([a, b, c]: &[Point3; 3], u: f64, v: f64) -> Point3 {
    // The root evens out that a triangle is wider near one side.
    let s = u.sqrt();
    a + (b - a) * (s * (1.0 - v)) + (c - a) * (s * v)
}

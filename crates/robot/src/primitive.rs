//! Boxes, cylinders, capsules and spheres as closed meshes that are nowhere smaller than they are.

use std::f64::consts::{FRAC_PI_2, PI};

use cloudtouch::geom::{MeshError, Point3, TriangleMesh};

/// Sides of what is round, all the way about.
const SIDES: usize = 64;
/// Steps of half a circle, from pole to pole; even, so that one is at the equator.
const STEPS: usize = SIDES / 2;

/// How far beyond the true surface that of a round primitive reaches at most, as a share of its radius:
/// 0.25 %. Polygons about circles, not in them, so that a link is never taken for smaller than it is.
pub const EXCESS: f64 = 0.0025;

/// About the origin, with edges along the axes, m.
pub(crate) fn cuboid(size: [f64; 3]) -> Result<TriangleMesh, MeshError> {
    let corner = |i: usize| {
        let along = |axis: usize| if i >> axis & 1 == 1 { 0.5 } else { -0.5 } * size[axis];
        Point3::new(along(0), along(1), along(2))
    };
    // Each face anticlockwise from outside.
    let faces =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh::new((0..8).map(corner).collect(), triangles)
}

/// Along z about the origin, m.
pub(crate) fn cylinder(radius: f64, length: f64) -> Result<TriangleMesh, MeshError> {
    let half = 0.5 * length;
    revolved(&[[0.0, -half], [radius, -half], [radius, half], [0.0, half]])
}

/// About the origin, m.
pub(crate) fn sphere(radius: f64) -> Result<TriangleMesh, MeshError> {
    capsule(radius, 0.0)
}

/// A cylinder of this length along z about the origin with half a sphere at each end, m.
pub(crate) fn capsule(radius: f64, length: f64) -> Result<TriangleMesh, MeshError> {
    // The corners of a polygon about the circle.
    let corner = radius / (0.5 * PI / STEPS as f64).cos();
    let arc = |steps: std::ops::RangeInclusive<usize>, height: f64| {
        steps.map(move |k| {
            let angle = PI * k as f64 / STEPS as f64 - FRAC_PI_2;
            let is_pole = k == 0 || k == STEPS;
            [if is_pole { 0.0 } else { corner * angle.cos() }, height + corner * angle.sin()]
        })
    };
    let mut profile: Vec<[f64; 2]> = arc(0..=STEPS / 2, -0.5 * length).collect();
    let above = if length > 0.0 { STEPS / 2 } else { STEPS / 2 + 1 };
    profile.extend(arc(above..=STEPS, 0.5 * length));
    revolved(&profile)
}

/// A profile of distances from the z axis and heights, from a pole below to one above, turned about
/// that axis: polygons about the circles.
fn revolved(profile: &[[f64; 2]]) -> Result<TriangleMesh, MeshError> {
    let outward = 1.0 / (PI / SIDES as f64).cos();
    let [low, rings @ .., high] = profile else { return Err(MeshError::Empty) };
    let mut vertices = vec![Point3::new(0.0, 0.0, low[1]), Point3::new(0.0, 0.0, high[1])];
    for [distance, height] in rings {
        for k in 0..SIDES {
            let (sin, cos) = (2.0 * PI * k as f64 / SIDES as f64).sin_cos();
            let reach = outward * distance;
            vertices.push(Point3::new(reach * cos, reach * sin, *height));
        }
    }
    let at = |ring: usize, k: usize| (2 + ring * SIDES + k % SIDES) as u32;
    let last = rings.len() - 1;
    let mut triangles = Vec::new();
    for k in 0..SIDES {
        triangles.push([0, at(0, k + 1), at(0, k)]);
        triangles.push([1, at(last, k), at(last, k + 1)]);
        for ring in 0..last {
            let [a, b, c, d] = [at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    TriangleMesh::new(vertices, triangles)
}

#[cfg(test)]
mod tests {
    use cloudtouch::Mesh;
    use proptest::prelude::*;

    use super::*;

    /// Signed distance to a capsule, or with no length a sphere.
    fn to_capsule(p: &Point3, radius: f64, length: f64) -> f64 {
        let z = p.z - p.z.clamp(-0.5 * length, 0.5 * length);
        p.x.hypot(p.y).hypot(z) - radius
    }

    fn to_cylinder(p: &Point3, radius: f64, length: f64) -> f64 {
        (p.x.hypot(p.y) - radius).max(p.z.abs() - 0.5 * length)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn primitives_are_closed_and_hold_what_they_stand_for_and_little_more(
            radius in 0.01..0.5_f64, length in 0.01..1.0_f64,
            places in prop::collection::vec(prop::array::uniform3(-1.1..1.1_f64), 60),
        ) {
            let all = [
                (cylinder(radius, length), length, to_cylinder as fn(&Point3, f64, f64) -> f64),
                (capsule(radius, length), length, to_capsule),
                (sphere(radius), 0.0, to_capsule),
            ];
            for (mesh, length, distance) in all {
                let mesh = mesh.unwrap();
                prop_assert_eq!(mesh.open_edges(), 0);
                let prepared = Mesh::prepare(&mesh).unwrap();
                prop_assert!(prepared.is_watertight());
                for vertex in mesh.vertices() {
                    let beyond = distance(vertex, radius, length);
                    prop_assert!((-1e-12..=EXCESS * radius).contains(&beyond), "{}", beyond);
                }
                for place in &places {
                    let reach = [radius, radius, radius + 0.5 * length];
                    let p = Point3::from([0, 1, 2].map(|k| place[k] * reach[k]));
                    if distance(&p, radius, length) < -1e-9 {
                        prop_assert!(prepared.signed_distance(&p) < 0.0, "{} is outside", p);
                    }
                }
            }
        }

        #[test]
        fn a_box_is_exact(size in prop::array::uniform3(0.01..1.0_f64)) {
            let mesh = cuboid(size).unwrap();
            let (low, high) = mesh.bounding_box().unwrap();
            prop_assert!((high - low - cloudtouch::geom::Vector3::from(size)).norm() < 1e-15);
            let prepared = Mesh::prepare(&mesh).unwrap();
            prop_assert!(prepared.is_watertight());
            prop_assert!(prepared.signed_distance(&Point3::origin()) < 0.0);
            // Not turned inside out before preparation either.
            let volume: f64 = (0..12).map(|t| mesh.corners(t).map(|p| p.coords))
                .map(|[a, b, c]| a.dot(&b.cross(&c)) / 6.0).sum();
            prop_assert!((volume - size.iter().product::<f64>()).abs() < 1e-12);
        }
    }
}

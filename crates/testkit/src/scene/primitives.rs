//! Simple shapes, each centred on the origin unless it says otherwise.

use std::collections::BTreeMap;

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};

use super::assemble::{assemble, block, mesh, prism};

/// An open square of side `size` in the plane z = 0, facing +z: two triangles.
pub fn plane_patch(size: f64) -> TriangleMesh {
    rectangle(size, size)
}

/// An open rectangle in the plane z = 0, facing +z, with these sides along x and y.
pub fn rectangle(width: f64, length: f64) -> TriangleMesh {
    sheet(Vector3::x() * width, Vector3::y() * length)
}

/// Two open squares of side `size` that cross at right angles along the x axis.
pub fn crossing_sheets(size: f64) -> TriangleMesh {
    assemble([
        sheet(Vector3::x() * size, Vector3::y() * size),
        sheet(Vector3::x() * size, Vector3::z() * size),
    ])
}

/// The open parallelogram with these sides.
fn sheet(first: Vector3, second: Vector3) -> TriangleMesh {
    let corner = |s: f64, t: f64| Point3::from(first * s + second * t);
    let corners = vec![corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
    mesh(corners, vec![[0, 1, 2], [0, 2, 3]])
}

/// A closed box with these sides.
pub fn cuboid(size: [f64; 3]) -> TriangleMesh {
    block(size.map(|s| -0.5 * s), size.map(|s| 0.5 * s))
}

/// A closed square plate of side `size`, 2 cm thick: two faces that must not be averaged.
pub fn thin_slab(size: f64) -> TriangleMesh {
    cuboid([size, size, 0.02])
}

/// A closed triangular prism, its sharp edge along y through the origin and its body above:
/// at height `height` it is `width` wide, and it is `length` long.
pub fn wedge(width: f64, height: f64, length: f64) -> TriangleMesh {
    let (w, l) = (0.5 * width, 0.5 * length);
    let end =
        |y: f64| [Point3::new(0.0, y, 0.0), Point3::new(w, y, height), Point3::new(-w, y, height)];
    let corners = [end(-l), end(l)].concat();
    mesh(
        corners,
        vec![
            [0, 1, 2],
            [3, 5, 4],
            [0, 3, 4],
            [0, 4, 1],
            [1, 4, 5],
            [1, 5, 2],
            [2, 5, 3],
            [2, 3, 0],
        ],
    )
}

/// A closed ball: an icosahedron of circumradius `radius` with its triangles quartered
/// `subdivisions` times (20·4ⁿ triangles), every vertex on the sphere.
pub fn sphere(radius: f64, subdivisions: u32) -> TriangleMesh {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut vertices: Vec<Vector3> = Vec::new();
    for (s, t) in [(-1.0, -golden), (1.0, -golden), (-1.0, golden), (1.0, golden)] {
        vertices.push(Vector3::new(s, t, 0.0).normalize());
        vertices.push(Vector3::new(0.0, s, t).normalize());
        vertices.push(Vector3::new(t, 0.0, s).normalize());
    }
    let mut triangles = hull_of_icosahedron(&vertices);
    for _ in 0..subdivisions {
        let mut middles = BTreeMap::new();
        let mut middle = |i: u32, j: u32| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                vertices.push((vertices[i as usize] + vertices[j as usize]).normalize());
                (vertices.len() - 1) as u32
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    mesh(vertices.iter().map(|v| Point3::from(v * radius)).collect(), triangles)
}

/// The twenty outward triangles between mutually nearest vertices.
fn hull_of_icosahedron(vertices: &[Vector3]) -> Vec<[u32; 3]> {
    // Neighbours are 63° apart, the next nearest pairs 117°.
    let near = |i: usize, j: usize| vertices[i].dot(&vertices[j]) > 0.0;
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(k, i) {
                    let outward = vertices[i].cross(&vertices[j]).dot(&vertices[k]) > 0.0;
                    let [j, k] = if outward { [j, k] } else { [k, j] };
                    triangles.push([i as u32, j as u32, k as u32]);
                }
            }
        }
    }
    triangles
}

/// A closed torus about the z axis: tube radius `minor` around a circle of radius `major`, with
/// `segments` steps around the axis and half as many around the tube.
pub fn torus(major: f64, minor: f64, segments: usize) -> TriangleMesh {
    let tube = unit_circle(segments / 2);
    ring(unit_circle(segments).iter().map(|&[x, y]| {
        tube.iter()
            .map(|&[u, v]| {
                let r = major + minor * u;
                Point3::new(r * x, r * y, minor * v)
            })
            .collect()
    }))
}

/// A closed square plate of side `size` in the plane z = 0 with a round hole along z.
///
/// The hole is a polygon of 32 sides with its corners at `hole_radius`.
pub fn plate_with_hole(size: f64, thickness: f64, hole_radius: f64) -> TriangleMesh {
    let (half, t) = (0.5 * size, 0.5 * thickness);
    ring(unit_circle(32).iter().map(|&[x, y]| {
        // The point of the square's rim in the same direction.
        let rim = half / x.abs().max(y.abs());
        let at = |r: f64, z: f64| Point3::new(r * x, r * y, z);
        vec![at(rim, -t), at(rim, t), at(hole_radius, t), at(hole_radius, -t)]
    }))
}

/// A closed cylinder of 32 sides along z, its corners at `radius`.
pub fn peg(radius: f64, length: f64) -> TriangleMesh {
    cylinder(radius, length, 32)
}

/// A closed cylinder along z of so many `sides`, its corners at `radius`.
pub fn cylinder(radius: f64, length: f64, sides: usize) -> TriangleMesh {
    let outline: Vec<_> =
        unit_circle(sides).iter().map(|&[x, y]| [radius * x, radius * y]).collect();
    prism(&outline, -0.5 * length, 0.5 * length)
}

/// The closed surface through a ring of closed sections, each anticlockwise in the half plane of
/// (distance from the z axis, z), taken anticlockwise about z.
pub(super) fn ring(sections: impl Iterator<Item = Vec<Point3>>) -> TriangleMesh {
    let sections: Vec<_> = sections.collect();
    let (n, m) = (sections.len(), sections[0].len());
    let index = |i: usize, j: usize| ((i % n) * m + j % m) as u32;
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let [a, b] = [index(i, j), index(i + 1, j)];
            let [c, d] = [index(i + 1, j + 1), index(i, j + 1)];
            triangles.push([a, b, c]);
            triangles.push([a, c, d]);
        }
    }
    mesh(sections.concat(), triangles)
}

/// The corners of a regular polygon on the unit circle, anticlockwise from (1, 0).
///
/// Rounded to 12 decimals: the sine differs in its last bits between platforms.
pub(super) fn unit_circle(corners: usize) -> Vec<[f64; 2]> {
    let round = |v: f64| (v * 1e12).round() / 1e12;
    (0..corners)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * i as f64 / corners as f64).sin_cos();
            [round(cos), round(sin)]
        })
        .collect()
}

//! Meshes as careless exporters write them.

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};

use super::case::patch;
use crate::{
    scene,
    surface::{positions, sample_surface},
};

/// A cloud and a mesh in one frame.
#[derive(Debug, Clone, PartialEq)]
pub struct HardMesh {
    /// A short name, unique in the catalogue.
    pub name: &'static str,
    /// Why it is hard.
    pub reason: &'static str,
    /// The mesh, m.
    pub mesh: TriangleMesh,
    /// Points of the other body, m.
    pub cloud: Vec<Point3>,
    /// Standard deviation of the points along each axis, m.
    pub std: f64,
    /// Whether the mesh has any surface. Where not, a typed error is the right answer.
    pub valid: bool,
    /// Whether the two surfaces have a point in common, or one is inside the other.
    pub collides: bool,
}

/// Standard deviation of the clouds beside the meshes, m.
const STD: f64 = 0.002;

/// Degenerate triangles, holes, needles, a mesh turned inside out.
pub fn hard_meshes() -> Vec<HardMesh> {
    let case = |name, reason, mesh, cloud, collides| HardMesh {
        name,
        reason,
        mesh,
        cloud,
        std: STD,
        valid: true,
        collides,
    };
    let degenerate = "no area: no normal, no barycentric coordinates";
    let holes = "open, so without an inside";
    let needles = "triangles a million times as long as wide";
    let ball = scene::sphere(0.1, 3);
    let holed = punctured(&ball, 7);
    let within = |radius: f64| positions(&sample_surface(&scene::sphere(radius, 3), 200, 5));
    let through: Vec<Point3> =
        patch(0.0, 300, 3).iter().map(|p| Point3::new(p.x, p.z, p.y)).collect();
    vec![
        case("degenerate-triangles", degenerate, with_degenerate(), patch(0.05, 100, 2), false),
        case("degenerate-triangles-crossing", degenerate, with_degenerate(), through.clone(), true),
        HardMesh {
            valid: false,
            ..case("all-degenerate", degenerate, only_degenerate(), patch(0.05, 100, 2), false)
        },
        case("holes", holes, holed.clone(), patch(0.15, 100, 2), false),
        case("holes-crossing", holes, holed, patch(0.05, 400, 2), true),
        case("needles", needles, needle_fan(), patch(0.05, 100, 2), false),
        case("needles-crossing", needles, needle_fan(), through.clone(), true),
        case(
            "large-triangle-pierced",
            "corners far away, hit in the middle",
            scene::plane_patch(100.0),
            through,
            true,
        ),
        case("inside-out", "normals point inwards", turned(&ball), within(0.05), true),
        case("wholly-inside", "surfaces far apart, volumes not", ball, within(0.05), true),
    ]
}

fn mesh(vertices: Vec<Point3>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    TriangleMesh::new(vertices, triangles).expect("finite vertices and indices in range")
}

/// A square patch of 0.2 m with triangles of no area among its own.
fn with_degenerate() -> TriangleMesh {
    let patch = scene::plane_patch(0.2);
    let [p, q, r] = patch.corners(0);
    let (mut vertices, mut triangles) = (patch.vertices().to_vec(), patch.triangles().to_vec());
    let next = vertices.len() as u32;
    // A point, a segment, three points in a line, and an area that underflows.
    vertices.extend([nalgebra::center(&p, &q), p + (r - p) * 1e-200]);
    triangles.extend([[0, 0, 0], [0, 1, 1], [0, 1, next], [0, 1, next + 1]]);
    mesh(vertices, triangles)
}

fn only_degenerate() -> TriangleMesh {
    let line = (0..4).map(|i| Point3::new(0.1 * f64::from(i), 0.0, 0.0)).collect();
    mesh(line, vec![[0, 1, 1], [2, 2, 2], [3, 3, 0]])
}

/// The mesh without every n-th triangle.
fn punctured(whole: &TriangleMesh, n: usize) -> TriangleMesh {
    let kept = whole.triangles().iter().enumerate().filter(|(i, _)| i % n != 0);
    mesh(whole.vertices().to_vec(), kept.map(|(_, t)| *t).collect())
}

fn turned(whole: &TriangleMesh) -> TriangleMesh {
    let turned = whole.triangles().iter().map(|&[a, b, c]| [a, c, b]);
    mesh(whole.vertices().to_vec(), turned.collect())
}

/// A square of 0.2 m at z = 0 in 40 strips; along each a needle 0.2 µm wide.
fn needle_fan() -> TriangleMesh {
    const STRIPS: u32 = 40;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for i in 0..=STRIPS {
        let x = -0.1 + 0.2 * f64::from(i) / f64::from(STRIPS);
        let end = Vector3::new(2e-7, 0.0, 0.0);
        let [low, high] = [Point3::new(x, -0.1, 0.0), Point3::new(x, 0.1, 0.0)];
        vertices.extend([low, high, low + end, high + end]);
        let first = 4 * i;
        triangles.extend([[first, first + 2, first + 1], [first + 2, first + 3, first + 1]]);
        if i < STRIPS {
            triangles
                .extend([[first + 2, first + 4, first + 3], [first + 4, first + 5, first + 3]]);
        }
    }
    mesh(vertices, triangles)
}

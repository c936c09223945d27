//! The boxes of a collision map against every pair: separating axes decide who touches, triangle
//! distances say how far apart.

use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3};
use cloudtouch_testkit::{exact::brute::distance, scene::cuboid};
use proptest::prelude::*;

use super::test_clouds::{cloud, pose};
use super::{Answer, BoxMap, ObjectMesh, Observed};

/// Large boxes, so that small clouds touch often.
const SIDE: f64 = 0.05;

/// A convex body: its corners, and the directions of its face normals and of its edges.
struct Convex {
    corners: Vec<Point3>,
    normals: Vec<Vector3>,
    edges: Vec<Vector3>,
}

/// Whether two convex bodies have a point in common, by all separating axes.
fn touch(s: &Convex, t: &Convex) -> bool {
    let crossed = s.edges.iter().flat_map(|e| t.edges.iter().map(move |f| e.cross(f)));
    let mut axes = s.normals.iter().chain(&t.normals).copied().chain(crossed);
    !axes.any(|axis| {
        let range = |body: &Convex| {
            let along = body.corners.iter().map(|p| axis.dot(&p.coords));
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
        };
        let ((low_s, high_s), (low_t, high_t)) = (range(s), range(t));
        high_s < low_t || high_t < low_s
    })
}

/// The boxes of a cloud, each once, by asking of every cell whether it was met before.
fn box_meshes(points: &[Point3]) -> Vec<TriangleMesh> {
    let mut corners: Vec<Vector3> = Vec::new();
    for p in points {
        let corner = p.coords.map(|v| (v / SIDE).floor());
        if !corners.contains(&corner) {
            corners.push(corner);
        }
    }
    let at = |corner: &Vector3| {
        let middle = corner.map(|v| (v + 0.5) * SIDE);
        let cube = cuboid([SIDE, SIDE, SIDE]);
        let (low, high) = cube.bounding_box().unwrap();
        let from = nalgebra::center(&low, &high);
        let vertices = cube.vertices().iter().map(|v| v + (middle - from.coords)).collect();
        TriangleMesh::try_new(vertices, cube.triangles().to_vec()).unwrap()
    };
    corners.iter().map(at).collect()
}

fn as_convex_box(mesh: &TriangleMesh, pose: &Pose) -> Convex {
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()].map(|v| pose.transform_vector(&v));
    let corners = mesh.vertices().iter().map(|p| pose.transform_point(p)).collect();
    Convex { corners, normals: axes.to_vec(), edges: axes.to_vec() }
}

fn as_convex_triangle(mesh: &TriangleMesh, triangle: usize, pose: &Pose) -> Convex {
    let [a, b, c] = mesh.corners(triangle).map(|p| pose.transform_point(&p));
    let normal = (b - a).cross(&(c - a));
    let edges = vec![b - a, c - b, a - c];
    Convex { corners: vec![a, b, c], normals: vec![normal], edges }
}

/// The answer is that of the pairs: touching or not, and the distance of surfaces when not.
fn assert_agrees(answer: &Answer, touches: bool, distance: f64) {
    assert_eq!(answer.probability, Some(f64::from(u8::from(touches))), "distance {distance}");
    if touches {
        assert_eq!(answer.score, 0.0);
    } else {
        assert!((answer.score + distance).abs() < 1e-9, "{} {distance}", answer.score);
        assert!(answer.score < 0.0);
    }
}

fn mesh_agrees(a: &[Point3], mesh: &TriangleMesh, pose: &Pose) -> bool {
    let boxes = box_meshes(a);
    let triangles: Vec<Convex> =
        (0..mesh.triangles().len()).map(|t| as_convex_triangle(mesh, t, pose)).collect();
    let touches = boxes.iter().any(|cell| {
        let cell = as_convex_box(cell, &Pose::identity());
        triangles.iter().any(|triangle| touch(&cell, triangle))
    });
    let apart = boxes.iter().map(|cell| distance(cell, mesh, pose)).fold(f64::INFINITY, f64::min);
    let object = ObjectMesh::try_new(mesh).unwrap();
    let observed = Observed::try_new(a, a, pose, 0.0).unwrap();
    let answer = BoxMap::try_new(SIDE).unwrap().against_mesh(&observed, &object);
    assert_agrees(&answer, touches, apart);
    touches
}

fn boxes_agree(a: &[Point3], b: &[Point3], pose: &Pose) -> bool {
    let (boxes_a, boxes_b) = (box_meshes(a), box_meshes(b));
    let mut touches = false;
    let mut apart = f64::INFINITY;
    for cell in &boxes_a {
        for other in &boxes_b {
            let bodies = (as_convex_box(cell, &Pose::identity()), as_convex_box(other, pose));
            touches |= touch(&bodies.0, &bodies.1);
            apart = apart.min(distance(cell, other, pose));
        }
    }
    let map = BoxMap::try_new(SIDE).unwrap();
    let there = map.against_boxes(&Observed::try_new(a, b, pose, 0.0).unwrap());
    assert_agrees(&there, touches, apart);
    let back_pose = pose.inverse();
    let back = map.against_boxes(&Observed::try_new(b, a, &back_pose, 0.0).unwrap());
    assert_agrees(&back, touches, apart);
    touches
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn boxes_meet_a_mesh_as_separating_axes_say(
        a in cloud(1..20), corners in cloud(3..16), pose in pose(),
    ) {
        let triangles: Vec<[u32; 3]> =
            (2..corners.len() as u32).map(|i| [i - 2, i - 1, i]).collect();
        let mesh = TriangleMesh::try_new(corners, triangles).unwrap();
        mesh_agrees(&a, &mesh, &pose);
    }

    #[test]
    fn boxes_meet_boxes_as_separating_axes_say(
        a in cloud(1..12), b in cloud(1..12), pose in pose(),
    ) {
        boxes_agree(&a, &b, &pose);
    }
}

#[test]
fn an_edge_just_off_a_box_is_off() {
    // Flat faces that are parallel, and a sheet that passes a corner.
    let point = [Point3::new(0.01, 0.01, 0.01)];
    let sheet = |z: f64| {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| Point3::new(x, y, z));
        TriangleMesh::try_new(corners.to_vec(), vec![[0, 1, 2]]).unwrap()
    };
    for (z, touches) in [(SIDE + 1e-6, false), (SIDE - 1e-6, true), (-1e-6, false), (0.02, true)] {
        assert_eq!(mesh_agrees(&point, &sheet(z), &Pose::identity()), touches, "{z}");
    }
    let turned = Pose::from_translation_rpy(Vector3::new(0.0, 0.0, 0.0), [0.7, 0.4, 0.2]);
    for i in 0..200 {
        mesh_agrees(&point, &sheet(-0.1 + 0.001 * f64::from(i)), &turned);
    }
}

#[test]
fn equal_clouds_touch_and_the_inside_of_a_mesh_does_not() {
    let points = [Point3::new(0.01, 0.02, 0.03); 40];
    assert!(boxes_agree(&points, &points, &Pose::identity()));
    let large = cuboid([1.0, 1.0, 1.0]);
    let middle = large.bounding_box().map(|(low, high)| nalgebra::center(&low, &high)).unwrap();
    let around = Pose::from_translation(points[0] - middle);
    assert!(!mesh_agrees(&points, &large, &around));
    assert!(BoxMap::try_new(0.0).is_err() && BoxMap::try_new(f64::NAN).is_err());
}

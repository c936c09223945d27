//! Which side of a mesh a place is on, where the nearest triangle would say it wrong: sheets with a
//! back, shells that overlap, cavities, parts turned inside out.

use crate::common;
use crate::common::{ask, at, measured, mesh, prepare};
use cloudtouch::geom::{Point3, Pose, TriangleMesh};
use cloudtouch::{Mode, Verdict};
use cloudtouch_testkit::scene;

/// A square of one metre in the plane z = 0 with its own back face, cut along the other diagonal:
/// every edge joins two triangles.
fn two_sided_sheet() -> TriangleMesh {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let vertices = corners.iter().map(|&(x, y)| Point3::new(x, y, 0.0)).collect();
    let faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    TriangleMesh::new(vertices, faces).expect("four triangles")
}

/// The box from `low` to `high`.
fn solid(low: [f64; 3], high: [f64; 3]) -> TriangleMesh {
    let size = [0, 1, 2].map(|i| high[i] - low[i]);
    let [x, y, z] = [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]));
    scene::moved(&scene::cuboid(size), &at(x, y, z))
}

fn inside_out(mesh: &TriangleMesh) -> TriangleMesh {
    let turned = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    TriangleMesh::new(mesh.vertices().to_vec(), turned).expect("the same vertices")
}

/// Two boxes that overlap between x = 0.5 and 1.
fn overlapping_boxes() -> TriangleMesh {
    scene::assemble([solid([0.0; 3], [1.0; 3]), solid([0.5, 0.2, 0.2], [1.5, 0.8, 0.8])])
}

/// One triangle of a closed box was turned round: its inside was none, and a cloud there read free.
#[test]
fn a_cloud_within_a_box_with_a_turned_triangle_read_free() {
    let good = solid([0.0; 3], [1.0; 3]);
    let turn = |(k, &[a, b, c]): (usize, &[u32; 3])| if k == 4 { [a, c, b] } else { [a, b, c] };
    let turned = good.triangles().iter().enumerate().map(turn).collect();
    let solid = mesh(&TriangleMesh::new(good.vertices().to_vec(), turned).expect("a mesh"));
    assert!(solid.is_watertight());
    let ball = measured(&scene::sphere(0.1, 3), 0.01, 0.001, 4);
    for mode in [Mode::Calibrated, Mode::Paper] {
        let ball = prepare(ball.clone(), 0.001, mode);
        let report = ask(mode, &ball, &solid, &at(-0.5, -0.5, -0.5));
        assert_eq!(report.verdict, Verdict::InCollision, "{mode:?}: {report:?}");
    }
}

/// One triangle more than once, or every one from behind too, and a solid had no inside.
#[test]
fn a_cloud_within_a_box_with_repeated_triangles_read_free() {
    let good = solid([0.0; 3], [1.0; 3]);
    let back = |&[a, b, c]: &[u32; 3]| [a, c, b];
    let one: Vec<[u32; 3]> = vec![good.triangles()[4]];
    let all = good.triangles().to_vec();
    let backs: Vec<[u32; 3]> = good.triangles().iter().map(back).collect();
    let ball = measured(&scene::sphere(0.1, 3), 0.01, 0.001, 4);
    for repeated in [one, all, backs] {
        let triangles = [good.triangles(), &repeated].concat();
        let mesh = TriangleMesh::new(good.vertices().to_vec(), triangles).expect("a mesh");
        let solid = common::mesh(&mesh);
        assert!(solid.is_watertight());
        for mode in [Mode::Calibrated, Mode::Paper] {
            let ball = prepare(ball.clone(), 0.001, mode);
            let report = ask(mode, &ball, &solid, &at(-0.5, -0.5, -0.5));
            assert_eq!(report.verdict, Verdict::InCollision, "{mode:?}: {report:?}");
        }
    }
}

#[test]
fn a_cloud_below_a_sheet_with_a_back_face_collided() {
    let sheet = mesh(&two_sided_sheet());
    assert!(!sheet.is_watertight(), "it encloses nothing");
    assert!((sheet.signed_distance(&Point3::new(0.1, 0.2, -1.0)) - 1.0).abs() < 1e-12);
    for mode in common::MODES {
        let ball = prepare(measured(&scene::sphere(0.1, 2), 0.02, 0.002, 1), 0.002, mode);
        for z in [-1.0, 1.0] {
            let report = ask(mode, &sheet, &ball, &at(0.1, 0.2, z));
            assert_eq!(report.verdict, Verdict::Free, "{mode:?} at {z}: {report:?}");
        }
        let through = ask(mode, &sheet, &ball, &at(0.1, 0.2, 0.03));
        assert_eq!(through.verdict, Verdict::InCollision, "{mode:?}: {through:?}");
    }
}

/// Beside a solid, so that the mesh as a whole encloses a volume.
#[test]
fn a_sheet_with_a_back_face_beside_a_solid_is_pierced_too() {
    let parts = [two_sided_sheet(), solid([2.0, -0.5, -0.5], [3.0, 0.5, 0.5])];
    let both = mesh(&scene::assemble(parts));
    assert!(!both.is_watertight());
    let ball = prepare(measured(&scene::sphere(0.1, 2), 0.02, 0.002, 1), 0.002, Mode::Calibrated);
    let verdict = |x, z| ask(Mode::Calibrated, &both, &ball, &at(x, 0.0, z)).verdict;
    assert_eq!(verdict(0.1, -1.0), Verdict::Free);
    assert_eq!(verdict(0.1, 0.03), Verdict::InCollision);
    assert!(both.signed_distance(&Point3::new(2.5, 0.0, 0.0)) < -0.4);
}

/// The nearest triangle is that of the second box's end, seen from its front.
#[test]
fn a_cloud_inside_one_of_two_overlapping_boxes_was_free() {
    let boxes = mesh(&overlapping_boxes());
    for x in [0.1, 0.45, 0.55, 0.95, 1.05, 1.4] {
        let inside = Point3::new(x, 0.5, 0.5);
        assert!(boxes.signed_distance(&inside) < 0.0, "x = {x}");
    }
    for outside in [[-0.1, 0.5, 0.5], [1.05, 0.1, 0.5], [1.6, 0.5, 0.5]] {
        assert!(boxes.signed_distance(&Point3::from(outside)) > 0.0, "{outside:?}");
    }
    let ball = prepare(measured(&scene::sphere(0.02, 2), 0.005, 0.001, 1), 0.001, Mode::Calibrated);
    let report = ask(Mode::Calibrated, &boxes, &ball, &at(0.45, 0.5, 0.5));
    assert_eq!(report.verdict, Verdict::InCollision, "{report:?}");
}

#[test]
fn a_mesh_inside_one_of_two_overlapping_boxes_was_free() {
    let (boxes, small) = (mesh(&overlapping_boxes()), mesh(&scene::sphere(0.02, 2)));
    let verdict = |pose: &Pose| ask(Mode::Calibrated, &boxes, &small, pose).verdict;
    assert_eq!(verdict(&at(0.45, 0.5, 0.5)), Verdict::InCollision);
    assert_eq!(verdict(&at(1.2, 0.5, 0.1)), Verdict::Free);
}

#[test]
fn a_cavity_is_outside() {
    let hollow =
        scene::assemble([solid([-0.5; 3], [0.5; 3]), inside_out(&solid([-0.3; 3], [0.3; 3]))]);
    let hollow = mesh(&hollow);
    assert!(hollow.is_watertight());
    assert!((hollow.signed_distance(&Point3::new(0.0, 0.0, 0.1)) - 0.2).abs() < 1e-12);
    assert!((hollow.signed_distance(&Point3::new(0.0, 0.0, 0.42)) + 0.08).abs() < 1e-12);
}

/// The mesh as a whole encloses a positive volume, so that it was not turned.
#[test]
fn a_part_turned_inside_out_beside_a_larger_one_had_its_sides_exchanged() {
    let parts = [solid([-0.5; 3], [0.5; 3]), inside_out(&solid([2.0; 3], [2.5; 3]))];
    let both = mesh(&scene::assemble(parts));
    assert!(both.is_watertight());
    for (place, depth) in [([0.0; 3], 0.5), ([2.25; 3], 0.25), ([2.25, 2.25, 2.6], -0.1)] {
        let found = both.signed_distance(&Point3::from(place));
        assert!((found + depth).abs() < 1e-12, "{found} at {place:?}");
    }
}

/// Four triangles meet at the edge that two boxes share: no list of edges is watertight, but every
/// place is on one side.
#[test]
fn boxes_that_touch_along_an_edge_had_no_inside() {
    let boxes = [solid([0.0; 3], [1.0; 3]), solid([1.0, 1.0, 0.0], [2.0, 2.0, 1.0])];
    let boxes = mesh(&scene::assemble(boxes));
    assert!(!boxes.is_watertight());
    for place in [[0.5; 3], [1.5, 1.5, 0.5]] {
        assert!((boxes.signed_distance(&Point3::from(place)) + 0.5).abs() < 1e-12, "{place:?}");
    }
    assert!(boxes.signed_distance(&Point3::new(0.5, 1.5, 0.5)) > 0.4);
}

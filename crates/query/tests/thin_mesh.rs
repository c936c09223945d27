//! Large triangles: a small cloud that pierces one in its interior is found (a mesh is more than
//! its vertices and centroids), and one that stays clear of it is not.

use crate::common::{MODES, ask, at, measured, mesh, prepare};
use cloudtouch::geom::{Point3, Pose, TriangleMesh, Vector3};
use cloudtouch::{Mode, Verdict};
use cloudtouch_testkit::scene;

/// One triangle with sides of some ten metres in the plane z = 0.
fn large_triangle() -> TriangleMesh {
    let corners =
        vec![Point3::new(-5.0, -4.0, 0.0), Point3::new(6.0, -4.0, 0.0), Point3::new(0.0, 7.0, 0.0)];
    TriangleMesh::new(corners, vec![[0, 1, 2]]).expect("a triangle")
}

/// Places in the triangle: not a vertex, not the centroid, not the middle of an edge.
const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [1.234, -2.1], [-1.7, 0.9], [3.3, -3.2]];

#[test]
fn a_small_cloud_through_the_interior_is_found() {
    let sheet = mesh(&large_triangle());
    assert!(!sheet.is_watertight());
    let ball = measured(&scene::sphere(0.04, 2), 0.008, 0.001, 1);
    for mode in MODES {
        let cloud = prepare(ball.clone(), 0.001, mode);
        for [x, y] in PLACES {
            let through = ask(mode, &sheet, &cloud, &at(x, y, 0.01));
            assert_eq!(through.verdict, Verdict::InCollision, "{mode:?} at {x}, {y}: {through:?}");
        }
    }
}

/// The sheet cuts the ball in a disc of radius √(4² − 1²) = 3.9 cm in its plane. A contact is on that
/// disc, but for two spacings and three deviations.
#[test]
fn the_contact_is_where_the_sheet_is_pierced() {
    let sheet = mesh(&large_triangle());
    let ball = measured(&scene::sphere(0.04, 2), 0.008, 0.001, 1);
    for mode in MODES {
        let cloud = prepare(ball.clone(), 0.001, mode);
        for [x, y] in PLACES {
            let report = ask(mode, &sheet, &cloud, &at(x, y, 0.01));
            let contact = report.contacts.first().expect("a collision has a contact");
            let offset = contact.point - Point3::new(x, y, 0.0);
            let beyond = (offset.xy().norm() - 0.039).max(0.0);
            let off = beyond.hypot(offset.z);
            assert!(off < 0.016 + 0.003, "{mode:?} at {x}, {y}: {contact:?} is {off} m off");
        }
    }
}

#[test]
fn a_small_cloud_above_the_interior_is_free() {
    let sheet = mesh(&large_triangle());
    let ball = measured(&scene::sphere(0.04, 2), 0.008, 0.001, 1);
    for mode in MODES {
        let cloud = prepare(ball.clone(), 0.001, mode);
        for [x, y] in PLACES {
            // 3 cm between ball and sheet: nearly four spacings.
            let above = ask(mode, &sheet, &cloud, &at(x, y, 0.07));
            assert_eq!(above.verdict, Verdict::Free, "{mode:?} at {x}, {y}: {above:?}");
        }
        // In the plane, but beyond the edge of the triangle.
        let beside = ask(mode, &sheet, &cloud, &at(0.0, -4.1, 0.0));
        assert_eq!(beside.verdict, Verdict::Free, "{mode:?}: {beside:?}");
    }
}

#[test]
fn the_sheet_may_be_either_body_and_the_cloud_turned() {
    let sheet = mesh(&large_triangle());
    let cloud =
        prepare(measured(&scene::sphere(0.04, 2), 0.008, 0.001, 1), 0.001, Mode::Calibrated);
    for (z, expected) in [(0.01, Verdict::InCollision), (0.07, Verdict::Free)] {
        let pose = Pose::from_translation_rpy(Vector3::new(1.234, -2.1, z), [0.5, -1.1, 2.0]);
        assert_eq!(ask(Mode::Calibrated, &sheet, &cloud, &pose).verdict, expected);
        assert_eq!(ask(Mode::Calibrated, &cloud, &sheet, &pose.inverse()).verdict, expected);
    }
}

/// A thin closed slab whose faces are two triangles each: pierced through both.
#[test]
fn a_slab_thinner_than_the_spacing_is_found() {
    let slab = mesh(&scene::cuboid([2.0, 2.0, 0.002]));
    for mode in MODES {
        let cloud = prepare(measured(&scene::sphere(0.05, 2), 0.01, 0.001, 1), 0.001, mode);
        // The points of the cloud lie above and below the slab, and hardly any in it.
        let report = ask(mode, &slab, &cloud, &at(0.31, 0.17, 0.005));
        assert_ne!(report.verdict, Verdict::Free, "{mode:?}: {report:?}");
    }
}

//! Clouds in map coordinates (metres east and north, in the millions) keep their millimetres.

use std::f64::consts::FRAC_PI_2;

use crate::common::{AnyQuery, Asked, MODES, Scan, assert_sound, at, measured, mesh, prepare};
use crate::slips::{check, scan, table, tool};
use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::{Contact, Mesh, Mode, Report, Undecided, Verdict, Warning};
use cloudtouch_testkit::scene;

fn offset() -> Vector3 {
    Vector3::new(500_000.0, 5_400_000.0, 300.0)
}

/// Solved tightly: by default the solver may stop a step sooner where coordinates are rounded otherwise, which
/// is worth some 1e-5.
fn ask<'a>(mode: Mode, a: &'a Scan, b: impl Into<Asked<'a>>, a_from_b: &Pose) -> Report {
    let query = AnyQuery::with(mode, |s| s.relative_gap = 1e-8, |s| s.relative_gap = 1e-8);
    let report = query.run(a, b, a_from_b).expect("a finite pose");
    assert_sound(&report);
    report
}

fn far(points: &[Point3]) -> Vec<Point3> {
    points.iter().map(|p| p + offset()).collect()
}

/// Hands over reports of the same pair of clouds near the origin and in one map frame, where the
/// pose is the identity.
fn near_and_away(mode: Mode, check: impl Fn(&Report, &Report)) {
    let std = 0.003;
    let floor = measured(&scene::plane_patch(0.4), 0.015, std, 1);
    for gap in [-0.01, 0.0, 0.005, 0.01, 0.03] {
        let above = Vector3::new(0.02, 0.01, 0.1 + gap);
        let ball = measured(&scene::sphere(0.1, 3), 0.012, std, 2);
        let ball: Vec<Point3> = ball.iter().map(|p| p + above).collect();
        let run = |a: Vec<Point3>, b: Vec<Point3>| {
            ask(mode, &prepare(a, std, mode), &prepare(b, std, mode), &Pose::identity())
        };
        check(&run(floor.clone(), ball.clone()), &run(far(&floor), far(&ball)));
    }
}

#[test]
fn probabilities_do_not_depend_on_the_offset() {
    for mode in MODES {
        near_and_away(mode, |near, away| {
            let (p, q) = (near.collision_probability, away.collision_probability);
            // At 5.4e6 m a coordinate is rounded to 1e-9 m, a 3e-7th of the noise.
            assert!((p - q).abs() < 1e-6, "{mode:?}: {p} and {q}");
            assert_eq!(near.verdict, away.verdict, "{mode:?}");
        });
    }
}

/// By place, since equally probable contacts may change their order.
#[test]
fn contacts_keep_their_millimetres() {
    for mode in MODES {
        near_and_away(mode, |near, away| {
            for contact in &near.contacts {
                let off = |c: &Contact| (c.point - offset() - contact.point).norm();
                let off = away.contacts.iter().map(off).fold(f64::INFINITY, f64::min);
                assert!(off < 1e-3, "{mode:?}: {contact:?} is {off} m off");
            }
        });
    }
}

/// A scene in map coordinates and an object in its own frame, placed by a pose with a large
/// translation.
#[test]
fn a_map_and_an_object_of_its_own() {
    let std = 0.003;
    let floor = measured(&scene::plane_patch(0.4), 0.015, std, 1);
    let ball = mesh(&scene::sphere(0.1, 3));
    for mode in MODES {
        for gap in [-0.01, 0.0, 0.005, 0.01] {
            let above = Vector3::new(0.02, 0.01, 0.1 + gap);
            let turned = |t: Vector3| Pose::from_translation_rpy(t, [0.5, 0.1, 2.0]);
            let near = ask(mode, &prepare(floor.clone(), std, mode), &ball, &turned(above));
            let away =
                ask(mode, &prepare(far(&floor), std, mode), &ball, &turned(above + offset()));
            let (p, q) = (near.collision_probability, away.collision_probability);
            // As above; the rotation is applied about the object, not about the map's origin.
            assert!((p - q).abs() < 1e-6, "{mode:?}, gap {gap}: {p} and {q}");
        }
    }
}

/// In the coordinates of a map half of the points fell on others, and the rest was up to 25 cm off.
#[test]
fn coordinates_of_a_map_in_single_precision_read_free() {
    let map = Vector3::new(512_345.0, 5_403_210.0, 300.0);
    let single = |p: &Point3| p.map(|x| f64::from(x as f32));
    let in_map = |p: &Point3| p + map;
    let moved = |of: &dyn Fn(&Point3) -> Point3| {
        PointCloud::from_points(table().points.iter().map(of).collect())
    };
    let rounded = moved(&|p| single(&in_map(p)));
    let pose = Pose::from_translation(map + Vector3::new(0.1, 0.2, 0.3));
    let told = |w: &Warning| matches!(w, Warning::Rounded { step_m, .. } if *step_m == 0.5);
    check(|mode| scan(&rounded, mode), &mesh(&tool()), &pose, Undecided::Rounded, told);
    let as_measured = scan(&moved(&in_map), Mode::Calibrated);
    let free = ask(Mode::Calibrated, &as_measured, &mesh(&tool()), &pose);
    assert_eq!((free.verdict, free.warnings.len()), (Verdict::Free, 0), "{free:?}");
    // A mesh too, unless so little does not matter for its size.
    let in_file = |mesh: &TriangleMesh| {
        let vertices = mesh.vertices().iter().map(|p| single(&in_map(p))).collect();
        Mesh::prepare(&TriangleMesh::new(vertices, mesh.triangles().to_vec()).unwrap()).unwrap()
    };
    let ball = in_file(&scene::sphere(2.0, 3));
    let report = ask(Mode::Calibrated, &as_measured, &ball, &at(0.0, 0.0, 5.0));
    assert_eq!(report.undecided_by, Some(Undecided::Rounded), "{report:?}");
}

/// A truck 12 cm in a wall read `free`: half a metre is little beside a truck, and much beside a noise of 5 mm.
#[test]
fn coordinates_rounded_more_coarsely_than_the_noise_read_free_beside_large_things() {
    let map = Vector3::new(512_345.0, 5_403_210.0, 300.0);
    let turned = Pose::from_translation_rpy(map + Vector3::y() * 0.22, [FRAC_PI_2, 0.0, 0.0]);
    let wall = measured(&scene::plane_patch(20.0), 0.2, 0.005, 1);
    let in_map: Vec<Point3> = wall.iter().map(|p| turned.transform_point(p)).collect();
    let single: Vec<Point3> = in_map.iter().map(|p| p.map(|x| f64::from(x as f32))).collect();
    let truck = mesh(&scene::cuboid([6.0, 3.0, 3.0]));
    let at_face = |face: f64| Pose::from_translation(map + Vector3::y() * (0.22 + 1.5 + face));
    let ask = |points: &[Point3], std: f64, face: f64| {
        let cloud = prepare(points.to_vec(), std, Mode::Calibrated);
        ask(Mode::Calibrated, &cloud, &truck, &at_face(face))
    };
    assert_eq!(ask(&in_map, 0.005, -0.12).verdict, Verdict::InCollision);
    for face in [-0.12, 0.1, 0.6] {
        let report = ask(&single, 0.005, face);
        assert_eq!(report.undecided_by, Some(Undecided::Rounded), "{face}: {report:?}");
    }
    assert_eq!(ask(&single, 0.005, 4.0).verdict, Verdict::Free);
    // Who says so is believed.
    let said = ask(&single, 0.15, 4.0);
    assert!(!said.warnings.iter().any(|w| matches!(w, Warning::Rounded { .. })), "{said:?}");
}

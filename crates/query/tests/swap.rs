//! Naming the bodies the other way round gives the same answer seen from the other side.

mod common;

use cloudtouch::geom::{Point3, Pose, Vector3};
use cloudtouch::{BodyRef, Mode, Report};
use cloudtouch_testkit::scene;
use common::{ask, mesh, scan};

/// What the library promises of the calibrated mode.
const TOLERANCE: f64 = 1e-3;

/// A ball 10 cm in radius over a floor, turned so that frames differ, at each of these gaps.
fn poses() -> Vec<Pose> {
    [-0.03, -0.005, 0.0, 0.004, 0.008, 0.015, 0.03]
        .map(|gap| {
            Pose::from_translation_rpy(Vector3::new(0.02, 0.01, 0.1 + gap), [0.4, -0.7, 1.9])
        })
        .to_vec()
}

fn check(a: BodyRef<'_>, b: BodyRef<'_>) {
    for a_from_b in poses() {
        let forth = ask(Mode::Calibrated, a, b, &a_from_b);
        let back = ask(Mode::Calibrated, b, a, &a_from_b.inverse());
        let (p, q) = (forth.collision_probability, back.collision_probability);
        assert!((p - q).abs() < TOLERANCE, "{p} and {q} at {:?}", a_from_b.translation());
        assert_eq!(forth.verdict, back.verdict, "at {:?}", a_from_b.translation());
        contacts_agree(&forth, &back, &a_from_b);
    }
}

/// The most probable contact of one is a contact of the other, in its frame and turned round.
fn contacts_agree(forth: &Report, back: &Report, a_from_b: &Pose) {
    assert_eq!(forth.contacts.is_empty(), back.contacts.is_empty());
    let Some(contact) = forth.contacts.first() else { return };
    let mapped = |report: &Report| -> Vec<(Point3, Vector3)> {
        let contacts = report.contacts.iter();
        contacts
            .map(|c| {
                (a_from_b.transform_point(&c.point), -a_from_b.transform_vector(&c.normal_a_to_b))
            })
            .collect()
    };
    // A surface solved to a relative gap of 1e-3 moves by far less than a millimetre; an early
    // stop in clear collision may report another place, so there only normals are compared.
    if forth.collision_probability < 0.99 {
        let nearest = mapped(back)
            .into_iter()
            .min_by(|(p, _), (q, _)| {
                (p - contact.point).norm().total_cmp(&(q - contact.point).norm())
            })
            .expect("there is one");
        let off = (nearest.0 - contact.point).norm();
        assert!(off < 1e-3, "{off} m off: {contact:?}, {nearest:?}");
        let cosine = nearest.1.dot(&contact.normal_a_to_b);
        assert!(cosine > 0.99, "cosine {cosine}: {contact:?}, {nearest:?}");
    }
}

#[test]
fn two_clouds() {
    let floor = scan(&scene::plane_patch(0.4), 0.015, 0.003, 1, Mode::Calibrated);
    let ball = scan(&scene::sphere(0.1, 3), 0.012, 0.002, 2, Mode::Calibrated);
    check((&floor).into(), (&ball).into());
}

#[test]
fn a_cloud_and_a_watertight_mesh() {
    let floor = scan(&scene::plane_patch(0.4), 0.015, 0.003, 1, Mode::Calibrated);
    check((&floor).into(), (&mesh(&scene::sphere(0.1, 3))).into());
}

#[test]
fn a_cloud_and_an_open_mesh() {
    let ball = scan(&scene::sphere(0.1, 3), 0.012, 0.002, 2, Mode::Calibrated);
    check((&mesh(&scene::plane_patch(0.4))).into(), (&ball).into());
}

#[test]
fn two_meshes() {
    let (floor, ball) = (mesh(&scene::cuboid([0.4, 0.4, 1e-3])), mesh(&scene::sphere(0.1, 3)));
    check((&floor).into(), (&ball).into());
}

/// Pose and inverse agree also for the signed distance: the clearance is the same both ways.
#[test]
fn the_clearance_has_no_direction() {
    let floor = scan(&scene::plane_patch(0.4), 0.015, 0.003, 1, Mode::Calibrated);
    let ball = mesh(&scene::sphere(0.1, 3));
    for a_from_b in poses() {
        let forth = ask(Mode::Calibrated, &floor, &ball, &a_from_b).clearance_m;
        let back = ask(Mode::Calibrated, &ball, &floor, &a_from_b.inverse()).clearance_m;
        match (forth, back) {
            // Rounding of two poses that undo one another.
            (Some(f), Some(b)) => assert!((f.mean - b.mean).abs() < 1e-9, "{f:?}, {b:?}"),
            (f, b) => assert_eq!(f.is_some(), b.is_some()),
        }
    }
}

//! Naming the bodies the other way round gives the same answer seen from the other side.

use crate::common::{Asked, Scan, ask, mesh, prepare, scan};
use cloudtouch::geom::{Pose, Vector3};
use cloudtouch::{Mode, Report};
use cloudtouch_testkit::family::{Family, Side};
use cloudtouch_testkit::noise::NoiseKind;
use cloudtouch_testkit::scene;

/// What the library promises of the calibrated mode.
const TOLERANCE: f64 = 1e-3;

/// Roll, pitch and yaw of the second frame in the first.
const TURNED: [f64; 3] = [0.4, -0.7, 1.9];
const PARALLEL: [f64; 3] = [0.0; 3];

fn floor() -> Scan {
    scan(&scene::plane_patch(0.4), 0.015, 0.003, 1, Mode::Calibrated)
}

fn ball() -> Scan {
    scan(&scene::sphere(0.1, 3), 0.012, 0.002, 2, Mode::Calibrated)
}

/// A ball 10 cm in radius over a floor, from overlap to clear.
fn poses(rpy: [f64; 3]) -> Vec<Pose> {
    [-0.03, -0.01, -0.005, 0.0, 0.003, 0.006, 0.008, 0.015, 0.03]
        .map(|gap| Pose::from_translation_rpy(Vector3::new(0.02, 0.01, 0.1 + gap), rpy))
        .to_vec()
}

fn both_ways(a: Asked<'_>, b: Asked<'_>, a_from_b: &Pose) -> [Report; 2] {
    [ask(Mode::Calibrated, a, b, a_from_b), ask(Mode::Calibrated, b, a, &a_from_b.inverse())]
}

fn same_probability(a: Asked<'_>, b: Asked<'_>, rpy: [f64; 3]) {
    for a_from_b in poses(rpy) {
        let [forth, back] = both_ways(a, b, &a_from_b);
        let (p, q) = (forth.collision_probability, back.collision_probability);
        let height = a_from_b.translation().z;
        assert!((p - q).abs() < TOLERANCE, "{p} and {q} at height {height}");
        assert_eq!(forth.verdict, back.verdict, "at height {height}");
    }
}

#[test]
fn two_clouds_in_parallel_frames() {
    same_probability((&floor()).into(), (&ball()).into(), PARALLEL);
}

#[test]
fn two_clouds_in_frames_turned_against_each_other() {
    same_probability((&floor()).into(), (&ball()).into(), TURNED);
}

#[test]
fn an_open_mesh_and_a_cloud_in_parallel_frames() {
    same_probability((&mesh(&scene::plane_patch(0.4))).into(), (&ball()).into(), PARALLEL);
}

#[test]
fn an_open_mesh_and_a_cloud_in_frames_turned_against_each_other() {
    same_probability((&mesh(&scene::plane_patch(0.4))).into(), (&ball()).into(), TURNED);
}

#[test]
fn a_cloud_and_a_watertight_mesh() {
    same_probability((&floor()).into(), (&mesh(&scene::sphere(0.1, 3))).into(), TURNED);
}

#[test]
fn two_meshes() {
    let slab = mesh(&scene::cuboid([0.4, 0.4, 1e-3]));
    same_probability((&slab).into(), (&mesh(&scene::sphere(0.1, 3))).into(), TURNED);
}

/// The classifier was given what was called A first and ends within its tolerance; and rounding chose among
/// samples of a mesh that are as near as each other. Each of these scenes had poses beyond the tolerance, the worst .026.
#[test]
fn furnished_scenes() {
    let scenes = [
        (Family::Workbench, 6, 17),
        (Family::Furniture, 5, 13),
        (Family::Staircase, 77, 20),
        (Family::Kitchen, 77, 16),
    ];
    let mut doubtful = 0;
    for (family, seed, of_poses) in scenes {
        let drawn = family.scene(seed);
        let seen = |side, seed| {
            let observed = drawn.observe(side, 5_000, NoiseKind::Gaussian, 0.002, seed);
            prepare(observed.cloud.points, 0.002, Mode::Calibrated)
        };
        let (a, b, of_b) = (seen(Side::A, 3), seen(Side::B, 4), mesh(drawn.b.mesh()));
        for pose in drawn.poses(48, of_poses) {
            for b in [Asked::from(&b), Asked::from(&of_b)] {
                let [forth, back] = both_ways((&a).into(), b, &pose.scene_from_object);
                let (p, q) = (forth.collision_probability, back.collision_probability);
                assert!((p - q).abs() < TOLERANCE, "{p} and {q} in {}", family.name());
                doubtful += usize::from((0.05..0.95).contains(&p));
            }
        }
    }
    assert!(doubtful >= 60, "{doubtful}");
}

/// The most probable contact of one is a contact of the other, in its frame and turned round.
///
/// A surface solved to a relative gap of 1e-3 moves by far less than a millimetre; after an early
/// stop in a clear collision another place may be reported, so there nothing is compared.
#[test]
fn contacts_are_mapped_and_normals_turned_round() {
    let (floor, ball, solid) = (floor(), ball(), mesh(&scene::sphere(0.1, 3)));
    let mut compared = 0;
    for b in [Asked::from(&ball), Asked::from(&solid)] {
        for a_from_b in poses(PARALLEL) {
            let [forth, back] = both_ways((&floor).into(), b, &a_from_b);
            let Some(contact) = forth.contacts.first() else { continue };
            if forth.collision_probability > 0.99 {
                continue;
            }
            let off = |c: &&cloudtouch::Contact| {
                (a_from_b.transform_point(&c.point) - contact.point).norm()
            };
            let nearest = back.contacts.iter().min_by(|c, d| off(c).total_cmp(&off(d)));
            let nearest = nearest.expect("a contact one way is a contact the other way");
            assert!(off(&nearest) < 1e-3, "{} m off: {contact:?}, {nearest:?}", off(&nearest));
            let turned_round = -a_from_b.transform_vector(&nearest.normal_a_to_b);
            let cosine = turned_round.dot(&contact.normal_a_to_b);
            assert!(cosine > 0.99, "cosine {cosine}: {contact:?}, {nearest:?}");
            compared += 1;
        }
    }
    assert!(compared >= 4, "only {compared} poses have a contact to compare");
}

#[test]
fn the_clearance_has_no_direction() {
    let (floor, ball) = (floor(), mesh(&scene::sphere(0.1, 3)));
    for a_from_b in poses(TURNED) {
        let [forth, back] = both_ways((&floor).into(), (&ball).into(), &a_from_b);
        match (forth.clearance_m, back.clearance_m) {
            // Rounding of two poses that undo one another.
            (Some(f), Some(b)) => assert!((f.mean - b.mean).abs() < 1e-9, "{f:?}, {b:?}"),
            (f, b) => assert_eq!(f.is_some(), b.is_some()),
        }
    }
}

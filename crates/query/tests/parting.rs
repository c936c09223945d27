//! Which way the bodies part at a contact, where no single piece of surface says so.

use crate::common::{ask, measured, mesh, prepare, query};
use cloudtouch::geom::{Point3, Pose, TriangleMesh, Vector3};
use cloudtouch::{Mode, Report};
use cloudtouch_testkit::scene;

const SPACING: f64 = 0.008;
const STD: f64 = 0.002;
const SEEDS: u64 = 8;

/// How far the normal of the likeliest contact is off, degrees; each draw of the clouds, with the object as a
/// cloud and as a mesh.
fn off(
    scene: &TriangleMesh,
    object: &TriangleMesh,
    pose: &Pose,
    out: Vector3,
) -> Vec<(f64, Report)> {
    let cloud = |mesh: &TriangleMesh, seed| {
        prepare(measured(mesh, SPACING, STD, seed), STD, Mode::Calibrated)
    };
    let exact = mesh(object);
    let mut all = Vec::new();
    for seed in 0..SEEDS {
        let (scene, object) = (cloud(scene, 2 * seed), cloud(object, 2 * seed + 1));
        let reports = [
            ask(Mode::Calibrated, &scene, &object, pose),
            ask(Mode::Calibrated, &scene, &exact, pose),
        ];
        all.extend(reports.map(|report| {
            let contact = report.contacts.first().expect("they overlap or nearly do");
            (contact.normal_a_to_b.dot(&out).clamp(-1.0, 1.0).acos().to_degrees(), report)
        }));
    }
    all
}

/// Most within this, and none beyond the other.
fn assert_off(all: &[(f64, Report)], [mostly, at_most]: [f64; 2]) {
    let mut angles: Vec<f64> = all.iter().map(|(angle, _)| *angle).collect();
    angles.sort_by(f64::total_cmp);
    assert!(angles[3 * angles.len() / 4] < mostly, "{angles:.0?}");
    assert!(angles[angles.len() - 1] < at_most, "{angles:.0?}");
}

/// A box that stands on one of its edges, pressed into a table top: its faces lean by 45 degrees.
#[test]
fn an_edge_in_a_table_top_parts_across_the_table() {
    let (table, edge) = (scene::plane_patch(0.3), scene::cuboid([0.1; 3]));
    for depth in [0.004, 0.012] {
        let height = 0.1 * std::f64::consts::FRAC_1_SQRT_2;
        let place = Vector3::new(0.01, -0.02, height - depth);
        let pose = Pose::from_translation_rpy(place, [std::f64::consts::FRAC_PI_4, 0.0, 0.3]);
        assert_off(&off(&table, &edge, &pose, Vector3::z()), [20.0, 35.0]);
    }
}

/// A block that comes down on the rim of an upright sheet, whose own normal is level.
#[test]
fn a_block_on_the_rim_of_a_sheet_parts_along_the_sheet() {
    let upright =
        Pose::from_translation_rpy(Vector3::zeros(), [std::f64::consts::FRAC_PI_2, 0.0, 0.0]);
    let sheet = scene::moved(&scene::plane_patch(0.2), &upright);
    let block = scene::cuboid([0.15; 3]);
    for depth in [0.004, 0.012] {
        let pose = Pose::from_translation(Vector3::new(0.0, 0.03, 0.1 + 0.075 - depth));
        assert_off(&off(&sheet, &block, &pose, Vector3::z()), [20.0, 35.0]);
    }
}

/// Two boxes that overlap at an edge of each, crossed: neither face has the normal of their plane.
#[test]
fn crossed_edges_part_across_both() {
    let ridge = |turn: f64| {
        let pose =
            Pose::from_translation_rpy(Vector3::zeros(), [std::f64::consts::FRAC_PI_4, 0.0, turn]);
        scene::moved(&scene::cuboid([0.1; 3]), &pose)
    };
    let height = 0.1 * 2.0_f64.sqrt();
    let pose = Pose::from_translation(Vector3::new(0.005, 0.01, height - 0.01));
    let all = off(&ridge(0.0), &ridge(1.3), &pose, Vector3::z());
    assert_off(&all, [20.0, 35.0]);
}

#[test]
fn seen_from_the_other_body_it_points_the_other_way() {
    let (table, ball) = (scene::plane_patch(0.3), mesh(&scene::sphere(0.05, 3)));
    let table = prepare(measured(&table, SPACING, STD, 3), STD, Mode::Calibrated);
    let pose = Pose::from_translation_rpy(Vector3::new(0.02, 0.01, 0.046), [0.3, -0.2, 1.0]);
    let query = query(Mode::Calibrated);
    let forth = query.run(&table, &ball, &pose).unwrap();
    let back = query.run(&ball, &table, &pose.inverse()).unwrap();
    let (forth, back) = (&forth.contacts[0], &back.contacts[0]);
    let seen = pose.transform_vector(&back.normal_a_to_b);
    assert!((forth.normal_a_to_b + seen).norm() < 1e-6, "{forth:?} {back:?}");
}

/// The closer the samples, the sooner bottom and table were told apart, as they lie: the normal led into the table.
#[test]
fn a_box_pressed_into_a_dense_table_parts_upwards() {
    let lattice = |k: u32| [k % 150, k / 150].map(|k| 0.002 * f64::from(k) - 0.15);
    let point = |[x, y]: [f64; 2]| Point3::new(x, y, 0.0);
    let points = (0..22_500).map(lattice).map(point).collect();
    let table = prepare(points, 0.001, Mode::Calibrated);
    let cube = mesh(&scene::cuboid([0.06; 3]));
    for depth in [0.003, 0.005, 0.008, 0.012, 0.02] {
        let place = Vector3::new(0.003, 0.002, 0.03 - depth);
        let pose = Pose::from_translation_rpy(place, [0.0, 0.0, 0.3]);
        let report = ask(Mode::Calibrated, &table, &cube, &pose);
        let normal = report.contacts.first().expect("they overlap").normal_a_to_b;
        assert!(normal.z > 0.8, "{depth}: {normal}");
        let back = ask(Mode::Calibrated, &cube, &table, &pose.inverse());
        let normal = pose.transform_vector(&back.contacts[0].normal_a_to_b);
        assert!(normal.z < -0.8, "{depth}: {normal}");
    }
}

/// A sheet has no outside, whichever way its triangles are turned.
#[test]
fn a_plate_through_the_top_of_a_bowl_parts_upwards() {
    let bowl = measured(&scene::sphere(0.1, 4), 0.004, 0.002, 1).into_iter().filter(|p| p.z > 0.0);
    let bowl = prepare(bowl.collect(), 0.002, Mode::Calibrated);
    let plate = scene::plane_patch(0.2);
    let other_way = plate.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
    let turned = TriangleMesh::new(plate.vertices().to_vec(), other_way).expect("a mesh");
    let pose = Pose::from_translation(Vector3::new(0.0, 0.0, 0.09));
    for plate in [plate, turned] {
        let report = ask(Mode::Calibrated, &bowl, &mesh(&plate), &pose);
        let normal = report.contacts.first().expect("they overlap").normal_a_to_b;
        assert!(normal.z > 0.8, "{normal}");
    }
}

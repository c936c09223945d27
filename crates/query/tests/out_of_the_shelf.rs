//! A path whose gripper scrapes along a board, pulled out of it by the gradient: an elastic band (Quinlan
//! and Khatib, 1993).
//!
//! Plain steps, and no library of line searches: where crossings come into reach the evidence has a step, at
//! which conditions on decrease and slope give up.
#![allow(clippy::unwrap_used, reason = "a panic is how a test helper fails")]

use cloudtouch::geom::{Point3, PointCloud, Pose, TriangleMesh, Vector3};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mesh, Query, QuerySettings};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};
use cloudtouch_testkit::scene::{assemble, cuboid, moved, union_of_boxes};
use cloudtouch_testkit::{exact::ExactMesh, surface};

const POSES: usize = 20;
/// How far a pose moves in one step, m, and how much of the way to the middle of its neighbours.
const STEP: f64 = 0.002;
const SMOOTHING: f64 = 0.2;
/// What the steps are to reach at every pose.
const MOST: f64 = 0.05;

/// Two boards 22 cm apart and a back, open toward −y.
fn shelf() -> TriangleMesh {
    let board = |z: f64| {
        moved(&cuboid([0.6, 0.3, 0.02]), &Pose::from_translation(Vector3::new(0.0, 0.0, z)))
    };
    let back = Pose::from_translation(Vector3::new(0.0, 0.16, 0.12));
    assemble([board(0.0), board(0.24), moved(&cuboid([0.6, 0.02, 0.26]), &back)])
}

/// A palm with two fingers ahead of it, toward +y.
fn gripper() -> TriangleMesh {
    union_of_boxes(&[
        [[-0.06, -0.05, -0.03], [0.06, 0.0, 0.03]],
        [[-0.06, 0.0, -0.01], [-0.04, 0.08, 0.01]],
        [[0.04, 0.0, -0.01], [0.06, 0.08, 0.01]],
    ])
}

#[test]
fn a_path_is_pulled_out_of_the_board_it_scrapes_along() {
    let (shelf, gripper) = (shelf(), gripper());
    let samples = surface::positions(&surface::sample_surface(&shelf, 12_000, 7));
    let std = 0.002;
    let points: Vec<Point3> = add_noise(&samples, NoiseKind::Gaussian, std, 7);
    let settings = CloudSettings::new(SensorModel::Isotropic { std });
    let scan = Cloud::prepare(&PointCloud::from_points(points), &settings).unwrap();
    let hand = Mesh::prepare(&gripper).unwrap();
    let query = Query::new(QuerySettings::default()).unwrap();

    // In from free to free, sagging into the lower board on the way.
    let height = |share: f64| 0.12 - 0.11 * (std::f64::consts::PI * share).sin();
    let mut path: Vec<Pose> = (0..POSES)
        .map(|k| k as f64 / (POSES - 1) as f64)
        .map(|share| Vector3::new(0.02, -0.35 + 0.35 * share, height(share)))
        .map(|place| Pose::from_translation_rpy(place, [0.0, 0.0, 0.1]))
        .collect();
    let along = |path: &[Pose]| -> Vec<(f64, Option<f64>)> {
        let told = path.iter().map(|pose| query.run(&scan, &hand, pose).unwrap());
        told.map(|r| (r.collision_probability, r.clearance_m.map(|gap| gap.mean))).collect()
    };
    let worst = |told: &[(f64, Option<f64>)]| told.iter().map(|(p, _)| *p).fold(0.0, f64::max);
    let before = along(&path);
    assert!(before.iter().filter(|(p, _)| *p > 0.9).count() >= 5, "{before:.3?}");

    let mut rounds = 0;
    while worst(&along(&path)) > MOST && rounds < 60 {
        rounds += 1;
        let known = path.clone();
        for k in 1..POSES - 1 {
            let (report, gradient) = query.gradient(&scan, &hand, &known[k]).unwrap();
            let places = [k - 1, k, k + 1].map(|k| known[k].translation());
            let mut shift = (0.5 * (places[0] + places[2]) - places[1]) * SMOOTHING;
            if report.collision_probability > 0.5 * MOST {
                // Deep in, the log odds say nothing more; the depth does.
                let [x, y, z, ..] = gradient.log_odds.map(|slope| -slope);
                let out = Vector3::new(x, y, z).try_normalize(1e-6);
                let [x, y, z, ..] = gradient.clearance.unwrap_or_default();
                let out = out.or_else(|| Vector3::new(x, y, z).try_normalize(1e-6));
                shift += known[k].transform_vector(&out.unwrap_or_default()) * STEP;
            }
            path[k] = Pose::from_translation(shift).after(&known[k]);
        }
    }
    let after = along(&path);
    println!("{rounds} rounds\nbefore {before:.3?}\nafter  {after:.3?}");
    assert!(worst(&after) <= MOST, "{after:.3?}");
    // What was scanned is not touched either, and the ends stay.
    let (shelf, gripper) = (ExactMesh::new(&shelf), ExactMesh::new(&gripper));
    assert!(path.iter().all(|pose| !shelf.intersects(&gripper, pose)));
    let steps = path.windows(2).map(|pair| (pair[1].translation() - pair[0].translation()).norm());
    assert!(steps.fold(0.0, f64::max) < 0.05);
}

//! Samples far denser than their noise: the work is bounded, and the answer that of all of them.

use crate::common::{Scan, ask, at, measured, scan};
use cloudtouch::geom::PointCloud;
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, Mode, Query, QuerySettings, Report, Verdict};
use cloudtouch_testkit::scene;

/// Two balls of 5 cm with a sample for every 1.2 mm and 5 mm of noise, their surfaces so far apart.
fn balls() -> [Scan; 2] {
    [1, 2].map(|seed| scan(&scene::sphere(0.05, 4), 0.0012, 0.005, seed, Mode::Calibrated))
}

#[test]
fn every_sample_was_held_against_every_other() {
    let [a, b] = balls();
    for gap in [-0.03, 0.0, 0.01, 0.03] {
        let report = ask(Mode::Calibrated, &a, &b, &at(0.0, 0.0, 0.1 + gap));
        // Before, 1.8 to 4.7 million of them in a cloud four times as large.
        let pairs = report.stats.leaf_pairs;
        assert!(pairs < 100_000, "{pairs} at a gap of {gap}");
    }
}

#[test]
fn balls_apart_are_free_and_balls_in_one_another_collide() {
    let [a, b] = balls();
    let verdict = |gap| ask(Mode::Calibrated, &a, &b, &at(0.0, 0.0, 0.1 + gap)).verdict;
    assert_eq!(verdict(0.04), Verdict::Free);
    assert_eq!(verdict(-0.03), Verdict::InCollision);
}

/// Two boxes of 12 cm with a sample for every 4 mm and 2 cm of noise, as an object is in a stereo image
/// of a room.
fn boxes() -> [Cloud; 2] {
    [1, 2].map(|seed| {
        let points = measured(&scene::cuboid([0.12; 3]), 0.004, 0.02, seed);
        let settings = CloudSettings::new(SensorModel::Isotropic { std: 0.02 });
        Cloud::prepare(&PointCloud::from_points(points), &settings).expect("a good cloud")
    })
}

fn ask_boxes([a, b]: &[Cloud; 2], gap: f64) -> Report {
    let query = Query::new(QuerySettings::default()).expect("default settings");
    query.run(a, b, &at(0.0, 0.0, 0.12 + gap)).expect("a good pose")
}

const GAPS: [f64; 4] = [-0.04, -0.01, 0.01, 0.04];

/// What was known of leaves before their surface is seen ruled out hardly any.
#[test]
fn nearly_every_pair_of_leaves_was_looked_at() {
    let clouds = boxes();
    for gap in GAPS {
        let Report { stats, .. } = ask_boxes(&clouds, gap);
        // Before, 14,000 to 16,200.
        assert!(stats.leaf_pairs < 8_000, "{} at a gap of {gap}", stats.leaf_pairs);
    }
}

/// A search that goes on by fitted trees does so whatever was asked before, and finds as much.
#[test]
fn answers_of_clouds_all_noise_hang_on_nothing_asked_before() {
    let asked_before = boxes();
    GAPS.iter().rev().for_each(|gap| drop(ask_boxes(&asked_before, *gap)));
    let refined = boxes().map(|cloud| cloud.refined().expect("an ordinary cloud"));
    for gap in GAPS {
        let [fresh, again, refined] =
            [&boxes(), &asked_before, &refined].map(|clouds| ask_boxes(clouds, gap));
        let told = |report: &Report| {
            let Report {
                collision_probability,
                bounds,
                clearance_m,
                clearance_at_least_m,
                contacts,
                ..
            } = report;
            format!(
                "{collision_probability} {bounds:?} {clearance_m:?} {clearance_at_least_m:?} {contacts:?}"
            )
        };
        assert_eq!(told(&fresh), told(&again));
        let [p, q] = [&fresh, &refined].map(|report| report.collision_probability);
        assert!((p - q).abs() < 1e-6, "{p} and {q} at a gap of {gap}");
    }
}

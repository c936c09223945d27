//! Samples far denser than their noise: the work is bounded, and the answer that of all of them.

use crate::common::{Scan, ask, at, scan};
use cloudtouch::{Mode, Verdict};
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

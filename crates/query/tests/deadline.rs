//! A query that runs out of time tells the bounds it has reached, and nothing reads as free.

use std::time::Duration;

use crate::common::{AnyQuery, Asked, MODES, assert_sound, at, mesh, scan};
use cloudtouch::{Mode, Verdict};
use cloudtouch_testkit::scene;

#[test]
fn without_time_nothing_is_free_and_the_bounds_hold_the_answer() {
    for mode in MODES {
        let floor = scan(&scene::plane_patch(0.4), 0.015, 0.002, 1, mode);
        let ball = scan(&scene::sphere(0.1, 3), 0.012, 0.002, 2, mode);
        let (solid, open) = (mesh(&scene::sphere(0.1, 3)), mesh(&scene::plane_patch(0.4)));
        let pairs: [(Asked<'_>, Asked<'_>); 3] = [
            ((&floor).into(), (&ball).into()),
            ((&floor).into(), (&solid).into()),
            ((&open).into(), (&ball).into()),
        ];
        for (a, b) in pairs {
            let ask = |deadline| {
                let query =
                    AnyQuery::with(mode, |s| s.deadline = deadline, |s| s.deadline = deadline);
                // 1 cm of overlap, where there is something to look at.
                let report = query.run(a, b, &at(0.0, 0.0, 0.09)).expect("a good pose");
                assert_sound(&report);
                report
            };
            let (whole, hasty) = (ask(None), ask(Some(Duration::ZERO)));
            assert_ne!(hasty.verdict, Verdict::Free, "{mode:?}");
            let [lower, upper] = hasty.bounds;
            let p = whole.collision_probability;
            if mode == Mode::Calibrated {
                assert!(
                    lower <= p + 1e-3 && p <= upper + 1e-3,
                    "{p} outside of {:?}",
                    hasty.bounds
                );
            }
            assert!(hasty.stats.leaf_pairs <= whole.stats.leaf_pairs);
            // Time enough changes nothing.
            assert_eq!(ask(Some(Duration::from_secs(600))).collision_probability, p);
        }
    }
}

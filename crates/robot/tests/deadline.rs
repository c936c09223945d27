//! A path that there is no time for.
#![allow(clippy::unwrap_used, reason = "tests")]

use std::time::Duration;

use crate::support::{Arm, STD, joints, wall};
use cloudtouch::geom::Pose;
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, CloudSettings, Query, QuerySettings, Verdict};
use cloudtouch_robot::{PathChecked, RobotChecker, Touching};

/// Along three positions, with a wall at this distance and no time at all.
fn without_time(distance: f64) -> PathChecked {
    let settings = CloudSettings::new(SensorModel::Isotropic { std: STD });
    let body = Body::from(Cloud::prepare(&wall(distance), &settings).unwrap());
    let touching = Touching::Surroundings;
    let checker =
        RobotChecker::new(Arm::default().robot(), body, Pose::identity(), touching).unwrap();
    let settings = QuerySettings { deadline: Some(Duration::ZERO), ..QuerySettings::default() };
    let path = [-1.0, 0.0, 1.0].map(|waist| joints([waist, 1.5, 0.0, 0.0, 0.0, 0.0]));
    checker.check_path(&Query::new(settings).unwrap(), &path, 0.001).unwrap()
}

/// Sixteen positions of each segment were looked at when the time was over, and all down to the tolerance.
#[test]
fn nothing_is_searched_once_the_time_is_over() {
    let found = without_time(0.05);
    assert_ne!(found.given[0].verdict(), Verdict::Free);
    assert_eq!((found.looked_at, found.verdict()), (3, Verdict::Undecided), "{found:?}");
    assert!(found.certified_free_until == 0.0 && found.later.is_none(), "{found:?}");

    // Boxes alone tell that all positions are free, and not what is between them.
    let found = without_time(1.5 * Arm::TOP);
    assert!(found.given.iter().all(|at| at.verdict() == Verdict::Free), "{found:?}");
    assert_eq!((found.looked_at, found.verdict()), (4, Verdict::Undecided), "{found:?}");
    assert_eq!(found.certified_free_until, 0.0);
    assert!(found.stopped.is_some_and(|at| at.nearest.is_some()) && found.later.is_none());
}

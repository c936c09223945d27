//! Random small clouds and poses for property tests.

use std::ops::Range;

use cloudtouch_geom::{Point3, Pose, Vector3};
use proptest::collection::vec;
use proptest::prelude::*;

/// Points in a box of 40 cm.
pub(super) fn cloud(count: Range<usize>) -> impl Strategy<Value = Vec<Point3>> {
    vec([-0.2..0.2_f64, -0.2..0.2, -0.2..0.2].prop_map(Point3::from), count)
}

/// Any rotation, and an offset that leaves such clouds overlapping or a little apart.
pub(super) fn pose() -> impl Strategy<Value = Pose> {
    let offset = [-0.5..0.5_f64, -0.5..0.5, -0.5..0.5].prop_map(Vector3::from);
    let angles = [-3.0..3.0_f64, -1.5..1.5, -3.0..3.0];
    (offset, angles).prop_map(|(offset, angles)| Pose::from_translation_rpy(offset, angles))
}

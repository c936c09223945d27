//! Grippers that move along their z axis; parts of one mesh keep apart.

use cloudtouch_geom::TriangleMesh;
use rand_chacha::ChaCha8Rng;

use super::{
    place::{GAP, placed, ranges},
    vessels::bottle,
};
use crate::{
    random::between,
    scene::{assemble, revolved, union_of_boxes},
};

/// A wrist of 7 cm × 7 cm × 18 cm and a palm below z = 0, two fingers of 7 cm above, so far apart.
fn two_fingers(opening: f64) -> TriangleMesh {
    let half = 0.5 * opening;
    let across = (half + 0.02).max(0.045);
    union_of_boxes(&[
        ranges([-0.035, 0.035], [-0.035, 0.035], [-0.22, -0.04]),
        ranges([-across, across], [-0.04, 0.04], [-0.04, 0.0]),
        ranges([-half - 0.02, -half], [-0.0125, 0.0125], [0.0, 0.07]),
        ranges([half, half + 0.02], [-0.0125, 0.0125], [0.0, 0.07]),
    ])
}

/// An open hand, its fingers 4 to 9 cm apart.
pub(super) fn open_hand(rng: &mut ChaCha8Rng) -> TriangleMesh {
    two_fingers(between(0.04, 0.09, rng))
}

/// A hand with a bottle across between its fingers.
pub(super) fn hand_with_bottle(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let held = bottle(rng);
    let hand = two_fingers(2.0 * (held.radius + GAP));
    let gripped_at = between(0.05, 0.12, rng);
    // Its axis along −y, before the palm.
    let place = [0.0, gripped_at, held.radius + GAP];
    let quarter = std::f64::consts::FRAC_PI_2;
    assemble([hand, placed(&held.mesh, place, [quarter, 0.0, 0.0])])
}

/// A wrist, a rod and a suction cup that widens ahead.
pub(super) fn suction_gripper(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (cup, rod) = (between(0.025, 0.04, rng), between(0.012, 0.02, rng));
    let length = between(0.12, 0.2, rng);
    revolved(
        &[
            [0.0, -length - 0.19],
            [0.055, -length - 0.19],
            [0.055, -length - 0.03],
            [0.04, -length - 0.03],
            [rod, -length],
            [rod, -0.04],
            [cup, 0.0],
            [0.0, 0.0],
        ],
        24,
    )
}

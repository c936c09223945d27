//! Tools that move along their z axis, their working end at z = 0; parts of one mesh keep apart.

use cloudtouch_geom::TriangleMesh;
use rand_chacha::ChaCha8Rng;

use super::place::{GAP, at, path, ranges};
use crate::{
    random::between,
    scene::{assemble, revolved, rounded, tube, union_of_boxes},
};

/// A cordless drill: motor, pistol grip toward −y with its battery, chuck and bit.
pub(super) fn drill(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (bit, grip) = (between(0.06, 0.12, rng), between(0.14, 0.18, rng));
    let housing = union_of_boxes(&[
        ranges([-0.03, 0.03], [-0.035, 0.035], [-0.2, 0.0]),
        ranges([-0.02, 0.02], [-grip, -0.035], [-0.17, -0.12]),
        ranges([-0.035, 0.035], [-grip - 0.05, -grip], [-0.2, -0.08]),
    ]);
    let chuck = [
        [0.0, GAP],
        [0.025, GAP],
        [0.02, 0.05],
        [0.006, 0.06],
        [0.006, 0.06 + bit],
        [0.0, 0.06 + bit],
    ];
    at(&assemble([housing, revolved(&chuck, 16)]), [0.0, 0.0, -0.06 - bit])
}

/// A round bar with two bends, as a wrecking bar or a pipe that is carried.
pub(super) fn bent_bar(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let radius = between(0.012, 0.022, rng);
    let (length, first, second) =
        (between(0.35, 0.55, rng), between(0.1, 0.16, rng), between(0.1, 0.2, rng));
    let corners = path([
        [0.0, 0.0, 0.0],
        [first, 0.0, -0.1],
        [first, 0.0, -0.1 - length],
        [first, second, -0.15 - length],
    ]);
    tube(&rounded(&corners, 0.04), radius, 12)
}

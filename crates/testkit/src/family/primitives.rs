//! Families of simple bodies, wholly observed.

use cloudtouch_geom::seed;

use super::{motion::Motion, scene::FamilyScene};
use crate::{exact::Touch, random::between, scene};

/// How far into contact a body may go, m.
const DEEP: f64 = 0.2;

/// A ball of radius 0.3 to 0.6 m and a plate of side 1.6 to 2 m, 10 to 30 cm thick.
pub(super) fn sphere_and_plane(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let side = between(1.6, 2.0, rng);
    let plate = scene::cuboid([side, side, between(0.1, 0.3, rng)]);
    let ball = scene::sphere(between(0.3, 0.6, rng), 3);
    FamilyScene::from_anywhere(&plate, &ball, Touch::Solids, DEEP, seed)
}

/// A wedge 0.8 to 1.4 m long and a plate of side 1.6 to 2 m, 10 to 30 cm thick.
pub(super) fn wedge_and_plane(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let (size, thickness) = (between(1.6, 2.0, rng), between(0.1, 0.3, rng));
    let length = between(0.8, 1.4, rng);
    let wedge = scene::wedge(between(0.3, 0.7, rng), between(0.5, 0.9, rng), length);
    let motion = Motion::EdgeFirst { top: 0.5 * thickness, size, length };
    FamilyScene::wholly_seen(&scene::cuboid([size, size, thickness]), &wedge, Touch::Solids, motion)
}

/// Two rectangles with sides of 1.4 to 2 m.
pub(super) fn crossing_sheets(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let mut sheet = || scene::rectangle(between(1.4, 2.0, rng), between(1.4, 2.0, rng));
    let (a, b) = (sheet(), sheet());
    // Deep enough to cross in the middle.
    FamilyScene::from_anywhere(&a, &b, Touch::Surfaces, 0.6, seed)
}

/// A board of 2 cm, and in turn a box, a wedge and a second board.
pub(super) fn thin_slab(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let board = scene::cuboid([between(1.4, 2.0, rng), between(1.0, 1.4, rng), 0.02]);
    let body = match seed % 3 {
        0 => scene::cuboid([0; 3].map(|_| between(0.4, 0.8, rng))),
        1 => scene::wedge(between(0.2, 0.5, rng), between(0.4, 0.8, rng), between(0.6, 1.2, rng)),
        _ => scene::cuboid([between(0.9, 1.4, rng), between(0.9, 1.4, rng), 0.02]),
    };
    FamilyScene::from_anywhere(&board, &body, Touch::Solids, DEEP, seed)
}

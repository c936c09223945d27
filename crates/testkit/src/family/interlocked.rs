//! Bodies within one another: a peg in a hole, two rings of a chain.

use cloudtouch_geom::seed;

use super::{ends::Ends, motion::Motion, scene::FamilyScene};
use crate::{exact::Touch, random::between, scene};

/// A block of side 1.2 to 1.5 m, 25 to 45 cm thick, with a hole of radius 25 to 35 cm along z, and
/// a peg 0.8 to 1.2 m long that is 1 to 6 cm narrower in radius.
pub(super) fn peg_in_hole(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let (radius, clearance) = (between(0.25, 0.35, rng), between(0.01, 0.06, rng));
    let (depth, peg_length) = (between(0.25, 0.45, rng), between(0.8, 1.2, rng));
    let block = scene::plate_with_hole(between(1.2, 1.5, rng), depth, radius);
    let peg = scene::peg(radius - clearance, peg_length);
    let ends = Ends::of(&block, &peg, seed);
    let motion = Motion::InHole { ends, depth, peg_length, clearance };
    FamilyScene::wholly_seen(&block, &peg, Touch::Solids, motion)
}

/// Two tori with circles of radius 45 to 55 cm and tubes of 10 to 14 cm.
pub(super) fn tori(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let major = between(0.45, 0.55, rng);
    let fixed = scene::torus(major, between(0.1, 0.14, rng), 32);
    let moving = scene::torus(between(0.45, 0.55, rng), between(0.1, 0.14, rng), 32);
    let motion = Motion::Linked { ends: Ends::of(&fixed, &moving, seed), major };
    FamilyScene::wholly_seen(&fixed, &moving, Touch::Solids, motion)
}

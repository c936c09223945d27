//! Things set down on tables and boards, or put against a wall: faces along one another.

use cloudtouch_geom::{TriangleMesh, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    guided::Flat,
    motion::Motion,
    pieces::{shelf, table},
    place::{at, ranges},
    scene::FamilyScene,
    seen::all_around,
};
use crate::{
    random::between,
    scene::{assemble, cuboid, cylinder, union_of_boxes},
};

/// The room between the wall and what stands before it at most, m.
const BEFORE_WALL: f64 = 0.15;

/// A table or a shelf at 60 to 80 % of full size before a wall.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let piece = if rng.random() { table(rng) } else { shelf(rng) }.scaled(between(0.6, 0.8, rng));
    let (low, high) = piece.bounding_box().expect("a mesh has vertices");
    let wall = ranges([low.x, high.x], [0.0, 0.05], [0.3 * high.z, high.z + 0.3]);
    let off = [0.0, -high.y - between(0.01, BEFORE_WALL, rng), 0.0];
    let a = assemble([union_of_boxes(&[wall]), at(&piece, off)]);
    let b = thing(rng);
    FamilyScene::surveyed([&a, &b], &all_around(&a), [0.06, 0.03], seed, |ends| {
        Motion::Flat(Flat { ends })
    })
}

/// A box, a board, a tray, or something round with a flat bottom.
fn thing(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let [w, d] = [between(0.08, 0.25, rng), between(0.06, 0.2, rng)];
    match rng.random_range(0..4) {
        0 => cuboid([2.0 * w, 2.0 * d, between(0.08, 0.3, rng)]),
        1 => cuboid([2.0 * w, 2.0 * d, between(0.015, 0.04, rng)]),
        2 => {
            let rim = between(0.03, 0.06, rng);
            union_of_boxes(&[
                ranges([-w, w], [-d, d], [0.0, 0.015]),
                ranges([-w, 0.015 - w], [-d, d], [0.0, rim]),
                ranges([w - 0.015, w], [-d, d], [0.0, rim]),
                ranges([-w, w], [-d, 0.015 - d], [0.0, rim]),
                ranges([-w, w], [d - 0.015, d], [0.0, rim]),
            ])
        }
        _ => cylinder(between(0.04, 0.12, rng), between(0.06, 0.25, rng), 24),
    }
}

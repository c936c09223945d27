//! Rows of random furniture: large bodies with thin parts, coarsely sampled.

use cloudtouch_geom::{TriangleMesh, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    motion::Motion,
    pieces::{chair, rack, shelf, table},
    place::at,
    scene::FamilyScene,
    seen::all_around,
};
use crate::{random::between, scene::assemble};

/// Two rows of three or four pieces, up to 4 m long and a metre apart, and one of two.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let [near, far] = [0; 2].map(|_| row(rng.random_range(3..=4), rng));
    let far = at(&far, [0.0, between(1.2, 1.6, rng), 0.0]);
    let (a, b) = (assemble([near, far]), row(2, rng));
    FamilyScene::surveyed([&a, &b], &all_around(&a), [0.1, 0.1], seed, |ends| Motion::Open {
        ends,
        deepest: 0.2,
    })
}

/// Pieces side by side along x, each on z = 0 and closed, standing apart or touching.
fn row(pieces: usize, rng: &mut ChaCha8Rng) -> TriangleMesh {
    let mut end = 0.0;
    let parts: Vec<TriangleMesh> = (0..pieces)
        .map(|_| {
            let piece = match rng.random_range(0..4) {
                0 => table(rng),
                1 => shelf(rng),
                2 => chair(rng),
                _ => rack(rng),
            };
            let (low, high) = piece.bounding_box().expect("a mesh has vertices");
            let offset = [end - low.x, between(-0.2, 0.2, rng), 0.0];
            end += high.x - low.x + between(0.02, 0.15, rng);
            at(&piece, offset)
        })
        .collect();
    assemble(parts)
}

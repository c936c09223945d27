//! A kitchen counter with vessels, as sensors above and before it see it.

use std::f64::consts::PI;

use cloudtouch_geom::{Point3, TriangleMesh, Vector3, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    guided::Reach,
    hands::{hand_with_bottle, open_hand},
    motion::Motion,
    place::{SUNK, at, placed, ranges, turned},
    scene::FamilyScene,
    vessels::{Vessel, bottle, bowl, mug, pan, pot, tap},
};
use crate::{
    random::{between, within},
    scene::{assemble, cuboid, union_of_boxes},
};

/// Where sensors stand, m; the counter's top is at z = 0, its front at −y.
const PLACES: [[f64; 3]; 8] = [
    [0.0, -1.0, 0.8],
    [-1.0, -0.7, 0.6],
    [1.0, -0.7, 0.6],
    [-0.5, 0.0, 1.2],
    [0.5, 0.0, 1.2],
    [-1.3, 0.1, 0.4],
    [1.3, 0.1, 0.4],
    [0.0, -1.4, -0.3],
];

/// The counter in full size, and a hand, empty or with a bottle.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let hand = if rng.random() { open_hand(rng) } else { hand_with_bottle(rng) };
    with_hand(&hand, seed)
}

/// The counter and any hand, which comes from above or from the front, its z axis ahead.
pub(super) fn with_hand(hand: &TriangleMesh, seed: u64) -> FamilyScene {
    let a = counter(&mut seed::generator(seed::derive(seed, 101, 0)));
    let ways = vec![(-Vector3::z(), 0.8), (Vector3::y(), 0.6)];
    // Above the top, before the wall.
    let things = [[-1.0, -0.3, 0.003], [1.0, 0.28, 0.5]];
    let places = PLACES.map(Point3::from);
    FamilyScene::surveyed([&a, hand], &places, [0.04, 0.02], seed, |ends| Motion::Reach {
        reach: Reach { ends, ways, things, from: 0.6 },
        deepest: 0.08,
    })
}

/// Top at z = 0 with a sink on the right, a wall behind, a board that leans there, and vessels that
/// keep apart on the left.
fn counter(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, d) = (between(0.9, 1.05, rng), 0.3);
    let (sink, depth) = (between(0.2, 0.25, rng), between(0.14, 0.2, rng));
    // The sink's middle is so far from the middle.
    let x = w - sink - 0.08;
    let [left, right, front, back] = [x - sink, x + sink, -0.22, 0.16];
    let mut parts = vec![
        union_of_boxes(&[
            ranges([-w, left], [-d, d], [-0.7, 0.0]),
            ranges([right, w], [-d, d], [-0.7, 0.0]),
            ranges([left, right], [-d, front], [-0.7, 0.0]),
            ranges([left, right], [back, d], [-0.7, 0.0]),
            ranges([left, right], [front, back], [-0.7, -depth]),
            ranges([-w, w], [d, d + 0.08], [-0.7, 0.6]),
        ]),
        at(&tap(rng), [x, 0.22, -SUNK]),
    ];
    // A board leans at the wall.
    let (width, length, lean) = (between(0.2, 0.28, rng), between(0.3, 0.4, rng), 0.2_f64);
    let back = d + SUNK - 0.5 * (length * lean.sin() + 0.02 * lean.cos());
    let up = 0.5 * (length * lean.cos() + 0.02 * lean.sin()) - SUNK;
    let leaning = [between(-0.9, -0.6, rng) * w, back, up];
    parts.push(placed(&cuboid([width, 0.02, length]), leaning, [-lean, 0.0, 0.0]));
    let vessels = [pot(rng), pan(rng), bowl(rng), bottle(rng), mug(rng), bottle(rng)];
    parts.extend(standing_apart(vessels, [-w, left], [-d, 0.16], rng));
    // One stands in the sink.
    let Vessel { mesh, .. } = mug(rng);
    parts.push(turned(&mesh, within(PI, rng), [x + within(0.08, rng), -0.03, -depth - SUNK]));
    assemble(parts)
}

/// The vessels that find a place between these bounds, turned at random.
fn standing_apart(
    vessels: impl IntoIterator<Item = Vessel>,
    x: [f64; 2],
    y: [f64; 2],
    rng: &mut ChaCha8Rng,
) -> Vec<TriangleMesh> {
    let mut taken: Vec<([f64; 2], f64)> = Vec::new();
    let mut standing = Vec::new();
    for Vessel { mesh, radius } in vessels {
        // A long handle may stick out in front.
        let margin = radius.min(0.15);
        let place = (0..200).find_map(|_| {
            let [x, y] = [x, y].map(|[low, high]| between(low + margin, high - margin, rng));
            let clear = |([u, v], r): &([f64; 2], f64)| (x - u).hypot(y - v) > r + radius + 0.01;
            taken.iter().all(clear).then_some([x, y])
        });
        if let Some([x, y]) = place {
            taken.push(([x, y], radius));
            // Handles point away from the wall.
            let yaw = between(-0.8 * PI, -0.2 * PI, rng);
            standing.push(turned(&mesh, yaw, [x, y, -SUNK]));
        }
    }
    standing
}

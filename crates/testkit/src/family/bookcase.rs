//! A bookcase with books and things on its boards: a book, a carton or a hand comes in from before it.

use std::f64::consts::PI;

use cloudtouch_geom::{Point3, TriangleMesh, Vector3, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    guided::{Flat, Reach},
    hands::open_hand,
    lounge::books,
    motion::Motion,
    place::{GAP, SUNK, ranges, turned},
    scene::FamilyScene,
    vessels::{bottle, mug},
};
use crate::{
    random::{between, within},
    scene::{assemble, cuboid, union_of_boxes},
};

/// Where sensors stand, m; the lowest board is at z = 0, the open side at −y.
const PLACES: [[f64; 3]; 7] = [
    [0.0, -1.2, 0.3],
    [-0.8, -1.0, 0.6],
    [0.8, -1.0, 0.6],
    [-0.6, -0.9, 0.1],
    [0.6, -0.9, 0.1],
    [0.0, -0.9, 1.1],
    [0.0, -0.2, 1.6],
];

/// Two of its boards in full size; a book, a carton or a hand.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let (w, d) = (between(0.35, 0.5, rng), between(0.13, 0.16, rng));
    let a = bookcase(w, d, rng);
    let [thick, deep, high] =
        [between(0.02, 0.05, rng), between(0.12, 0.2, rng), between(0.16, 0.24, rng)];
    let thing = rng.random_range(0..4);
    let b = match thing {
        0 => cuboid([thick, deep, high]),
        1 => cuboid([5.0 * thick, deep, 0.8 * high]),
        _ => open_hand(rng),
    };
    let places = PLACES.map(Point3::from);
    FamilyScene::surveyed([&a, &b], &places, [0.04, 0.02], seed, |ends| {
        if thing < 2 {
            return Motion::Flat(Flat { ends });
        }
        // What is on the boards, before the back.
        let things = [[-w, -d, 0.0], [w, d - 0.01, 0.8]];
        let reach = Reach { ends, ways: vec![(Vector3::y(), 0.5)], things, from: 0.5 };
        Motion::Reach { reach, deepest: 0.08 }
    })
}

/// `w` and `d` are half its width and depth, m; books stand on the left of the lower board.
fn bookcase(w: f64, d: f64, rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (t, room) = (between(0.018, 0.03, rng), between(0.28, 0.36, rng));
    let above = room + t;
    let case = union_of_boxes(&[
        ranges([-w - t, -w], [-d, d], [-t, 2.0 * above]),
        ranges([w, w + t], [-d, d], [-t, 2.0 * above]),
        ranges([-w, w], [-d, d], [-t, 0.0]),
        ranges([-w, w], [-d, d], [room, above]),
        ranges([-w, w], [-d, d], [2.0 * room + t, 2.0 * above]),
        ranges([-w - t, w + t], [d, d + 0.01], [-t, 2.0 * above]),
    ]);
    let mut parts = vec![case];
    let missing = rng.random_range(2..=6);
    let mut x = -w + GAP;
    while x < 0.4 * w {
        let [thick, deep, high] =
            [between(0.015, 0.045, rng), between(0.13, 0.2, rng), between(0.18, 0.26, rng)];
        let front = d - GAP - deep;
        let book = ranges([x, x + thick], [front, front + deep], [-SUNK, high]);
        parts.push(union_of_boxes(&[book]));
        x += thick + GAP;
        if parts.len() == missing + 1 {
            // One was taken out.
            x += between(0.05, 0.1, rng);
        }
    }
    let things = [
        (bottle(rng).mesh, [0.62 * w, 0.0, 0.0]),
        (mug(rng).mesh, [w - 0.08, -0.03, 0.0]),
        (books(rng.random_range(2..=4), rng), [0.5 * w, -0.03, above]),
        (mug(rng).mesh, [-w + 0.1, -0.03, above]),
        (bottle(rng).mesh, [-0.1 * w, 0.02, above]),
    ];
    parts.extend(
        things.map(|(thing, [x, y, z])| turned(&thing, within(0.1 * PI, rng), [x, y, z - SUNK])),
    );
    assemble(parts)
}

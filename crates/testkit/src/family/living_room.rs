//! The corner of a living room, about half size, as sensors inside see it.

use std::f64::consts::{FRAC_PI_2, PI};

use cloudtouch_geom::{Point3, TriangleMesh, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    lounge::{books, floor_lamp, plant, round_table, upholstered},
    motion::Motion,
    pieces::{chair, shelf},
    place::{SUNK, ranges, turned},
    scene::FamilyScene,
};
use crate::{
    random::{between, within},
    scene::{assemble, revolved, union_of_boxes},
};

/// Where sensors stand at full size, m: low and high, and above the walls.
const PLACES: [[f64; 3]; 10] = [
    [1.5, -1.4, 1.5],
    [-0.5, -1.4, 1.0],
    [0.3, -0.6, 1.8],
    [-1.3, -1.2, 0.3],
    [0.6, -0.9, 0.3],
    [-1.0, 0.7, 0.3],
    [1.8, 0.6, 0.4],
    [-1.0, 0.3, 1.6],
    [-1.0, -1.0, 2.8],
    [1.2, 0.5, 2.8],
];

/// Everything at 42 to 50 % of full size: a room of 4 m × 3.2 m, open on two sides, and a crate, a
/// chair or a segment of an arm.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let scale = between(0.42, 0.5, rng);
    let a = room(rng).scaled(scale);
    let b = match rng.random_range(0..3) {
        0 => crate_with_open_top(rng),
        1 => chair(rng),
        _ => arm_segment(rng),
    }
    .scaled(scale);
    let places = PLACES.map(|p| Point3::from(p) * scale);
    FamilyScene::surveyed([&a, &b], &places, [0.06, 0.03], seed, |ends| Motion::Open {
        ends,
        deepest: 0.2,
    })
}

/// Floor at z = 0, walls on the −x and +y sides, furniture in places of its own.
fn room(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let window = between(-0.2, 0.4, rng);
    let shell = union_of_boxes(&[
        ranges([-2.1, 2.0], [-1.6, 1.7], [-0.1, 0.0]),
        ranges([-2.1, 2.0], [1.6, 1.7], [0.0, 2.2]),
        // The wall with a window in it.
        ranges([-2.1, -2.0], [-1.6, window - 0.5], [0.0, 2.2]),
        ranges([-2.1, -2.0], [window - 0.5, window + 0.5], [0.0, 0.9]),
        ranges([-2.1, -2.0], [window - 0.5, window + 0.5], [1.9, 2.2]),
        ranges([-2.1, -2.0], [window + 0.5, 1.6], [0.0, 2.2]),
    ]);
    let table = [0.3 + within(0.15, rng), 0.05 + within(0.1, rng)];
    let parts = [
        (upholstered(between(1.5, 1.9, rng), rng), [0.25 + within(0.05, rng), 1.12], 0.0),
        (upholstered(between(0.75, 0.9, rng), rng), [1.3, -0.9], 2.5 + within(0.4, rng)),
        (floor_lamp(rng), [-1.6, 1.2 + within(0.1, rng)], within(PI, rng)),
        (shelf(rng), [-1.75, -0.6 + within(0.2, rng)], FRAC_PI_2),
        (plant(rng), [1.65, 1.2], within(PI, rng)),
        (round_table(rng), table, 0.0),
        (chair(rng), [-0.75 + within(0.1, rng), -0.95], within(PI, rng)),
    ];
    let standing = parts.map(|(part, [x, y], yaw)| turned(&part, yaw, [x, y, -SUNK]));
    let (_, top) = standing[5].bounding_box().expect("a table has vertices");
    let on_table = turned(&books(3, rng), within(PI, rng), [table[0], table[1], top.z - SUNK]);
    assemble([shell, on_table].into_iter().chain(standing))
}

fn crate_with_open_top(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let [x, y, z] = [between(0.2, 0.3, rng), between(0.15, 0.2, rng), between(0.2, 0.35, rng)];
    let t = 0.02;
    union_of_boxes(&[
        ranges([-x, x], [-y, y], [0.0, t]),
        ranges([-x, -x + t], [-y, y], [t, z]),
        ranges([x - t, x], [-y, y], [t, z]),
        ranges([-x, x], [-y, -y + t], [t, z]),
        ranges([-x, x], [y - t, y], [t, z]),
    ])
}

/// Two joints and the link between, about its own axis.
fn arm_segment(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (link, joint) = (between(0.05, 0.07, rng), between(0.08, 0.11, rng));
    let length = between(0.45, 0.7, rng);
    let profile = [
        [0.0, 0.0],
        [joint - 0.02, 0.0],
        [joint, 0.02],
        [joint, 0.12],
        [link, 0.18],
        [0.9 * link, length],
        [0.85 * joint, length + 0.05],
        [0.85 * joint, length + 0.14],
        [0.0, length + 0.14],
    ];
    revolved(&profile, 24)
}

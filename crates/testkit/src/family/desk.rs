//! A desk before a wall, as sensors above and before it see it.

use std::f64::consts::PI;

use cloudtouch_geom::{Point3, TriangleMesh, Vector3, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    guided::Reach,
    hands::open_hand,
    lounge::books,
    motion::Motion,
    place::{SUNK, at, path, ranges, turned},
    scene::FamilyScene,
    vessels::mug,
};
use crate::{
    random::{between, within},
    scene::{assemble, cuboid, revolved, revolved_ring, tube, union_of_boxes},
};

/// Where sensors stand, m; the desk's top is at z = 0, its front at −y.
const PLACES: [[f64; 3]; 8] = [
    [0.0, -0.9, 0.7],
    [-0.9, -0.6, 0.5],
    [0.9, -0.6, 0.5],
    [0.0, 0.0, 1.2],
    [-1.3, 0.1, 0.6],
    [1.3, 0.1, 0.6],
    [0.4, -1.3, -0.4],
    [-0.4, -1.3, 0.2],
];

/// The desk in full size; a hand, or the carton that it holds.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let hand = if rng.random() {
        open_hand(rng)
    } else {
        cuboid([between(0.1, 0.2, rng), between(0.15, 0.3, rng), between(0.1, 0.25, rng)])
    };
    with_hand(&hand, seed)
}

/// The desk and any hand, which comes from above or from the front, its z axis ahead.
pub(super) fn with_hand(hand: &TriangleMesh, seed: u64) -> FamilyScene {
    let a = desk(&mut seed::generator(seed::derive(seed, 101, 0)));
    let ways = vec![(-Vector3::z(), 0.8), (Vector3::y(), 0.6)];
    // Above the top, before the wall.
    let things = [[-0.8, -0.4, 0.003], [0.8, 0.34, 0.5]];
    let places = PLACES.map(Point3::from);
    FamilyScene::surveyed([&a, hand], &places, [0.04, 0.02], seed, |ends| Motion::Reach {
        reach: Reach { ends, ways, things, from: 0.6 },
        deepest: 0.08,
    })
}

/// Top at z = 0, things in places of their own: monitor behind, keyboard before it, lamp on the
/// left, books on the right, cups and a mouse between.
fn desk(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, d) = (between(0.68, 0.8, rng), between(0.35, 0.4, rng));
    let furniture = union_of_boxes(&[
        ranges([-w, w], [-d, d], [-0.03, 0.0]),
        ranges([-w, -w + 0.03], [-d + 0.03, d], [-0.73, -0.03]),
        // Drawers.
        ranges([w - 0.4, w], [-d + 0.03, d], [-0.73, -0.03]),
        // The wall.
        ranges([-w - 0.1, w + 0.1], [d + 0.02, d + 0.1], [-0.73, 0.7]),
    ]);
    let mouse =
        revolved(&[[0.0, 0.0], [0.035, 0.0], [0.033, 0.018], [0.02, 0.032], [0.0, 0.036]], 16);
    let parts = [
        (monitor(rng), [within(0.06, rng), 0.18], within(0.15, rng)),
        (cuboid([0.44, 0.14, 0.025]), [within(0.05, rng), -0.2], within(0.1, rng)),
        (lamp(rng), [-w + 0.14, 0.17], between(-1.0, 0.2, rng)),
        (books(rng.random_range(3..=6), rng), [w - 0.2, 0.18], within(0.3, rng)),
        (mug(rng).mesh, [-w + 0.2 + within(0.04, rng), -0.2], within(PI, rng)),
        (mug(rng).mesh, [w - 0.12, -0.22 + within(0.03, rng)], within(PI, rng)),
        (mouse, [0.34 + within(0.03, rng), -0.2], 0.0),
    ];
    let standing = parts.map(|(part, [x, y], yaw)| {
        // Some have their origin in the middle.
        let (low, _) = part.bounding_box().expect("a mesh has vertices");
        turned(&part, yaw, [x, y, -low.z - SUNK])
    });
    assemble([furniture].into_iter().chain(standing))
}

/// A screen on a neck and a foot, facing −y.
fn monitor(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, h) = (between(0.24, 0.34, rng), between(0.28, 0.36, rng));
    let z = between(0.1, 0.14, rng);
    union_of_boxes(&[
        ranges([-w, w], [-0.03, 0.0], [z, z + h]),
        ranges([-0.04, 0.04], [0.0, 0.03], [0.015, z + 0.6 * h]),
        ranges([-0.12, 0.12], [-0.09, 0.09], [0.0, 0.015]),
    ])
}

/// A foot, two arms in the plane of x and z, and an open shade that looks down at their end.
fn lamp(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (elbow, reach) = (between(0.3, 0.38, rng), between(0.16, 0.24, rng));
    let foot = revolved(&[[0.0, 0.0], [0.085, 0.0], [0.08, 0.025], [0.0, 0.03]], 20);
    let arms = path([
        [0.0, 0.0, 0.02],
        [-0.06, 0.0, elbow],
        [reach, 0.0, elbow + 0.08],
        [reach, 0.0, elbow + 0.02],
    ]);
    let shade = revolved_ring(&[[0.07, -0.09], [0.075, -0.09], [0.02, 0.03], [0.012, 0.03]], 20);
    // It hangs on a disc in its neck.
    let socket = revolved(&[[0.0, -0.02], [0.035, -0.02], [0.022, 0.02], [0.0, 0.02]], 12);
    let head = at(&assemble([shade, socket]), [reach, 0.0, elbow + 0.01]);
    assemble([foot, tube(&arms, 0.009, 8), head])
}

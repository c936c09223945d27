//! Jumbled cartons in an open bin, as sensors above see them.

use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    guided::Reach, hands::suction_gripper, motion::Motion, place::ranges, scene::FamilyScene,
};
use crate::{
    exact::ExactMesh,
    random::{between, rotation, small_rotation, within},
    scene::{assemble, cuboid, moved, union_of_boxes},
};

/// Where sensors stand around and above the bin's middle, m.
const PLACES: [[f64; 3]; 6] = [
    [0.0, 0.0, 1.2],
    [-0.5, -0.4, 0.9],
    [0.5, -0.4, 0.9],
    [0.5, 0.4, 0.9],
    [-0.5, 0.4, 0.9],
    [0.2, -0.9, 0.5],
];

/// Cartons and the bin keep this far apart, so that no surface is in another, m.
const RESTING: f64 = 5e-4;

/// A bin with cartons; a suction gripper or one more carton.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let hand = if rng.random() { suction_gripper(rng) } else { carton(rng) };
    with_hand(&hand, seed)
}

/// A bin of 60 to 80 cm × 40 to 60 cm, 25 to 35 cm deep, with 7 to 10 cartons, and any hand, which
/// comes from above, its z axis ahead.
pub(super) fn with_hand(hand: &TriangleMesh, seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed::derive(seed, 101, 0));
    let half = [between(0.3, 0.4, rng), between(0.2, 0.3, rng)];
    let a = filled(half, between(0.25, 0.35, rng), rng);
    let ways = vec![(-Vector3::z(), 0.5)];
    // Within the smallest bin.
    let things = [[-0.28, -0.18, 0.02], [0.28, 0.18, 0.5]];
    let places = PLACES.map(Point3::from);
    FamilyScene::surveyed([&a, hand], &places, [0.03, 0.02], seed, |ends| Motion::Reach {
        reach: Reach { ends, ways, things, from: 0.6 },
        deepest: 0.08,
    })
}

fn carton(rng: &mut ChaCha8Rng) -> TriangleMesh {
    cuboid([between(0.08, 0.14, rng), between(0.1, 0.2, rng), between(0.06, 0.16, rng)])
}

/// The bin on z = 0 with cartons dropped into it one after the other, each left lying as it first
/// met something.
fn filled([w, d]: [f64; 2], height: f64, rng: &mut ChaCha8Rng) -> TriangleMesh {
    let t = 0.015;
    let bin = union_of_boxes(&[
        ranges([-w, w], [-d, d], [0.0, t]),
        ranges([-w, -w + t], [-d, d], [t, height]),
        ranges([w - t, w], [-d, d], [t, height]),
        ranges([-w, w], [-d, -d + t], [t, height]),
        ranges([-w, w], [d - t, d], [t, height]),
    ]);
    let mut content = ExactMesh::new(&bin);
    let wanted = rng.random_range(7..=10);
    let mut cartons = 0;
    for _ in 0..200 {
        let one = ExactMesh::new(&carton(rng));
        // Half of them lie almost flat.
        let turn = if rng.random() { rotation(rng) } else { small_rotation(0.15, rng) };
        let drop = [within(w - 0.1, rng), within(d - 0.1, rng)];
        let Some(place) = lowered(&content, &one, turn, drop, height) else { continue };
        content = ExactMesh::new(&assemble([content.mesh().clone(), moved(one.mesh(), &place)]));
        cartons += 1;
        if cartons == wanted {
            break;
        }
    }
    content.mesh().clone()
}

/// Straight down until it nearly meets something; `None` when that is the rim or above it.
fn lowered(
    content: &ExactMesh,
    carton: &ExactMesh,
    turn: nalgebra::UnitQuaternion<f64>,
    [x, y]: [f64; 2],
    rim: f64,
) -> Option<Pose> {
    let place = |z: f64| {
        let offset = nalgebra::Translation3::new(x, y, z);
        Pose::from_isometry(nalgebra::Isometry3::from_parts(offset, turn))
    };
    let mut z = rim + 0.5;
    loop {
        let gap = content.distance(carton, &place(z));
        if gap < 2.0 * RESTING {
            return (z < rim).then(|| place(z));
        }
        // By less than the gap: it does not get nearer than what keeps them apart.
        z -= gap - RESTING;
    }
}

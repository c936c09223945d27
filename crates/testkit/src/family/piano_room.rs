//! The piano in the room, at about half size, as sensors inside the room see it.

use cloudtouch_geom::{Point3, seed};

use super::{motion::Motion, scene::FamilyScene};
use crate::{random::between, scene};

/// Where sensors stand in the room at full size, m: low and high around the furniture, and raised
/// above the walls, whose tops they see.
const PLACES: [[f64; 3]; 14] = [
    [0.0, 0.0, 1.6],
    [0.0, 0.0, 0.2],
    [-1.0, -0.8, 1.2],
    [1.2, 1.0, 1.2],
    [-2.3, -0.4, 0.3],
    [2.3, 1.4, 0.3],
    [0.4, -1.8, 0.3],
    [-0.4, 1.8, 0.3],
    [2.3, -1.9, 1.5],
    [-2.3, 1.9, 1.5],
    [-1.5, -1.0, 3.0],
    [1.5, -1.0, 3.0],
    [1.5, 1.0, 3.0],
    [-1.5, 1.0, 3.0],
];

/// The room at 38 to 46 %, the piano at 45 to 55 % of full size: ten thousand points are 3.3 to
/// 4 cm apart in the room and 1.6 to 1.9 cm on the piano.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let scale = between(0.38, 0.46, rng);
    let room = scene::room().scaled(scale);
    let piano = scene::piano().scaled(between(0.45, 0.55, rng));
    let places = PLACES.map(|p| Point3::from(p) * scale);
    FamilyScene::surveyed([&room, &piano], &places, [0.06, 0.03], seed, |ends| Motion::Open {
        ends,
        deepest: 0.2,
    })
}

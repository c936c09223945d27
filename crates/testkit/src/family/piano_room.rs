//! The piano in the room, at about half size, as sensors inside the room see it.

use cloudtouch_geom::{Point3, seed};

use super::{
    FamilyScene,
    motion::{Ends, Motion},
    observe::Seen,
    seen::{all_around, seen_from},
};
use crate::{
    exact::{ExactMesh, Touch},
    random::between,
    scene,
};

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
    let room_scale = between(0.38, 0.46, rng);
    let room = ExactMesh::new(&scene::room().scaled(room_scale));
    let piano = ExactMesh::new(&scene::piano().scaled(between(0.45, 0.55, rng)));
    let places = PLACES.map(|p| Point3::from(p) * room_scale);
    let seen_room = seen_from(&room, &places, 0.06);
    let seen_piano = seen_from(&piano, &all_around(&piano), 0.03);
    let ends = Ends::of(&seen_room, &seen_piano, seed);
    FamilyScene {
        a: room,
        b: piano,
        touch: Touch::Solids,
        seen: [
            Seen::Surface(Box::new(ExactMesh::new(&seen_room))),
            Seen::Surface(Box::new(ExactMesh::new(&seen_piano))),
        ],
        motion: Motion::Open { ends, deepest: 0.2 },
    }
}

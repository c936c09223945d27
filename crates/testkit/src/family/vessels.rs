//! Cups, pots, pans, bowls and bottles, each on z = 0; hollow ones have a wall of 5 mm. Handles
//! reach into the wall.

use std::f64::consts::PI;

use cloudtouch_geom::{Point3, TriangleMesh, Vector3};
use rand_chacha::ChaCha8Rng;

use super::place::path;
use crate::{
    random::between,
    scene::{arc, assemble, revolved, rounded, tube},
};

/// How thick a vessel's wall is, m.
const WALL: f64 = 0.005;

/// A vessel and the radius about the z axis that it needs, handles included, m.
pub(super) struct Vessel {
    pub(super) mesh: TriangleMesh,
    pub(super) radius: f64,
}

/// A mug with a round handle.
pub(super) fn mug(rng: &mut ChaCha8Rng) -> Vessel {
    let (r, h) = (between(0.035, 0.048, rng), between(0.08, 0.12, rng));
    let loop_radius = 0.3 * h;
    let middle = Point3::new(r - 0.5 * WALL, 0.0, 0.5 * h);
    let handle = arc(middle, -Vector3::z() * loop_radius, -Vector3::y_axis(), PI, 0.0, 6);
    let mesh = assemble([straight_sided(r, r, h, 16), tube(&handle, 0.006, 6)]);
    Vessel { mesh, radius: r + loop_radius + 0.006 }
}

/// A bowl that widens upward.
pub(super) fn bowl(rng: &mut ChaCha8Rng) -> Vessel {
    let r = between(0.08, 0.14, rng);
    let h = r * between(0.45, 0.65, rng);
    let mesh = revolved(
        &[
            [0.0, 0.0],
            [0.45 * r, 0.0],
            [0.82 * r, 0.35 * h],
            [r, h],
            [r - WALL, h],
            [0.82 * r - WALL, 0.35 * h + 0.5 * WALL],
            [0.45 * r - 0.5 * WALL, WALL],
            [0.0, WALL],
        ],
        18,
    );
    Vessel { mesh, radius: r }
}

/// A full bottle with a neck.
pub(super) fn bottle(rng: &mut ChaCha8Rng) -> Vessel {
    let (r, h) = (between(0.03, 0.042, rng), between(0.22, 0.3, rng));
    let neck = 0.38 * r;
    let profile = [[0.0, 0.0], [r, 0.0], [r, 0.6 * h], [neck, 0.76 * h], [neck, h], [0.0, h]];
    Vessel { mesh: revolved(&profile, 14), radius: r }
}

/// A pot with two handles.
pub(super) fn pot(rng: &mut ChaCha8Rng) -> Vessel {
    let (r, h) = (between(0.1, 0.14, rng), between(0.1, 0.18, rng));
    let handles = [1.0, -1.0].map(|side| {
        let x = |from_wall: f64| side * (r + from_wall);
        let corners = path([
            [x(-0.5 * WALL), -0.04, 0.8 * h],
            [x(0.035), -0.04, 0.85 * h],
            [x(0.035), 0.04, 0.85 * h],
            [x(-0.5 * WALL), 0.04, 0.8 * h],
        ]);
        tube(&rounded(&corners, 0.012), 0.006, 6)
    });
    let mesh = assemble([straight_sided(r, r, h, 20)].into_iter().chain(handles));
    Vessel { mesh, radius: r + 0.045 }
}

/// A pan with a long handle along x.
pub(super) fn pan(rng: &mut ChaCha8Rng) -> Vessel {
    let (r, h) = (between(0.1, 0.14, rng), between(0.04, 0.06, rng));
    let length = between(0.16, 0.2, rng);
    let corners =
        path([[r - 0.5 * WALL, 0.0, 0.7 * h], [r + 0.05, 0.0, h], [r + length, 0.0, h + 0.02]]);
    let mesh = assemble([straight_sided(0.85 * r, r, h, 20), tube(&corners, 0.011, 6)]);
    Vessel { mesh, radius: r + length + 0.01 }
}

/// An open vessel with straight sides, `foot` wide at the bottom and `rim` at the top.
pub(super) fn straight_sided(foot: f64, rim: f64, height: f64, sides: usize) -> TriangleMesh {
    let profile = [
        [0.0, 0.0],
        [foot, 0.0],
        [rim, height],
        [rim - WALL, height],
        [foot - WALL, WALL],
        [0.0, WALL],
    ];
    revolved(&profile, sides)
}

/// A tap with a bent neck toward −y and a lever.
pub(super) fn tap(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (height, reach) = (between(0.22, 0.32, rng), between(0.14, 0.2, rng));
    let base = [[0.0, 0.0], [0.03, 0.0], [0.024, 0.07], [0.0, 0.07]];
    let neck = path([
        [0.0, 0.0, 0.05],
        [0.0, 0.0, height],
        [0.0, -reach, height],
        [0.0, -reach, height - 0.09],
    ]);
    let lever = path([[0.01, 0.0, 0.05], [0.07, 0.0, 0.07], [0.12, 0.0, 0.1]]);
    let neck = tube(&rounded(&neck, 0.04), 0.013, 8);
    assemble([revolved(&base, 12), neck, tube(&lever, 0.007, 6)])
}

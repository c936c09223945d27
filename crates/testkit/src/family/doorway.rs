//! A doorway at the end of a corridor and a mobile robot, about half size.

use cloudtouch_geom::{Point3, TriangleMesh, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    guided::Upright,
    motion::Motion,
    place::{SUNK, at, path, ranges, turned, wheel},
    scene::FamilyScene,
};
use crate::{
    random::{between, within},
    scene::{assemble, revolved, rounded, tube, union_of_boxes},
};

/// Where sensors stand at full size, m: on both sides of the door.
const PLACES: [[f64; 3]; 9] = [
    [-1.2, 0.0, 1.2],
    [-1.9, 0.7, 0.4],
    [-1.9, -0.7, 0.5],
    [-0.5, 0.5, 0.3],
    [1.0, 0.6, 1.2],
    [1.6, -0.8, 0.4],
    [0.5, -0.7, 0.3],
    [-1.0, 0.0, 2.8],
    [1.0, 0.0, 2.8],
];

/// Everything at 48 to 56 % of full size; the robot's clearance is then 3.5 to 6 cm.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let scale = between(0.48, 0.56, rng);
    let a = corridor(rng).scaled(scale);
    let b = if rng.random() { round_robot(rng) } else { square_robot(rng) }.scaled(scale);
    let places = PLACES.map(|p| Point3::from(p) * scale);
    FamilyScene::surveyed([&a, &b], &places, [0.06, 0.03], seed, |ends| {
        Motion::Upright(Upright { ends, lean: 0.0, level: Some([0.035, 0.06]) })
    })
}

/// Floor at z = 0; the corridor along x has walls on both sides and the door's wall across x = 0.
fn corridor(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (half, high) = (between(0.8, 1.0, rng), 2.2);
    // The opening, and its hinge.
    let (hinge, width) = (within(0.15, rng) - 0.45, between(0.85, 1.0, rng));
    let (latch, top) = (hinge + width, 2.0);
    let (frame, out) = (0.07, 0.09);
    let shell = union_of_boxes(&[
        ranges([-2.0, 1.7], [-half - 0.1, half + 0.1], [-0.1, 0.0]),
        ranges([-2.0, 1.7], [-half - 0.1, -half], [0.0, high]),
        ranges([-2.0, 1.7], [half, half + 0.1], [0.0, high]),
        ranges([-0.06, 0.06], [-half, hinge], [0.0, high]),
        ranges([-0.06, 0.06], [latch, half], [0.0, high]),
        ranges([-0.06, 0.06], [hinge, latch], [top, high]),
        // The frame stands out from the wall on both sides.
        ranges([-out, out], [hinge - frame, hinge], [0.0, top + frame]),
        ranges([-out, out], [latch, latch + frame], [0.0, top + frame]),
        ranges([-out, out], [hinge, latch], [top, top + frame]),
    ]);
    let open = between(1.0, 1.8, rng);
    let leaf = turned(&door(width - 0.02), -open, [out + 0.03, hinge + 0.03, 0.01]);
    let bollard = revolved(
        &[[0.0, 0.0], [0.11, 0.0], [0.1, 0.7], [0.08, 0.77], [0.04, 0.81], [0.0, 0.82]],
        20,
    );
    let bollard = at(&bollard, [between(-0.9, -0.6, rng), half - 0.25, -SUNK]);
    let parked = [between(-1.5, -1.3, rng), 0.35 - half, -SUNK];
    assemble([shell, leaf, bollard, turned(&trolley(rng), within(0.2, rng), parked)])
}

/// A leaf in the plane of y and z, its hinge at the origin, with a lever on both sides.
fn door(width: f64) -> TriangleMesh {
    let leaf = union_of_boxes(&[ranges([-0.02, 0.02], [0.0, width], [0.0, 1.97])]);
    let lever = |side: f64| {
        let y = width - 0.07;
        let corners =
            path([[side * 0.015, y, 1.0], [side * 0.07, y, 1.0], [side * 0.07, y - 0.13, 1.0]]);
        tube(&rounded(&corners, 0.025), 0.012, 8)
    };
    assemble([leaf, lever(1.0), lever(-1.0)])
}

/// Two shelves between posts on wheels, a bent handle at the −x end.
fn trolley(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, d) = (between(0.35, 0.45, rng), between(0.2, 0.25, rng));
    let high = between(0.7, 0.85, rng);
    let mut boxes =
        vec![ranges([-w, w], [-d, d], [0.15, 0.18]), ranges([-w, w], [-d, d], [high, high + 0.03])];
    let corners = [[-w, -d], [w - 0.03, -d], [w - 0.03, d - 0.03], [-w, d - 0.03]];
    for [x, y] in corners {
        boxes.push(ranges([x, x + 0.03], [y, y + 0.03], [0.1, high]));
    }
    let handle = path([
        [-w + 0.01, -d + 0.03, high + 0.015],
        [-w - 0.1, -d + 0.03, high + 0.15],
        [-w - 0.1, d - 0.03, high + 0.15],
        [-w + 0.01, d - 0.03, high + 0.015],
    ]);
    let wheels = corners.map(|[x, y]| wheel(0.065, 0.03, 12, [x + 0.015, y + 0.015, 0.065]));
    let bent = tube(&rounded(&handle, 0.05), 0.014, 8);
    assemble([union_of_boxes(&boxes), bent].into_iter().chain(wheels))
}

/// A round base with a bumper, a mast and a head: one profile.
fn round_robot(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (r, base) = (between(0.22, 0.3, rng), between(0.25, 0.4, rng));
    let (mast, top) = (between(0.04, 0.06, rng), between(1.0, 1.4, rng));
    let profile = [
        [0.0, 0.0],
        [r, 0.0],
        [r, 0.04],
        [r + 0.03, 0.05],
        [r + 0.03, 0.12],
        [r, 0.13],
        [r, base],
        [mast, base + 0.03],
        [mast, top - 0.2],
        [0.1, top - 0.17],
        [0.1, top],
        [0.0, top],
    ];
    revolved(&profile, 28)
}

/// A square base with a bumper in front, a mast at its rear, a head and a tray.
fn square_robot(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (l, w) = (between(0.25, 0.35, rng), between(0.2, 0.27, rng));
    let (base, top) = (between(0.25, 0.4, rng), between(1.0, 1.4, rng));
    let tray = between(0.6, 0.8, rng);
    union_of_boxes(&[
        ranges([-l, l], [-w, w], [0.0, base]),
        ranges([l, l + 0.05], [-w - 0.02, w + 0.02], [0.03, 0.12]),
        ranges([-l + 0.02, -l + 0.14], [-0.06, 0.06], [base, top]),
        ranges([-l, -l + 0.2], [-0.15, 0.15], [top, top + 0.1]),
        ranges([-l + 0.14, 0.8 * l], [-0.8 * w, 0.8 * w], [tray, tray + 0.03]),
    ])
}

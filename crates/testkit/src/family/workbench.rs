//! A workbench with round and bent things, as sensors above and before it see it.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use cloudtouch_geom::{Point3, TriangleMesh, Vector3, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    guided::Reach,
    motion::Motion,
    place::{SUNK, at, path, placed, ranges, turned, upright},
    scene::FamilyScene,
    tools::{bent_bar, drill},
};
use crate::{
    random::{between, within},
    scene::{arc, assemble, cylinder, rounded, torus, tube, union_of_boxes},
};

/// Where sensors stand, m; the bench's top is at z = 0, its front at −y.
const PLACES: [[f64; 3]; 8] = [
    [0.0, -1.0, 0.7],
    [-1.0, -0.7, 0.5],
    [1.0, -0.7, 0.5],
    [-0.4, 0.0, 1.2],
    [0.4, -0.1, 1.2],
    [-1.3, 0.1, 0.5],
    [1.3, 0.1, 0.5],
    [0.0, -1.3, -0.3],
];

/// The bench in full size, and a drill or a bent bar that comes from above or from the front.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let a = bench(rng);
    let b = if rng.random() { drill(rng) } else { bent_bar(rng) };
    let ways = vec![(-Vector3::z(), 1.0), (Vector3::y(), 0.8)];
    // Above the top, before the panel.
    let things = [[-0.9, -0.35, 0.003], [0.9, 0.315, 0.6]];
    FamilyScene::surveyed([&a, &b], &PLACES.map(Point3::from), [0.04, 0.02], seed, |ends| {
        Motion::Reach { reach: Reach { ends, ways, things, from: 0.7 }, deepest: 0.1 }
    })
}

/// Top at z = 0 on legs, a panel with hooks behind; vice on the left, pipes in the middle, springs
/// and rings on the right.
fn bench(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, d) = (between(0.75, 0.9, rng), 0.35);
    let leg = |x: f64, y: f64| ranges([x, x + 0.08], [y, y + 0.08], [-0.8, -0.06]);
    let mut parts = vec![
        union_of_boxes(&[
            ranges([-w, w], [-d, d], [-0.06, 0.0]),
            leg(-w, -d),
            leg(w - 0.08, -d),
            leg(-w, d - 0.08),
            leg(w - 0.08, d - 0.08),
            // The panel stands on the bench.
            ranges([-w, w], [d - 0.03, d], [0.0, 0.7]),
        ]),
        turned(&vice(rng), within(0.3, rng), [-w + 0.25, -0.15, -SUNK]),
    ];
    let panel = d - 0.03;
    for k in 0..4 {
        let x = w * (0.5 * f64::from(k) - 0.75) + within(0.06, rng);
        parts.push(at(&hook(rng), [x, panel + 0.005, between(0.35, 0.55, rng)]));
    }
    // A ring hangs at the panel.
    let (major, minor) = (between(0.08, 0.11, rng), between(0.012, 0.02, rng));
    let place = [within(0.1, rng), panel - minor + SUNK, 0.25];
    parts.push(placed(&torus(major, minor, 14), place, [FRAC_PI_2, 0.0, 0.0]));
    // Two pipes and an elbow lie on the bench.
    let mut y = -0.22;
    for _ in 0..2 {
        let (r, length) = (between(0.02, 0.035, rng), between(0.35, 0.5, rng));
        let place = [0.1 + within(0.03, rng), y, r - SUNK];
        parts.push(placed(&cylinder(r, length, 14), place, [FRAC_PI_2, 0.0, FRAC_PI_2]));
        y += 0.1;
    }
    parts.push(turned(&elbow(rng), within(0.4, rng), [0.05, 0.1, 0.0]));
    parts.push(turned(&spring(rng), within(PI, rng), [w - 0.3, 0.12, 0.0]));
    let (major, minor) = (between(0.06, 0.09, rng), between(0.015, 0.025, rng));
    parts.push(at(&torus(major, minor, 14), [w - 0.2, -0.18, minor - SUNK]));
    assemble(parts)
}

/// A body with jaws along x, the screw through them, and its bar.
fn vice(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (open, h) = (between(0.03, 0.08, rng), between(0.1, 0.14, rng));
    let body = union_of_boxes(&[
        ranges([-0.1, 0.12], [-0.06, 0.06], [0.0, 0.02]),
        ranges([0.0, 0.12], [-0.03, 0.03], [0.02, 0.6 * h]),
        ranges([0.0, 0.05], [-0.06, 0.06], [0.6 * h, h]),
        ranges([-open - 0.04, -open], [-0.06, 0.06], [0.6 * h, h]),
        ranges([-open - 0.04, -open], [-0.03, 0.03], [0.03, 0.6 * h]),
    ]);
    let screw = path([[0.02, 0.0, 0.5 * h], [-open - 0.14, 0.0, 0.5 * h]]);
    let x = -open - 0.125;
    let bar = path([[x, -0.03, 0.5 * h - 0.05], [x, 0.04, 0.5 * h + 0.067]]);
    assemble([body, tube(&screw, 0.014, 10), tube(&bar, 0.007, 6)])
}

/// Out of a wall at y = 0 toward −y, down a little and up again.
fn hook(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let reach = between(0.05, 0.09, rng);
    let down = arc(
        Point3::new(0.0, -reach, -0.03),
        Vector3::z() * 0.03,
        Vector3::x_axis(),
        1.2 * PI,
        0.0,
        7,
    );
    let path: Vec<Point3> = std::iter::once(Point3::origin()).chain(down).collect();
    tube(&path, 0.008, 6)
}

/// A pipe with one bend, lying on z = 0, with a thicker collar at each end.
fn elbow(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let r = between(0.02, 0.03, rng);
    let [long, short] = [between(0.16, 0.24, rng), between(0.1, 0.14, rng)];
    let z = 1.25 * r - SUNK;
    let corners = path([[-long, 0.0, z], [0.0, 0.0, z], [0.0, short, z]]);
    let collar = upright(1.25 * r, 0.03, 14);
    let ends = [
        placed(&collar, [-long - 0.005, 0.0, z], [0.0, FRAC_PI_2, 0.0]),
        placed(&collar, [0.0, short + 0.005, z], [FRAC_PI_2, 0.0, 0.0]),
    ];
    assemble([tube(&rounded(&corners, 0.06), r, 14)].into_iter().chain(ends))
}

/// A spring standing on z = 0.
fn spring(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (r, wire) = (between(0.035, 0.05, rng), between(0.006, 0.009, rng));
    let start = Point3::new(0.0, 0.0, wire - SUNK);
    let coil = arc(start, Vector3::x() * r, Vector3::z_axis(), 2.5 * TAU, 0.12, 30);
    tube(&coil, wire, 6)
}

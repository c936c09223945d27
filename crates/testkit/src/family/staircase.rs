//! A staircase with rail and wall, smaller than in life, and what is carried up there.

use cloudtouch_geom::{Point3, TriangleMesh, Vector3, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    guided::Upright,
    motion::Motion,
    place::{GAP, SUNK, at, ranges, upright, wheel},
    scene::FamilyScene,
};
use crate::{
    random::between,
    scene::{assemble, cuboid, rounded, tube, union_of_boxes},
};

/// The steps.
struct Flight {
    steps: usize,
    tread: f64,
    rise: f64,
    width: f64,
}

/// Everything at 60 to 80 % of full size.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let scale = between(0.6, 0.8, rng);
    let flight = Flight {
        steps: rng.random_range(5..=7),
        tread: between(0.26, 0.3, rng),
        rise: between(0.16, 0.19, rng),
        width: between(0.9, 1.1, rng),
    };
    let a = staircase(&flight).scaled(scale);
    let b = if rng.random() {
        cuboid([between(0.4, 0.6, rng), between(0.25, 0.4, rng), between(0.2, 0.4, rng)])
    } else {
        wheelchair(rng)
    }
    .scaled(scale);
    let places = places(&flight).map(|p| Point3::from(p) * scale);
    FamilyScene::surveyed([&a, &b], &places, [0.06, 0.03], seed, |ends| {
        Motion::Upright(Upright { ends, lean: 0.3, level: None })
    })
}

/// Where sensors stand at full size, m: at the foot, on the way, on the landing, beside the rail.
fn places(flight: &Flight) -> [[f64; 3]; 8] {
    let (length, top) = (flight.length(), flight.height());
    let middle = 0.5 * flight.width;
    [
        [-0.8, middle, 1.3],
        [-0.8, 0.2, 0.4],
        [0.3 * length, middle, 0.3 * top + 1.3],
        [0.7 * length, middle, 0.7 * top + 1.3],
        [length + 0.7, middle, top + 1.0],
        [length + 0.7, 0.3, top + 0.3],
        [0.3 * length, -1.2, 0.8],
        [0.9 * length, -1.2, top + 0.6],
    ]
}

impl Flight {
    fn length(&self) -> f64 {
        self.steps as f64 * self.tread
    }

    fn height(&self) -> f64 {
        self.steps as f64 * self.rise
    }
}

/// Up along x from the floor at z = 0 to a landing; the wall on the +y side, the rail on the other.
fn staircase(flight: &Flight) -> TriangleMesh {
    let Flight { steps, tread, rise, width } = *flight;
    let (length, top) = (flight.length(), flight.height());
    let end = length + 0.8;
    let mut boxes = vec![
        ranges([-0.9, end], [-0.1, width + 0.1], [-0.1, 0.0]),
        ranges([-0.9, end], [width, width + 0.1], [0.0, top + 1.1]),
    ];
    for i in 0..steps {
        let (from, z) = (i as f64 * tread, (i + 1) as f64 * rise);
        boxes.push(ranges([from, end], [0.0, width], [0.0, z]));
    }
    let mut parts = vec![union_of_boxes(&boxes)];
    let (y, rail) = (0.07, 0.9);
    // Parallel to the flight over the front half of a step, level at its ends.
    let over = |x: f64| Point3::new(x, y, rise * (1.0 + x / tread).min(steps as f64) + rail);
    let (start, turn) = (over(-0.5 * tread), over(length - tread));
    // A post in the middle of every other step and two on the landing, up into the rail.
    let mut stand = |x: f64, z: f64| {
        parts.push(at(&upright(0.02, over(x).z - z + SUNK, 8), [x, y, z - SUNK]));
    };
    for i in (0..steps).step_by(2) {
        stand((i as f64 + 0.5) * tread, (i + 1) as f64 * rise);
    }
    for x in [length + 0.1, end - 0.1] {
        stand(x, top);
    }
    let corners = [start - Vector3::x() * 0.3, start, turn, over(end - 0.02)];
    parts.push(tube(&rounded(&corners, 0.08), 0.03, 12));
    assemble(parts)
}

/// A seat with back and arm rests between two large wheels, castors in front, along x.
fn wheelchair(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, d) = (between(0.2, 0.24, rng), between(0.2, 0.24, rng));
    let (seat, back) = (between(0.45, 0.5, rng), between(0.85, 0.95, rng));
    let frame = union_of_boxes(&[
        ranges([-d, d], [-w, w], [seat - 0.05, seat]),
        ranges([-d, -d + 0.04], [-w, w], [seat, back]),
        ranges([-d - 0.1, -d], [-w, -w + 0.04], [back - 0.05, back]),
        ranges([-d - 0.1, -d], [w - 0.04, w], [back - 0.05, back]),
        ranges([-d, d - 0.05], [-w, -w + 0.04], [seat + 0.18, seat + 0.21]),
        ranges([-d, d - 0.05], [w - 0.04, w], [seat + 0.18, seat + 0.21]),
        ranges([d - 0.09, d - 0.05], [-w, -w + 0.04], [seat, seat + 0.18]),
        ranges([d - 0.09, d - 0.05], [w - 0.04, w], [seat, seat + 0.18]),
        ranges([d - 0.04, d], [-0.03, 0.03], [0.1, seat - 0.05]),
        ranges([d, d + 0.15], [-0.12, 0.12], [0.1, 0.13]),
    ]);
    let large = between(0.26, 0.3, rng);
    let wheels = [-1.0, 1.0].into_iter().flat_map(|side| {
        let beside = side * (w + 0.02 + GAP);
        [
            wheel(large, 0.04, 24, [-0.08, beside, large]),
            wheel(0.07, 0.03, 12, [d - 0.08, side * (w - 0.06), 0.07]),
        ]
    });
    assemble([frame].into_iter().chain(wheels))
}

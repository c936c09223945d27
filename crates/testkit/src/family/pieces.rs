//! Tables, shelves, chairs and racks of random sizes, each on z = 0; parts that are not of one
//! surface keep apart.

use std::f64::consts::FRAC_PI_2;

use cloudtouch_geom::TriangleMesh;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::place::{GAP, at, placed, ranges, upright};
use crate::{
    random::between,
    scene::{assemble, cylinder, union_of_boxes},
};

/// A table top on square legs, or on round ones.
pub(super) fn table(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let [w, d] = [between(0.35, 0.6, rng), between(0.25, 0.45, rng)];
    let (height, thickness) = (between(0.4, 0.9, rng), between(0.02, 0.06, rng));
    let leg = between(0.02, 0.05, rng);
    let mut boxes = vec![ranges([-w, w], [-d, d], [height - thickness, height])];
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[x, y]| [x * (w - 1.5 * leg), y * (d - 1.5 * leg)]);
    if rng.random() {
        boxes.extend(corners.map(|[x, y]| {
            ranges([x - leg, x + leg], [y - leg, y + leg], [0.0, height - thickness])
        }));
        return union_of_boxes(&boxes);
    }
    let round = upright(leg, height - thickness - GAP, 12);
    let legs = corners.map(|[x, y]| at(&round, [x, y, 0.0]));
    assemble(std::iter::once(union_of_boxes(&boxes)).chain(legs))
}

/// Boards between two sides, some with a back.
pub(super) fn shelf(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, d) = (between(0.3, 0.6, rng), between(0.12, 0.2, rng));
    let (height, t) = (between(0.8, 1.6, rng), between(0.02, 0.05, rng));
    let mut boxes = vec![
        ranges([-w, -w + t], [-d, d], [0.0, height]),
        ranges([w - t, w], [-d, d], [0.0, height]),
    ];
    let boards = rng.random_range(2..=4);
    for i in 0..=boards {
        let z = (height - t) * f64::from(i) / f64::from(boards);
        boxes.push(ranges([-w + t, w - t], [-d, d], [z, z + t]));
    }
    if rng.random() {
        boxes.push(ranges([-w, w], [d, d + 0.02], [0.0, height]));
    }
    union_of_boxes(&boxes)
}

/// A seat with four legs and a back of two posts and two bars.
pub(super) fn chair(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, leg) = (between(0.2, 0.3, rng), between(0.03, 0.05, rng));
    let (seat, top) = (between(0.35, 0.5, rng), between(0.8, 1.1, rng));
    let [low, high] = [[-w, -w + leg], [w - leg, w]];
    let mut boxes = vec![ranges([-w, w], [-w, w], [seat - 0.04, seat])];
    boxes.extend([[low, low], [high, low]].map(|[x, y]| ranges(x, y, [0.0, seat - 0.04])));
    boxes.extend([[low, high], [high, high]].map(|[x, y]| ranges(x, y, [0.0, top])));
    for z in [0.6 * top + 0.4 * seat, top - 0.08] {
        boxes.push(ranges([-w, w], [w - 0.5 * leg, w], [z, z + 0.08]));
    }
    union_of_boxes(&boxes)
}

/// Round posts on a foot, with bars between them and one that leans across in front.
pub(super) fn rack(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, height) = (between(0.3, 0.6, rng), between(0.8, 1.6, rng));
    let (post, bar) = (between(0.03, 0.06, rng), between(0.015, 0.03, rng));
    let mut parts = vec![union_of_boxes(&[ranges([-w, w], [-0.15, 0.15], [0.0, 0.04])])];
    let round = upright(post, height, 12);
    parts.extend([-w + post, w - post].map(|x| at(&round, [x, 0.0, 0.04 + GAP])));
    // Along x: a quarter turn about y.
    let level = cylinder(bar, 2.0 * (w - 2.0 * post - GAP), 8);
    let bars = rng.random_range(2..=4);
    for i in 1..=bars {
        let z = 0.04 + height * f64::from(i) / f64::from(bars + 1);
        parts.push(placed(&level, [0.0, 0.0, z], [0.0, FRAC_PI_2, 0.0]));
    }
    let leaning = between(-0.6, 0.6, rng);
    let in_front = [0.0, -post - bar - GAP, 0.04 + 0.5 * height];
    parts.push(placed(&cylinder(bar, 0.8 * height, 8), in_front, [0.0, leaning, 0.0]));
    assemble(parts)
}

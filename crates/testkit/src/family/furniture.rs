//! Rows of random furniture: large bodies with thin parts, coarsely sampled.

use cloudtouch_geom::{Pose, TriangleMesh, Vector3, seed};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{
    FamilyScene,
    motion::{Ends, Motion},
    observe::Seen,
    seen::{all_around, seen_from},
};
use crate::{
    exact::{ExactMesh, Touch},
    random::between,
    scene::{assemble, cylinder, moved, union_of_boxes},
};

/// Two rows of three or four pieces, up to 4 m long and a metre apart, and one of two.
pub(super) fn scene(seed: u64) -> FamilyScene {
    let rng = &mut seed::generator(seed);
    let [near, far] = [0; 2].map(|_| row(rng.random_range(3..=4), rng));
    let across = Pose::from_translation(Vector3::y() * between(1.2, 1.6, rng));
    let a = ExactMesh::new(&assemble([near, moved(&far, &across)]));
    let b = ExactMesh::new(&row(2, rng));
    let [seen_a, seen_b] = [&a, &b].map(|body| seen_from(body, &all_around(body), 0.1));
    let ends = Ends::of(&seen_a, &seen_b, seed);
    FamilyScene {
        a,
        b,
        touch: Touch::Solids,
        seen: [
            Seen::Surface(Box::new(ExactMesh::new(&seen_a))),
            Seen::Surface(Box::new(ExactMesh::new(&seen_b))),
        ],
        motion: Motion::Open { ends, deepest: 0.2 },
    }
}

/// Pieces side by side along x, each on z = 0 and closed, standing apart or touching.
fn row(pieces: usize, rng: &mut ChaCha8Rng) -> TriangleMesh {
    let mut end = 0.0;
    let parts: Vec<TriangleMesh> = (0..pieces)
        .map(|_| {
            let piece = match rng.random_range(0..4) {
                0 => table(rng),
                1 => shelf(rng),
                2 => chair(rng),
                _ => rack(rng),
            };
            let (low, high) = piece.bounding_box().expect("a mesh has vertices");
            let offset = Vector3::new(end - low.x, between(-0.2, 0.2, rng), 0.0);
            end += high.x - low.x + between(0.02, 0.15, rng);
            moved(&piece, &Pose::from_translation(offset))
        })
        .collect();
    assemble(parts)
}

/// A box by its ranges along x, y and z.
fn ranges(x: [f64; 2], y: [f64; 2], z: [f64; 2]) -> [[f64; 3]; 2] {
    [0, 1].map(|end| [x[end], y[end], z[end]])
}

/// A table top on square legs, or on round ones that reach into it.
fn table(rng: &mut ChaCha8Rng) -> TriangleMesh {
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
    let length = height - 0.5 * thickness;
    let legs = corners.map(|[x, y]| {
        let place = Pose::from_translation(Vector3::new(x, y, 0.5 * length));
        moved(&cylinder(leg, length, 12), &place)
    });
    assemble(std::iter::once(union_of_boxes(&boxes)).chain(legs))
}

/// Boards between two sides, some with a back.
fn shelf(rng: &mut ChaCha8Rng) -> TriangleMesh {
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
fn chair(rng: &mut ChaCha8Rng) -> TriangleMesh {
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

/// Round posts on a foot, with bars between them and one that leans across.
fn rack(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, height) = (between(0.3, 0.6, rng), between(0.8, 1.6, rng));
    let (post, bar) = (between(0.03, 0.06, rng), between(0.015, 0.03, rng));
    let mut parts = vec![union_of_boxes(&[ranges([-w, w], [-0.15, 0.15], [0.0, 0.04])])];
    for x in [-w + post, w - post] {
        // It starts within the foot.
        let place = Pose::from_translation(Vector3::new(x, 0.0, 0.02 + 0.5 * height));
        parts.push(moved(&cylinder(post, height, 12), &place));
    }
    // Along x: a quarter turn about y.
    let span = 2.0 * (w - post);
    let bars = rng.random_range(2..=4);
    for i in 1..=bars {
        let z = height * f64::from(i) / f64::from(bars + 1);
        let quarter = std::f64::consts::FRAC_PI_2;
        let place = Pose::from_translation_rpy(Vector3::z() * z, [0.0, quarter, 0.0]);
        parts.push(moved(&cylinder(bar, span, 8), &place));
    }
    let leaning = between(-0.6, 0.6, rng);
    let place = Pose::from_translation_rpy(Vector3::z() * 0.5 * height, [0.0, leaning, 0.0]);
    parts.push(moved(&cylinder(bar, 0.8 * height, 8), &place));
    assemble(parts)
}

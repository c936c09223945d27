//! What stands in a living room, each on z = 0 at full size; parts may reach into one another.

use cloudtouch_geom::{TriangleMesh, Vector3};
use rand_chacha::ChaCha8Rng;

use super::place::{at, path, ranges, turned};
use crate::{
    random::{between, direction, within},
    scene::{assemble, revolved, revolved_ring, sphere, tube, union_of_boxes},
};

/// A seat of this width between arms, its back on the +y side: a sofa or an armchair.
pub(super) fn upholstered(width: f64, rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (w, d) = (0.5 * width, between(0.38, 0.45, rng));
    let (arm, seat) = (between(0.12, 0.2, rng), between(0.38, 0.46, rng));
    let (arms, back) = (seat + between(0.12, 0.2, rng), between(0.75, 0.9, rng));
    let mut boxes = vec![
        ranges([-w, w], [-d, d], [0.08, seat]),
        ranges([-w, -w + arm], [-d, d], [seat, arms]),
        ranges([w - arm, w], [-d, d], [seat, arms]),
        ranges([-w, w], [d - 0.22, d], [seat, back]),
    ];
    for [x, y] in [[-w, -d], [w - 0.06, -d], [w - 0.06, d - 0.06], [-w, d - 0.06]] {
        boxes.push(ranges([x, x + 0.06], [y, y + 0.06], [0.0, 0.08]));
    }
    union_of_boxes(&boxes)
}

/// A foot, a pole, and an open shade on a crossbar.
pub(super) fn floor_lamp(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (top, wide) = (between(1.4, 1.7, rng), between(0.18, 0.24, rng));
    let bottom = top - between(0.22, 0.3, rng);
    let foot = [
        [0.0, 0.0],
        [0.16, 0.0],
        [0.15, 0.03],
        [0.018, 0.05],
        [0.018, top - 0.08],
        [0.0, top - 0.08],
    ];
    let shade =
        [[wide - 0.01, bottom], [wide, bottom], [0.7 * wide, top], [0.7 * wide - 0.01, top]];
    let bar = path([[-0.74 * wide, 0.0, top - 0.1], [0.74 * wide, 0.0, top - 0.1]]);
    assemble([revolved(&foot, 12), revolved_ring(&shade, 16), tube(&bar, 0.01, 6)])
}

/// A round table on a pedestal.
pub(super) fn round_table(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (r, h) = (between(0.35, 0.45, rng), between(0.4, 0.5, rng));
    let profile = [
        [0.0, 0.0],
        [0.22, 0.0],
        [0.2, 0.03],
        [0.04, 0.06],
        [0.04, h - 0.04],
        [r, h - 0.03],
        [r, h],
        [0.0, h],
    ];
    revolved(&profile, 16)
}

/// A pot with earth, a stem and leaves in clumps.
pub(super) fn plant(rng: &mut ChaCha8Rng) -> TriangleMesh {
    let (h, top) = (between(0.25, 0.35, rng), between(0.8, 1.2, rng));
    let pot = [[0.0, 0.0], [0.12, 0.0], [0.16, h], [0.145, h], [0.14, h - 0.05], [0.0, h - 0.05]];
    let stem = path([[0.0, 0.0, h - 0.07], [0.02, 0.01, 0.6 * top], [0.0, 0.0, top]]);
    let mut parts = vec![revolved(&pot, 12), tube(&stem, 0.015, 6)];
    for _ in 0..4 {
        let offset = direction(rng) * between(0.05, 0.16, rng) + Vector3::z() * top;
        let clump = sphere(between(0.1, 0.16, rng), 1);
        parts.push(at(&clump, offset.into()));
    }
    assemble(parts)
}

/// Books lying on one another, each a little turned aside.
pub(super) fn books(count: usize, rng: &mut ChaCha8Rng) -> TriangleMesh {
    let mut z = 0.0;
    assemble((0..count).map(|_| {
        let (thickness, half) =
            (between(0.015, 0.04, rng), [between(0.07, 0.1, rng), between(0.1, 0.13, rng)]);
        let book =
            union_of_boxes(&[ranges([-half[0], half[0]], [-half[1], half[1]], [z, z + thickness])]);
        // Not coplanar with the next.
        z += thickness + 1e-4;
        turned(&book, within(0.2, rng), [0.0; 3])
    }))
}

//! Tables and chairs from boxes with thickness, standing on z = 0, parts 5 mm apart.

use cloudtouch_geom::{Pose, TriangleMesh, Vector3};

use super::assemble::{assemble, block, moved};

/// A table centred on (x, y): sides `size`, height `height`, top of the given thickness.
pub(super) fn table(at: [f64; 2], size: [f64; 2], height: f64, thickness: f64) -> TriangleMesh {
    let [w, d] = size.map(|s| 0.5 * s);
    let under = height - thickness;
    let mut parts = vec![block([-w, -d, under], [w, d, height])];
    parts.extend(legs([w - 0.06, d - 0.06], 0.03, under - 0.005));
    placed(parts, at)
}

/// A chair centred on (x, y), 45 cm to the seat, its back on the +y side, or on −y if `turned`.
pub(super) fn chair(at: [f64; 2], turned: bool) -> TriangleMesh {
    let mut parts = vec![block([-0.21, -0.21, 0.43], [0.21, 0.21, 0.45])];
    let [front, rear] = if turned { [-0.21, -0.18] } else { [0.18, 0.21] };
    parts.push(block([-0.21, front, 0.455], [0.21, rear, 0.90]));
    parts.extend(legs([0.18, 0.18], 0.02, 0.425));
    placed(parts, at)
}

/// Four square legs at (±x, ±y) of the given half width, 5 mm above the floor.
fn legs([x, y]: [f64; 2], half: f64, top: f64) -> impl Iterator<Item = TriangleMesh> {
    [[-x, -y], [x, -y], [x, y], [-x, y]]
        .into_iter()
        .map(move |[x, y]| block([x - half, y - half, 0.005], [x + half, y + half, top]))
}

fn placed(parts: Vec<TriangleMesh>, [x, y]: [f64; 2]) -> TriangleMesh {
    moved(&assemble(parts), &Pose::from_translation(Vector3::new(x, y, 0.0)))
}

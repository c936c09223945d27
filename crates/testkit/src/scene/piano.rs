//! A grand piano of our own design.

use cloudtouch_geom::{Point3, TriangleMesh};

use super::assemble::{assemble, block, mesh, prism};

/// A grand piano, 1.5 m wide, 1.85 m long, lid half open: thirteen closed components.
///
/// Frame: z up from the floor it stands on, y away from the player, x to the player's right
/// (treble), origin below the middle of its 1.5 m × 1.85 m footprint. About 300 triangles, some
/// long; use [`subdivide_to_max_edge`](super::subdivide_to_max_edge) with 0.13 m for 10k.
pub fn piano() -> TriangleMesh {
    let outline = body_outline();
    let lid = opened(&prism(&outline, LID_HEIGHT, LID_HEIGHT + 0.025));
    let mut parts = vec![
        prism(&outline, 0.70, 0.98),
        lid,
        // The ledge, the keys on it, and the cheeks beside them.
        block([-0.75, -0.925, 0.70], [0.75, -0.63, 0.76]),
        block([-0.65, -0.875, 0.765], [0.65, -0.675, 0.785]),
        block([-0.75, -0.925, 0.765], [-0.66, -0.63, 0.93]),
        block([0.66, -0.925, 0.765], [0.75, -0.63, 0.93]),
        // The lyre with its pedal box, the music stand, and the prop of the lid.
        block([-0.08, -0.55, 0.17], [0.08, -0.50, 0.695]),
        block([-0.15, -0.65, 0.08], [0.15, -0.50, 0.165]),
        block([-0.05, -0.45, 0.985], [0.55, -0.43, 1.20]),
        block([0.60, -0.30, 0.985], [0.62, -0.28, 1.495]),
    ];
    for [x, y] in [[-0.65, -0.55], [0.65, -0.55], [-0.45, 0.70]] {
        parts.push(leg([x, y]));
    }
    assemble(parts)
}

/// Where the closed lid lies: 5 mm above the body.
const LID_HEIGHT: f64 = 0.985;

/// The body from above, anticlockwise: straight spine on the left, an S-shaped bent side.
fn body_outline() -> Vec<[f64; 2]> {
    let mut outline = vec![[-0.75, -0.625], [0.75, -0.625]];
    for controls in [
        [[0.75, -0.175], [0.75, 0.325], [0.10, 0.175], [-0.05, 0.625]],
        [[-0.05, 0.625], [-0.12, 0.835], [-0.25, 0.925], [-0.45, 0.925]],
        [[-0.45, 0.925], [-0.65, 0.925], [-0.75, 0.875], [-0.75, 0.695]],
    ] {
        // The end of one curve is the start of the next.
        outline.extend((0..6).map(|i| bezier(&controls, f64::from(i) / 6.0)));
    }
    outline.push([-0.75, 0.695]);
    outline
}

/// A point of a cubic Bézier curve: only sums and products, so the same on every platform.
fn bezier(controls: &[[f64; 2]; 4], t: f64) -> [f64; 2] {
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    [0, 1].map(|axis| (0..4).map(|k| weights[k] * controls[k][axis]).sum())
}

/// The lid turned up about its hinge at the spine, by the angle of the 5-12-13 triangle (22.6°).
fn opened(lid: &TriangleMesh) -> TriangleMesh {
    let (sin, cos) = (5.0 / 13.0, 12.0 / 13.0);
    let vertices = lid.vertices().iter().map(|p| {
        let (x, z) = (p.x + 0.75, p.z - LID_HEIGHT);
        Point3::new(cos * x - sin * z - 0.75, p.y, sin * x + cos * z + LID_HEIGHT)
    });
    mesh(vertices.collect(), lid.triangles().to_vec())
}

/// A leg that tapers toward the floor.
fn leg([x, y]: [f64; 2]) -> TriangleMesh {
    let straight = block([-1.0, -1.0, 0.0], [1.0, 1.0, 0.695]);
    let vertices = straight.vertices().iter().map(|p| {
        let half = if p.z > 0.0 { 0.07 } else { 0.04 };
        Point3::new(x + half * p.x, y + half * p.y, p.z)
    });
    mesh(vertices.collect(), straight.triangles().to_vec())
}

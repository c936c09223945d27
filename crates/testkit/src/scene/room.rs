//! A furnished room of our own design.

use cloudtouch_geom::{Point3, TriangleMesh};

use super::{
    assemble::{assemble, block, mesh, prism},
    furniture::{chair, table},
};

/// A room of 5 m × 4 m × 2.5 m with a door, two tables, five chairs and a shelf; no ceiling.
///
/// Frame: z up from the floor, origin in the middle of the floor, x along the long side. Walls
/// and floor are slabs 10 cm thick whose inner faces are at x = ±2.505, y = ±2.005 and z = 0. The
/// second table's top is 2 cm thin. Around 570 triangles, some metres long; use
/// [`subdivide_to_max_edge`](super::subdivide_to_max_edge) with 0.42 m for about 10k.
pub fn room() -> TriangleMesh {
    assemble([
        block([-2.5, -2.0, -0.1], [2.5, 2.0, 0.0]),
        block([-2.605, -2.0, -0.1], [-2.505, 2.0, 2.5]),
        block([2.505, -2.0, -0.1], [2.605, 2.0, 2.5]),
        block([-2.605, 2.005, -0.1], [2.605, 2.105, 2.5]),
        wall_with_door(),
        table([-1.65, 1.2], [1.4, 0.9], 0.75, 0.04),
        chair([-2.0, 0.55], true),
        chair([-1.3, 0.55], true),
        table([1.8, -0.8], [0.8, 1.2], 0.72, 0.02),
        chair([1.8, 0.1], false),
        chair([1.8, -1.7], true),
        chair([-2.1, -1.5], true),
        block([0.6, 1.65, 0.005], [2.0, 2.0, 1.1]),
    ])
}

/// The wall on the −y side, open for a door of 0.9 m × 2.05 m.
fn wall_with_door() -> TriangleMesh {
    let outline = [
        [-2.605, -0.1],
        [0.8, -0.1],
        [0.8, 2.05],
        [1.7, 2.05],
        [1.7, -0.1],
        [2.605, -0.1],
        [2.605, 2.5],
        [-2.605, 2.5],
    ];
    let flat = prism(&outline, 2.005, 2.105);
    // A quarter turn about x stands the outline up: (x, y, z) becomes (x, −z, y).
    let vertices = flat.vertices().iter().map(|p| Point3::new(p.x, -p.z, p.y)).collect();
    mesh(vertices, flat.triangles().to_vec())
}

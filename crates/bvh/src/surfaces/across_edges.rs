//! Whether two boxes are apart across an edge of each, where the normals of their faces leave it open.

use crate::surfaces::placed::{Array, Placed};
use crate::tree::node::NodeData;

/// Whether the boxes of the surfaces are apart along one of the nine directions across an edge of
/// each; `rounding` is what the pose may misplace a box by, m.
pub(crate) fn edges_part_surfaces(a: &NodeData, b: Placed<'_>, rounding: f64) -> bool {
    let dot = |p: &Array, q: &Array| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let axes: [Array; 3] = a.obb.axes.into();
    let r = axes.map(|of_a| b.axes.map(|of_b| dot(&of_b, &of_a)));
    let way = [0, 1, 2].map(|k| b.centre[k] - a.obb.centre[k]);
    let t = axes.map(|axis| dot(&way, &axis));
    let [half_a, half_b] = [a, b.node].map(|node| node.obb.half_extents());
    let [bounds_a, bounds_b] = [a, b.node].map(|node| node.bounds.unpacked());
    let size = half_a.sum() + half_b.sum() + (t[0].abs() + t[1].abs() + t[2].abs());
    let slack = bounds_a.shift + bounds_b.shift + rounding + 8.0 * f64::EPSILON * size;
    let (half_a, half_b) = (half_a + bounds_a.axis_reach, half_b + bounds_b.axis_reach);
    for i in 0..3 {
        let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
        for j in 0..3 {
            let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
            // eᵢ × rⱼ has the components −r[i2] at i1 and r[i1] at i2.
            let squared_sine = r[i1][j] * r[i1][j] + r[i2][j] * r[i2][j];
            let distance = (t[i2] * r[i1][j] - t[i1] * r[i2][j]).abs();
            let reach = half_a[i1] * r[i2][j].abs()
                + half_a[i2] * r[i1][j].abs()
                + half_b[j1] * r[i][j2].abs()
                + half_b[j2] * r[i][j1].abs();
            // The direction is as long as the sine, at most one: the slack counts for more.
            if squared_sine >= PARALLEL && distance - reach >= slack {
                return true;
            }
        }
    }
    false
}

/// Below this sine² two edges count as parallel: their cross product is mostly rounding. Leaving a
/// direction out can only make boxes overlap, which is the safe side.
const PARALLEL: f64 = 1e-12;

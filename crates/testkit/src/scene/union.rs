//! The union of boxes as one watertight surface.

use std::collections::BTreeMap;

use cloudtouch_geom::{Point3, TriangleMesh};

use super::assemble::mesh;

/// The closed surface of the union of boxes given by their lowest and highest corners, in triangles
/// of the grid that all their faces span; what is inside of another box or between two that touch
/// is not part of it.
///
/// # Panics
/// When no box has a volume.
pub fn union_of_boxes(boxes: &[[[f64; 3]; 2]]) -> TriangleMesh {
    let planes: [Vec<f64>; 3] = std::array::from_fn(|k| {
        let mut all: Vec<f64> = boxes.iter().flatten().map(|corner| corner[k]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    });
    // A cell is named by its lowest corner in the grid.
    let filled = |cell: [usize; 3]| {
        boxes.iter().any(|[low, high]| {
            (0..3).all(|k| match planes[k].get(cell[k]..=cell[k] + 1) {
                Some(span) => low[k] <= span[0] && span[1] <= high[k],
                None => false,
            })
        })
    };
    let mut surface = Surface::default();
    for x in 0..planes[0].len() {
        for y in 0..planes[1].len() {
            for z in 0..planes[2].len() {
                let cell = [x, y, z];
                for k in 0..3 {
                    // The face below the cell along axis k.
                    let mut below = cell;
                    let beyond_grid = below[k] == 0;
                    below[k] = below[k].wrapping_sub(1);
                    let outside = beyond_grid || !filled(below);
                    match (filled(cell), outside) {
                        (true, true) => surface.add_face(cell, k, false),
                        (false, false) => surface.add_face(cell, k, true),
                        _ => {}
                    }
                }
            }
        }
    }
    let Surface { index_of, triangles } = surface;
    let mut vertices = vec![Point3::origin(); index_of.len()];
    for (corner, index) in index_of {
        vertices[index as usize] = Point3::from([0, 1, 2].map(|k| planes[k][corner[k]]));
    }
    mesh(vertices, triangles)
}

/// Triangles between corners of a grid.
#[derive(Default)]
struct Surface {
    index_of: BTreeMap<[usize; 3], u32>,
    triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// The lower face of a cell across axis `k`, facing up along it or down.
    fn add_face(&mut self, cell: [usize; 3], k: usize, up: bool) {
        let corner = |i: usize, j: usize| {
            let mut at = cell;
            at[(k + 1) % 3] += i;
            at[(k + 2) % 3] += j;
            at
        };
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)].map(|at| {
            let next = self.index_of.len() as u32;
            *self.index_of.entry(at).or_insert(next)
        });
        self.triangles.extend(if up { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{area, volume};

    #[test]
    fn boxes_that_overlap_and_touch_become_one_surface() {
        // An L of two boxes with a common face, and a third that sticks half way into the first.
        let mesh = union_of_boxes(&[
            [[0.0, 0.0, 0.0], [2.0, 1.0, 1.0]],
            [[0.0, 0.0, 1.0], [1.0, 1.0, 2.0]],
            [[1.5, 0.25, 0.25], [2.5, 0.75, 0.75]],
        ]);
        assert_eq!((mesh.open_edges(), mesh.merged().open_edges()), (0, 0));
        assert!((volume(&mesh) - (2.0 + 1.0 + 0.125)).abs() < 1e-12);
        // 10 and 6 square metres less the common face twice, and four sides of the third.
        assert!((area(&mesh) - (10.0 + 6.0 - 2.0 + 4.0 * 0.25)).abs() < 1e-12);
    }
}

//! Triangles that are in a mesh more than once.

use std::collections::HashMap;

use super::TriangleMesh;

impl TriangleMesh {
    /// The same surface without triangles that repeat others: those that are turned the same way once, and of
    /// a mesh all of whose triangles have a back face of their own, as writers of two-sided surfaces make
    /// them, one of each pair; so too of a closed part of it that is written like that. Where single triangles
    /// have back faces and the mesh has a border, it loses the back faces, or the walls that they are of, if that
    /// closes it.
    ///
    /// A single triangle written twice leaves a solid with a border, and so without an inside. Call it on a
    /// [`merged`](Self::merged) mesh.
    #[must_use]
    pub fn without_repeats(&self) -> Self {
        // Of triangles with the same corners, the first of each turn.
        let mut of_corners: HashMap<[u32; 3], [Option<u32>; 2]> = HashMap::new();
        for (index, &triangle) in (0..).zip(self.triangles()) {
            let mut corners = triangle;
            corners.sort_unstable();
            let turn = usize::from(!is_turned_up(triangle, corners));
            of_corners.entry(corners).or_default()[turn].get_or_insert(index);
        }
        let count = |all: bool| {
            let is_pair = |pair: &&[Option<u32>; 2]| pair.iter().all(Option::is_some);
            of_corners.values().filter(|pair| all || is_pair(pair)).count()
        };
        let (different, pairs) = (count(true), count(false));
        if different == self.triangles().len() {
            return self.clone();
        }
        // How many of a pair are kept.
        let keeping = |of_pair: usize| {
            let mut kept: Vec<u32> = Vec::with_capacity(different);
            for pair in of_corners.values() {
                let mut own: Vec<u32> = pair.iter().flatten().copied().collect();
                own.sort_unstable();
                own.truncate(if own.len() == 2 { of_pair } else { 1 });
                kept.extend(own);
            }
            kept.sort_unstable();
            self.with_triangles(kept.iter().map(|&i| self.triangles()[i as usize]).collect())
        };
        let all = keeping(2);
        if pairs == different {
            return keeping(1);
        }
        if pairs == 0 {
            return all;
        }
        if let Some(fewer) = all.with_solids_from_one_side() {
            return fewer.without_repeats();
        }
        if all.border_edges() == 0 {
            return all;
        }
        let is_closed = |mesh: &Self| mesh.turned_alike().border_edges() == 0;
        [keeping(1), keeping(0)].into_iter().find(is_closed).unwrap_or(all)
    }
}

/// Whether a triangle runs through its corners in this order, wherever it begins.
fn is_turned_up([a, b, c]: [u32; 3], corners: [u32; 3]) -> bool {
    [[a, b, c], [b, c, a], [c, a, b]].contains(&corners)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Point3;

    /// A cube, two triangles a face.
    fn cube() -> TriangleMesh {
        let vertices =
            (0..8).map(|i| Point3::new((i & 1).into(), (i >> 1 & 1).into(), (i >> 2).into()));
        let quads =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        TriangleMesh::new(vertices.collect(), triangles).unwrap()
    }

    fn with(mesh: &TriangleMesh, more: impl IntoIterator<Item = [u32; 3]>) -> TriangleMesh {
        let all = mesh.triangles().iter().copied().chain(more);
        TriangleMesh::new(mesh.vertices().to_vec(), all.collect()).unwrap()
    }

    #[test]
    fn a_triangle_written_twice_is_there_once() {
        let cube = cube();
        assert_eq!((cube.border_edges(), cube.without_repeats()), (0, cube.clone()));
        let [a, b, c] = cube.triangles()[3];
        let again = with(&cube, [[b, c, a]]);
        assert_ne!(again.border_edges(), 0);
        assert_eq!(again.without_repeats(), cube);
        let all_again = with(&cube, cube.triangles().to_vec());
        assert_eq!(all_again.without_repeats(), cube);
    }

    #[test]
    fn a_solid_written_from_both_sides_has_an_inside() {
        let cube = cube();
        let back = |&[a, b, c]: &[u32; 3]| [a, c, b];
        let both = with(&cube, cube.triangles().iter().map(back));
        assert_eq!((both.border_edges(), both.without_repeats()), (0, cube.clone()));
        let one = with(&cube, [back(&cube.triangles()[5])]);
        assert_ne!(one.border_edges(), 0);
        assert_eq!(one.without_repeats(), cube);
    }

    /// Beside any other part it was a sheet with its own back, and what was in it read free.
    #[test]
    fn a_part_written_from_both_sides_has_an_inside_beside_others() {
        let cube = cube();
        let shifted = |by: f64| cube.vertices().iter().map(move |p| p + crate::Vector3::x() * by);
        let vertices: Vec<Point3> = shifted(0.0).chain(shifted(3.0)).chain(shifted(6.0)).collect();
        let part = |k: u32, is_back: bool| {
            cube.triangles().iter().map(move |t| {
                let [a, b, c] = t.map(|i| i + 8 * k);
                if is_back { [a, c, b] } else { [a, b, c] }
            })
        };
        let mesh =
            |triangles: Vec<[u32; 3]>| TriangleMesh::new(vertices.clone(), triangles).unwrap();
        let back: Vec<[u32; 3]> = part(2, false).take(1).chain(part(2, true).take(1)).collect();
        let alone: Vec<[u32; 3]> = part(0, false).collect();
        // Beside a single triangle too, and beside a sheet with its own back, which stays.
        for others in [alone.clone(), back[..1].to_vec(), [alone, back].concat()] {
            for is_back_first in [false, true] {
                let both = part(1, is_back_first).chain(part(1, !is_back_first));
                let kept = mesh(others.iter().copied().chain(both).collect()).without_repeats();
                assert_eq!(kept, mesh(others.iter().copied().chain(part(1, false)).collect()));
            }
        }
    }

    /// Boxes that were put together share a wall, which is there once for each; one with a single side is in
    /// the way.
    #[test]
    fn walls_between_solids_stay_where_nothing_has_a_border() {
        let upper = cube();
        let lower = upper.vertices().iter().map(|p| p - crate::Vector3::z()).collect();
        let lower = TriangleMesh::new(lower, upper.triangles().to_vec()).unwrap();
        let vertices = [upper.vertices(), lower.vertices()].concat();
        let shifted = lower.triangles().iter().map(|t| t.map(|i| i + 8));
        let triangles = upper.triangles().iter().copied().chain(shifted).collect();
        let both = TriangleMesh::new(vertices, triangles).unwrap().merged();
        assert_eq!((both.border_edges(), both.without_repeats()), (0, both.clone()));
    }

    #[test]
    fn an_open_mesh_stays_open() {
        let cube = cube();
        let open = TriangleMesh::new(cube.vertices().to_vec(), cube.triangles()[1..].to_vec());
        let open = open.unwrap();
        assert_eq!(open.without_repeats(), open);
        let [a, b, c] = open.triangles()[7];
        let back = with(&open, [[a, c, b], [b, c, a]]);
        assert_ne!(back.without_repeats().border_edges(), 0);
        assert_eq!(back.without_repeats().triangles().len(), open.triangles().len() + 1);
    }
}

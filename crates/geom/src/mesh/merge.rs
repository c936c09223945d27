//! Vertices in one place made one.

use std::collections::HashMap;

use super::TriangleMesh;

impl TriangleMesh {
    /// Merges vertices with identical coordinates, drops triangles that thereby collapse, and then
    /// vertices that no triangle uses.
    ///
    /// STL files repeat every vertex in every triangle; only after merging can one tell whether
    /// the mesh is closed.
    #[must_use]
    pub fn merged(&self) -> Self {
        let mut index_of = HashMap::new();
        // Of every vertex, the first with the same coordinates; adding zero makes −0 and 0 one key.
        let first: Vec<usize> = (self.vertices.iter().enumerate())
            .map(|(i, p)| *index_of.entry(p.coords.map(|v| (v + 0.0).to_bits())).or_insert(i))
            .collect();
        let kept: Vec<[usize; 3]> = self
            .triangles
            .iter()
            .map(|t| t.map(|i| first[i as usize]))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        let mut place = vec![None; self.vertices.len()];
        kept.iter().flatten().for_each(|&i| place[i] = Some(0));
        let mut vertices = Vec::new();
        for (place, p) in place.iter_mut().zip(&self.vertices) {
            if place.is_some() {
                *place = Some(vertices.len() as u32);
                vertices.push(*p);
            }
        }
        let triangles = kept.iter().map(|t| t.map(|i| place[i].unwrap_or_default())).collect();
        Self { vertices, triangles }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::vectors::Point3;

    pub(in crate::mesh) fn tetrahedron_soup() -> TriangleMesh {
        let corners = [
            Point3::new(0.0, 0.0, 0.0),
            Point3::new(1.0, 0.0, 0.0),
            Point3::new(0.0, 1.0, 0.0),
            Point3::new(0.0, 0.0, 1.0),
        ];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let vertices = faces.iter().flatten().map(|&i: &usize| corners[i]).collect();
        let triangles = (0..4).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        TriangleMesh::new(vertices, triangles).unwrap()
    }

    #[test]
    fn merging_closes_a_soup() {
        let soup = tetrahedron_soup();
        assert_eq!(soup.open_edges(), 12);
        let merged = soup.merged();
        assert_eq!((merged.vertices().len(), merged.open_edges()), (4, 0));
    }

    /// They stretched the bounding box, and as placeholders refused the mesh.
    #[test]
    fn vertices_that_no_face_uses_count_for_nothing() {
        let tetrahedron = tetrahedron_soup();
        for astray in [9.0, f64::NAN, f64::NEG_INFINITY] {
            let mut vertices = vec![Point3::new(0.0, astray, 0.0)];
            vertices.extend(tetrahedron.vertices());
            let shifted = tetrahedron.triangles().iter().map(|t| t.map(|i| i + 1)).collect();
            let mesh = TriangleMesh::new(vertices, shifted).unwrap();
            assert_eq!(mesh.bounding_box(), tetrahedron.bounding_box());
            assert_eq!(mesh.merged(), tetrahedron.merged());
        }
    }

    #[test]
    fn a_collapsed_triangle_left_its_vertices_behind() {
        let mut vertices = tetrahedron_soup().vertices().to_vec();
        let mut triangles = tetrahedron_soup().triangles().to_vec();
        triangles.push([0, vertices.len() as u32, vertices.len() as u32]);
        vertices.push(Point3::new(9.0, 0.0, 0.0));
        let mesh = TriangleMesh::new(vertices, triangles).unwrap();
        assert_eq!(mesh.merged(), tetrahedron_soup().merged());
    }
}

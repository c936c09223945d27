//! A triangle mesh as read from a file.

mod both_sides;
mod edges;
mod error;
mod merge;
mod repeats;
mod turn;

use crate::bounding_box::bounding_box;
use crate::vectors::Point3;

pub use error::MeshError;

/// Triangles over shared vertices, m. May be open, degenerate or a soup.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TriangleMesh {
    vertices: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Checks vertices and triangles and takes them. Vertices that no triangle uses may be anything,
    /// NaN included: nothing looks at them.
    ///
    /// # Errors
    /// When there are no triangles, an index is out of range, or a coordinate of a vertex that a
    /// triangle uses is not finite.
    pub fn new(vertices: Vec<Point3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        for (triangle, indices) in triangles.iter().enumerate() {
            if let Some(&index) = indices.iter().find(|&&i| i as usize >= vertices.len()) {
                let vertices = vertices.len();
                return Err(MeshError::MissingVertex { triangle, index, vertices });
            }
        }
        let mesh = Self { vertices, triangles };
        for (vertex, p) in mesh.used_vertices() {
            if let Some(&value) = p.iter().find(|v| !v.is_finite()) {
                return Err(MeshError::NotFinite { vertex, value });
            }
        }
        Ok(mesh)
    }

    /// The vertices, m; [`Self::used_vertices`] leaves out those that belong to no triangle.
    pub fn vertices(&self) -> &[Point3] {
        &self.vertices
    }

    /// The vertices that belong to a triangle, m, with their indices, in order.
    pub fn used_vertices(&self) -> impl Iterator<Item = (usize, &Point3)> {
        let mut used = vec![false; self.vertices.len()];
        self.triangles.iter().flatten().for_each(|&i| used[i as usize] = true);
        self.vertices.iter().enumerate().filter(move |&(i, _)| used[i])
    }

    /// Three vertex indices per triangle, anticlockwise seen from outside where that is known.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of one triangle.
    ///
    /// # Panics
    /// When the index is out of range.
    pub fn corners(&self, triangle: usize) -> [Point3; 3] {
        self.triangles[triangle].map(|i| self.vertices[i as usize])
    }

    /// The same mesh with coordinates multiplied by `factor` (0.001 for millimetres).
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.vertices.iter_mut().for_each(|p| p.coords *= factor);
        self
    }

    /// Lowest and highest corner around the triangles, m.
    pub fn bounding_box(&self) -> Option<(Point3, Point3)> {
        bounding_box(self.used_vertices().map(|(_, p)| p))
    }

    /// The same vertices in other triangles.
    pub(crate) fn with_triangles(&self, triangles: Vec<[u32; 3]>) -> Self {
        Self { vertices: self.vertices.clone(), triangles }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_meshes_are_refused_with_their_place() {
        let p = Point3::origin();
        assert_eq!(TriangleMesh::new(vec![p], vec![]), Err(MeshError::Empty));
        assert_eq!(
            TriangleMesh::new(vec![p], vec![[0, 0, 7]]),
            Err(MeshError::MissingVertex { triangle: 0, index: 7, vertices: 1 })
        );
        let bad = Point3::new(0.0, f64::INFINITY, 0.0);
        assert!(matches!(
            TriangleMesh::new(vec![p, bad], vec![[0, 0, 1]]),
            Err(MeshError::NotFinite { vertex: 1, .. })
        ));
    }
}

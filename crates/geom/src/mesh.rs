//! A triangle mesh as read from a file.

use std::collections::{BTreeSet, HashMap};

use crate::bounding_box::bounding_box;
use crate::message::number;
use crate::vectors::Point3;

/// Triangles over shared vertices, m. May be open, degenerate or a soup.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TriangleMesh {
    vertices: Vec<Point3>,
    triangles: Vec<[u32; 3]>,
}

/// Why vertices and triangles are not a mesh.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A vertex of a triangle has a coordinate that is NaN or infinite.
    #[error(
        "vertex {vertex} has the coordinate {}: every coordinate must be finite",
        number(*value)
    )]
    NotFinite {
        /// Which vertex, from 0.
        vertex: usize,
        /// What was found.
        value: f64,
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} names vertex {index}, but there are only {vertices}")]
    MissingVertex {
        /// Which triangle, from 0.
        triangle: usize,
        /// The index it names, from 0.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// There are no triangles.
    #[error("the mesh has no triangles")]
    Empty,
}

/// Borders that meet at a vertex, at most, where holes of three edges are looked for: a loose soup has thousands.
const MOST_BORDERS: usize = 8;

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

    /// The same vertices in other triangles.
    pub(crate) fn with_triangles(&self, triangles: Vec<[u32; 3]>) -> Self {
        Self { vertices: self.vertices.clone(), triangles }
    }

    /// How many edges do not join exactly two triangles that run along it in opposite directions.
    ///
    /// Zero means watertight and consistently oriented: inside and outside are defined. An edge that
    /// four triangles share counts, though it may close two bodies that touch there. Call it on a
    /// [`merged`](Self::merged) mesh.
    pub fn open_edges(&self) -> usize {
        self.edge_balance().values().filter(|&&(sum, count)| sum != 0 || count != 2).count()
    }

    /// How many edges are not run along equally often in both directions by the triangles there.
    ///
    /// Zero means that the surface has no border: it wraps around every place off it a whole number
    /// of times. Bodies that share an edge have none, nor has a sheet with its own back face. Call
    /// it on a [`merged`](Self::merged) mesh.
    pub fn border_edges(&self) -> usize {
        self.edge_balance().values().filter(|&&(sum, _)| sum != 0).count()
    }

    /// Triangles without which the surface has a border where they would be: holes of three edges, as a
    /// triangle that a file lacks leaves them, filled the way the others are turned. Call it on a
    /// [`merged`](Self::merged) mesh whose triangles are [turned alike](Self::turned_alike).
    pub fn missing_triangles(&self) -> Vec<[u32; 3]> {
        // Against the triangle that is there.
        let lacking = |(&(low, high), &(sum, _)): (&(u32, u32), &(i32, u32))| match sum {
            0 => None,
            1.. => Some((high, low)),
            _ => Some((low, high)),
        };
        let balance = self.edge_balance();
        let lacking: BTreeSet<(u32, u32)> = balance.iter().filter_map(lacking).collect();
        // One that is joined to no other is bordered as the other side of it would be.
        let sorted = |mut of: [u32; 3]| {
            of.sort_unstable();
            of
        };
        let known: BTreeSet<[u32; 3]> = self.triangles.iter().map(|&of| sorted(of)).collect();
        let after = |b: u32| lacking.range((b, 0)..=(b, u32::MAX)).map(|&(_, c)| c);
        let mut missing = Vec::new();
        for &(a, b) in &lacking {
            // Where many edges meet there are more than holes of three.
            if after(b).nth(MOST_BORDERS).is_some() {
                continue;
            }
            // Each once, from its first corner on.
            let closes = |&c: &u32| a < b.min(c) && lacking.contains(&(c, a));
            let of = after(b).filter(closes).map(|c| [a, b, c]);
            missing.extend(of.filter(|&of| !known.contains(&sorted(of))));
        }
        missing
    }

    /// For every edge, how many more triangles run along it upwards than downwards, and how many do.
    fn edge_balance(&self) -> HashMap<(u32, u32), (i32, u32)> {
        let mut balance: HashMap<(u32, u32), (i32, u32)> = HashMap::new();
        for &[a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let entry = balance.entry((from.min(to), from.max(to))).or_default();
                entry.0 += if from < to { 1 } else { -1 };
                entry.1 += 1;
            }
        }
        balance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron_soup() -> TriangleMesh {
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
    fn triangles_that_are_missing_are_found_as_they_were_turned() {
        let whole = tetrahedron_soup().merged();
        assert_eq!(whole.missing_triangles(), [[0; 3]; 0]);
        for lost in 0..4 {
            let mut rest = whole.triangles().to_vec();
            let gone = rest.remove(lost);
            let open = TriangleMesh::new(whole.vertices().to_vec(), rest).unwrap();
            let [missing] = open.missing_triangles()[..] else { panic!("{lost}") };
            assert_closed_by(&open, missing);
            let turns = [0, 1, 2].map(|k| [gone[k], gone[(k + 1) % 3], gone[(k + 2) % 3]]);
            assert!(turns.contains(&missing), "{missing:?} for {gone:?}");
        }
        // A triangle alone lacks nothing, and a face of two is an opening.
        let alone = TriangleMesh::new(whole.vertices().to_vec(), whole.triangles()[..1].to_vec());
        assert_eq!(alone.unwrap().missing_triangles(), [[0; 3]; 0]);
        let open = TriangleMesh::new(whole.vertices().to_vec(), whole.triangles()[..2].to_vec());
        assert_eq!(open.unwrap().missing_triangles(), [[0; 3]; 0]);
    }

    fn assert_closed_by(open: &TriangleMesh, missing: [u32; 3]) {
        let all = open.triangles().iter().copied().chain([missing]).collect();
        let closed = TriangleMesh::new(open.vertices().to_vec(), all).unwrap();
        assert_eq!(closed.open_edges(), 0);
    }

    #[test]
    fn merging_closes_a_soup() {
        let soup = tetrahedron_soup();
        assert_eq!(soup.open_edges(), 12);
        let merged = soup.merged();
        assert_eq!((merged.vertices().len(), merged.open_edges()), (4, 0));
    }

    /// Two tetrahedra that share an edge: four triangles meet there, two along it each way. They
    /// were taken for watertight.
    #[test]
    fn an_edge_of_four_triangles_counts_as_open() {
        let [a, b] = [Point3::origin(), Point3::new(0.0, 0.0, 1.0)];
        let mut vertices = vec![a, b];
        let mut triangles = Vec::new();
        for side in [1.0, -1.0] {
            let [c, d] = [vertices.len() as u32, vertices.len() as u32 + 1];
            vertices.push(Point3::new(side, 0.0, 0.5));
            vertices.push(Point3::new(side, side, 0.5));
            triangles.extend([[0, 1, c], [1, 0, d], [c, 1, d], [0, c, d]]);
        }
        let touching = TriangleMesh::new(vertices, triangles).unwrap();
        assert_eq!((touching.open_edges(), touching.border_edges()), (1, 0));
    }

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

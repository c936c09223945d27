//! Edges that do not join two triangles, and triangles that are missing at them.

use std::collections::{BTreeSet, HashMap};

use super::TriangleMesh;

/// Borders that meet at a vertex, at most, where holes of three edges are looked for: a loose soup has thousands.
const MOST_BORDERS: usize = 8;

impl TriangleMesh {
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
    pub(super) fn edge_balance(&self) -> HashMap<(u32, u32), (i32, u32)> {
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
    use crate::mesh::merge::tests::tetrahedron_soup;
    use crate::vectors::Point3;

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
}

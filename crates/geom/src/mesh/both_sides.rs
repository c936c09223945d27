//! Closed parts of a mesh that are written from both sides.

use std::collections::{HashMap, HashSet};

use super::TriangleMesh;

impl TriangleMesh {
    /// The same with one of each pair of triangles of the parts that are closed by these, turned outward: from both
    /// sides they wrap around nothing. Parts are joined by their vertices; `None` where there is no such part. Of a
    /// mesh without triangles that are there twice.
    pub(super) fn with_solids_from_one_side(&self) -> Option<Self> {
        let part = Parts::of(self);
        let sorted = |mut of: [u32; 3]| {
            of.sort_unstable();
            of
        };
        let mut times: HashMap<[u32; 3], u32> = HashMap::new();
        self.triangles.iter().for_each(|&of| *times.entry(sorted(of)).or_default() += 1);
        let has_back = |of: &[u32; 3]| times[&sorted(*of)] == 2;
        let others: HashSet<u32> = self
            .triangles
            .iter()
            .filter(|of| !has_back(of))
            .map(|of| part.of_vertex(of[0]))
            .collect();
        // The first of each pair, and all turned alike.
        let mut seen = HashSet::new();
        let is_one =
            |of: &[u32; 3]| !others.contains(&part.of_vertex(of[0])) && seen.insert(sorted(*of));
        let halves: Vec<[u32; 3]> = self.triangles.iter().copied().filter(is_one).collect();
        let halves = self.with_triangles(halves).turned_alike();
        let at_border = halves.edge_balance().into_iter().filter(|(_, (sum, _))| *sum != 0);
        let open: HashSet<u32> = at_border.map(|((vertex, _), _)| part.of_vertex(vertex)).collect();
        let is_solid = |of: &[u32; 3]| {
            let part = part.of_vertex(of[0]);
            !others.contains(&part) && !open.contains(&part)
        };
        if !halves.triangles.iter().any(is_solid) {
            return None;
        }
        let mut volumes: HashMap<u32, f64> = HashMap::new();
        for of in &halves.triangles {
            let name = part.of_vertex(of[0]);
            let [a, b, c] = of.map(|i| self.vertices[i as usize] - self.vertices[name as usize]);
            *volumes.entry(name).or_default() += a.dot(&b.cross(&c));
        }
        let mut once = halves.triangles.iter().filter(|of| is_solid(of)).map(|&[a, b, c]| {
            if volumes[&part.of_vertex(a)] < 0.0 { [a, c, b] } else { [a, b, c] }
        });
        // In the place of the first of each pair.
        let mut seen = HashSet::new();
        let kept = |&of: &[u32; 3]| match is_solid(&of) {
            true => seen.insert(sorted(of)).then(|| once.next()).flatten(),
            false => Some(of),
        };
        Some(self.with_triangles(self.triangles.iter().filter_map(kept).collect()))
    }
}

/// Of each vertex the first of those that triangles join it to.
struct Parts(Vec<u32>);

impl Parts {
    fn of(mesh: &TriangleMesh) -> Self {
        let mut parts = Self((0..mesh.vertices.len() as u32).collect());
        for of in &mesh.triangles {
            let firsts = of.map(|vertex| parts.shortened(vertex));
            let first = firsts.into_iter().fold(firsts[0], u32::min);
            firsts.into_iter().for_each(|name| parts.0[name as usize] = first);
        }
        (0..parts.0.len() as u32)
            .for_each(|vertex| parts.0[vertex as usize] = parts.shortened(vertex));
        parts
    }

    /// What stands for the part of a vertex so far; shortens the way there for the next time.
    fn shortened(&mut self, mut vertex: u32) -> u32 {
        while self.0[vertex as usize] != vertex {
            self.0[vertex as usize] = self.0[self.0[vertex as usize] as usize];
            vertex = self.0[vertex as usize];
        }
        vertex
    }

    fn of_vertex(&self, vertex: u32) -> u32 {
        self.0[vertex as usize]
    }
}

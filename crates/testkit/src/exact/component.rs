//! The connected components of a mesh.

use std::collections::BTreeMap;

use cloudtouch_geom::{Point3, TriangleMesh};

/// Triangles joined by shared vertex indices.
pub(super) struct Component {
    /// One of its vertices.
    pub(super) vertex: Point3,
    pub(super) triangles: Vec<u32>,
    low: Point3,
    high: Point3,
}

impl Component {
    pub(super) fn box_contains(&self, point: &Point3) -> bool {
        (0..3).all(|k| point[k] >= self.low[k] && point[k] <= self.high[k])
    }
}

/// Every component, in the order of their lowest vertex indices.
pub(super) fn components(mesh: &TriangleMesh) -> Vec<Component> {
    let mut parent: Vec<usize> = (0..mesh.vertices().len()).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    for t in mesh.triangles() {
        for i in [t[1], t[2]] {
            let (a, b) = (root(&mut parent, t[0] as usize), root(&mut parent, i as usize));
            // The lower index stays the root.
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut triangles_of = BTreeMap::<usize, Vec<u32>>::new();
    for (t, corners) in (0..).zip(mesh.triangles()) {
        triangles_of.entry(root(&mut parent, corners[0] as usize)).or_default().push(t);
    }
    let of = |(first, triangles): (usize, Vec<u32>)| {
        let vertex = mesh.vertices()[first];
        let mut component = Component { vertex, triangles, low: vertex, high: vertex };
        for p in component.triangles.iter().flat_map(|&t| mesh.corners(t as usize)) {
            component.low = component.low.inf(&p);
            component.high = component.high.sup(&p);
        }
        component
    };
    triangles_of.into_iter().map(of).collect()
}

//! The connected parts of a mesh, and what they enclose.

use std::collections::BTreeMap;

use cloudtouch_geom::{Point3, TriangleMesh};

/// A part whose volume is less than this times its area to the power of 3/2 encloses nothing:
/// rounding leaves some 1e-16, and a foil of a tenth of a millimetre over a square kilometre 1e-8.
const LEAST_VOLUME: f64 = 1e-12;

/// A connected part of a mesh.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    /// One of its vertices.
    pub vertex: Point3,
    /// The volume it encloses, m³, where it is closed; negative where its triangles are turned inward.
    pub volume: f64,
    /// Its surface, m².
    area: f64,
}

impl Part {
    /// False for a sheet with its own back face.
    pub(super) fn has_inside(&self) -> bool {
        encloses(self.volume, self.area)
    }
}

/// Whether a volume (m³) is one, beside the area (m²) of what encloses it.
pub(super) fn encloses(volume: f64, area: f64) -> bool {
    volume.abs() > LEAST_VOLUME * area.powf(1.5)
}

/// The parts of a merged mesh, joined by their vertices.
pub(super) fn parts(mesh: &TriangleMesh) -> Vec<Part> {
    let mut parent: Vec<usize> = (0..mesh.vertices().len()).collect();
    for &[a, b, c] in mesh.triangles() {
        let [a, b, c] = [a, b, c].map(|i| root(&mut parent, i as usize));
        let first = a.min(b).min(c);
        [a, b, c].into_iter().for_each(|i| parent[i] = first);
    }
    let mut parts = BTreeMap::<usize, Part>::new();
    for (t, &[first, ..]) in mesh.triangles().iter().enumerate() {
        let name = root(&mut parent, first as usize);
        // From a vertex of its own the volume of a part far away is not lost in rounding.
        let [a, b, c] = mesh.corners(t).map(|p| p - mesh.vertices()[name]);
        let vertex = mesh.vertices()[name];
        let part = parts.entry(name).or_insert(Part { vertex, volume: 0.0, area: 0.0 });
        part.volume += a.dot(&b.cross(&c)) / 6.0;
        part.area += 0.5 * (b - a).cross(&(c - a)).norm();
    }
    parts.into_values().collect()
}

/// What stands for the part of a vertex, or of a triangle; shortens the way there for the next time.
pub(super) fn root(parent: &mut [usize], mut vertex: usize) -> usize {
    while parent[vertex] != vertex {
        parent[vertex] = parent[parent[vertex]];
        vertex = parent[vertex];
    }
    vertex
}

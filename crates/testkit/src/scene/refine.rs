//! Refinement of a mesh without a change of its surface.

use std::collections::BTreeMap;

use cloudtouch_geom::{Point3, TriangleMesh};

use super::assemble::mesh;

/// Splits edges at their middles until none is longer than `max_edge` metres.
///
/// Whether an edge is split depends on its length alone, so neighbours agree and a closed mesh
/// stays closed. The surface does not change.
///
/// # Panics
/// When `max_edge` is not positive.
pub fn subdivide_to_max_edge(coarse: &TriangleMesh, max_edge: f64) -> TriangleMesh {
    assert!(max_edge > 0.0, "the longest edge allowed must be positive, not {max_edge}");
    let mut vertices = coarse.vertices().to_vec();
    let mut triangles = coarse.triangles().to_vec();
    loop {
        let mut middles = BTreeMap::new();
        let finer: Vec<[u32; 3]> = triangles
            .iter()
            .flat_map(|&t| split(t, &mut vertices, &mut middles, max_edge))
            .collect();
        let done = finer.len() == triangles.len();
        triangles = finer;
        if done {
            return mesh(vertices, triangles);
        }
    }
}

/// The one to four triangles that replace `t` when its long edges are halved.
fn split(
    t: [u32; 3],
    vertices: &mut Vec<Point3>,
    middles: &mut BTreeMap<(u32, u32), u32>,
    max_edge: f64,
) -> Vec<[u32; 3]> {
    let mut middle = |i: u32, j: u32| {
        let (p, q) = (vertices[i as usize], vertices[j as usize]);
        ((p - q).norm() > max_edge).then(|| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                vertices.push(nalgebra::center(&p, &q));
                (vertices.len() - 1) as u32
            })
        })
    };
    let [a, b, c] = t;
    match (middle(a, b), middle(b, c), middle(c, a)) {
        (None, None, None) => vec![t],
        (Some(m), None, None) => vec![[a, m, c], [m, b, c]],
        (None, Some(m), None) => vec![[b, m, a], [m, c, a]],
        (None, None, Some(m)) => vec![[c, m, b], [m, a, b]],
        (Some(ab), Some(bc), None) => vec![[b, bc, ab], [a, ab, bc], [a, bc, c]],
        (None, Some(bc), Some(ca)) => vec![[c, ca, bc], [b, bc, ca], [b, ca, a]],
        (Some(ab), None, Some(ca)) => vec![[a, ab, ca], [c, ca, ab], [c, ab, b]],
        (Some(ab), Some(bc), Some(ca)) => {
            vec![[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        }
    }
}

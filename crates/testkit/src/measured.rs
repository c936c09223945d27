//! A surface as a sensor measures it that looks from all sides.

use cloudtouch_geom::{Point3, TriangleMesh};

use crate::noise::{NoiseKind, add_noise};
use crate::{scene, surface};

/// A noisy cloud of a surface, one point for each square of side `spacing`, all metres.
///
/// The mesh is refined first: samples are spread evenly over triangles, so that small triangles
/// leave no holes.
///
/// # Panics
/// When the mesh has no area.
pub fn measured(mesh: &TriangleMesh, spacing: f64, std: f64, seed: u64) -> Vec<Point3> {
    let fine = scene::subdivide_to_max_edge(mesh, spacing);
    let count = (surface::area(mesh) / (spacing * spacing)).round() as usize;
    let samples = surface::sample_surface(&fine, count, seed);
    add_noise(&surface::positions(&samples), NoiseKind::Gaussian, std, seed)
}

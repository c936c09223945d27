//! Directions spread evenly.

use cloudtouch_geom::Vector3;

/// One of so many unit vectors spread evenly in all directions, on a spiral whose turns are the golden angle apart.
pub(crate) fn direction(k: usize, count: usize) -> Vector3 {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let z = 1.0 - (2 * k + 1) as f64 / count as f64;
    let (sine, cosine) = (golden * k as f64).sin_cos();
    let across = (1.0 - z * z).sqrt();
    Vector3::new(across * cosine, across * sine, z)
}

//! A noisy sphere as the primitives of a tree.

use cloudtouch_bvh::Primitive;
use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3, Vector3, seed};

/// A sphere 1 m across whose points scatter along the normal with a standard deviation of `std` m.
pub fn sphere(stream: u64, count: u64, std: f64) -> Vec<Primitive> {
    (0..count)
        .map(|i| {
            let draw = |k| seed::unit(seed::derive(stream, i, k));
            let (z, angle) = (2.0 * draw(0) - 1.0, std::f64::consts::TAU * draw(1));
            let ring = (1.0 - z * z).sqrt();
            let normal = Vector3::new(ring * angle.cos(), ring * angle.sin(), z);
            // Uniform noise of the standard deviation wanted.
            let mean = Point3::from(normal * (0.5 + std * 12_f64.sqrt() * (draw(2) - 0.5)));
            let covariance =
                Covariance::from_axis(&UnitVector3::new_unchecked(normal), std, 0.3 * std);
            Primitive::point(UncertainPoint { mean, covariance })
        })
        .collect()
}

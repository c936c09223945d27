//! The points of a leaf pair in the unit box: a bowl over a floor.

use cloudtouch_geom::{Covariance, Point3, UncertainPoint, seed};

/// `per_side` points of a bowl and as many of the floor `gap` below its lowest point, both
/// scattered with a standard deviation of `std` per axis; lengths in box sides.
pub fn bowl_over_floor(
    per_side: u64,
    gap: f64,
    std: f64,
    stream: u64,
) -> (Vec<UncertainPoint>, Vec<UncertainPoint>) {
    let side = |offset: u64, height: &dyn Fn(f64, f64) -> f64| {
        (0..per_side)
            .map(|i| {
                let draw = |k| seed::unit(seed::derive(stream, offset + i, k)) - 0.5;
                // Uniform noise of the standard deviation wanted.
                let noise = |k| std * 12_f64.sqrt() * draw(k);
                let (x, y) = (draw(0), draw(1));
                let mean = Point3::new(x + noise(2), y + noise(3), height(x, y) + noise(4));
                UncertainPoint { mean, covariance: Covariance::isotropic(std * std) }
            })
            .collect()
    };
    (side(0, &|x, y| gap + 0.6 * (x * x + y * y)), side(per_side, &|_, _| 0.0))
}

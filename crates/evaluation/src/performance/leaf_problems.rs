//! Random leaf problems of three kinds.

use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, Vector3, seed};
use cloudtouch_svm::{Class, Sample};
use cloudtouch_testkit::noise::{NoiseKind, add_noise};

/// A kind of leaf problem; lengths in sides of the unit box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub(super) name: &'static str,
    /// γ of the Gaussian kernel.
    pub(super) gamma: f64,
    /// C.
    pub(super) penalty: f64,
    /// r, from and to.
    radius: [f64; 2],
    /// Standard deviation of the points, from and to.
    noise: [f64; 2],
}

/// Distance of the two surfaces, from and to.
const GAP: [f64; 2] = [-0.1, 0.3];

pub(super) const CELLS: [Cell; 3] = [
    Cell { name: "easy", gamma: 5.0, penalty: 100.0, radius: [1.0, 1.0], noise: [0.01, 0.02] },
    Cell { name: "contact", gamma: 10.0, penalty: 100.0, radius: [1.0, 1.0], noise: [0.01, 0.05] },
    Cell { name: "hard", gamma: 20.0, penalty: 1000.0, radius: [2.0, 6.0], noise: [0.05, 0.1] },
];

impl Cell {
    /// A plane against a cap, a wedge or a sheet that crosses it, with equal or lopsided noise.
    pub(super) fn problem(&self, per_side: usize, from: u64) -> Vec<Sample> {
        let draw = |k| seed::unit(seed::derive(from, 0, k));
        let between = |[low, high]: [f64; 2], k| low + (high - low) * draw(k);
        let (gap, noise, radius) =
            (between(GAP, 0), between(self.noise, 1), between(self.radius, 2));
        let shape = (3.0 * draw(3)) as u64;
        let root =
            if draw(4) < 0.5 { Vector3::repeat(1.0) } else { Vector3::new(0.2, 0.5, 1.0) } * noise;
        let covariance =
            Covariance::from_symmetric(&Matrix3::from_diagonal(&root.component_mul(&root)));
        let side = |class: Class, stream: u64| {
            let at = |i: u64| {
                let draw = |k| seed::unit(seed::derive(seed::derive(from, 1, stream), i, k)) - 0.5;
                let (x, y) = (draw(0), draw(1));
                let above = match shape {
                    0 => 0.6 * (x * x + y * y),
                    1 => 0.8 * x.abs(),
                    _ => 0.4 * (x + 0.5),
                };
                Point3::new(x, y, if class == Class::A { gap + above } else { 0.0 })
            };
            let exact: Vec<Point3> = (0..per_side as u64).map(at).collect();
            let moved = add_noise(&exact, NoiseKind::Gaussian, 1.0, seed::derive(from, 2, stream));
            let sample = move |(exact, moved): (Point3, Point3)| Sample {
                point: UncertainPoint {
                    mean: exact + (moved - exact).component_mul(&root),
                    covariance,
                },
                class,
                radius,
                penalty: self.penalty,
            };
            exact.into_iter().zip(moved).map(sample).collect::<Vec<_>>()
        };
        let mut samples = side(Class::A, 0);
        samples.extend(side(Class::B, 1));
        samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problems_differ_and_stay_within_their_cell() {
        for cell in CELLS {
            let [first, second] = [1, 2].map(|from| cell.problem(20, from));
            assert_ne!(first, second);
            assert_eq!(first, cell.problem(20, 1));
            assert_eq!(first.iter().filter(|s| s.class == Class::A).count(), 20);
            for sample in first {
                assert!(cell.radius[0] <= sample.radius && sample.radius <= cell.radius[1]);
                let std = sample.point.covariance.max_std();
                assert!(cell.noise[0] <= std + 1e-12 && std <= cell.noise[1] + 1e-12, "{std}");
            }
        }
    }
}

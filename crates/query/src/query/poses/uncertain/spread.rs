//! Motions that stand for all that may be.

use cloudtouch_geom::{Pose, Vector3, normal};
use nalgebra::{DMatrix, DVector, Matrix6xX, UnitQuaternion, Vector6};

/// What motions are spread over.
pub(super) struct Spread {
    /// The axes of their covariance, each as long as its standard deviation; at least one.
    pub axes: Matrix6xX<f64>,
    /// The motion that matters.
    pub along: Vector6<f64>,
}

impl Spread {
    /// Motions that stand for all, in opposite pairs, out of so many nodes: those that are not in a pair are at
    /// rest. They are spread evenly along the motion that matters, and over the rest by an even sequence (the
    /// generalised golden ratio of M. Roberts).
    pub(super) fn pairs(&self, pairs: usize, nodes: usize) -> Vec<Vector6<f64>> {
        let mut even = even(self.axes.ncols(), pairs, nodes);
        let mut across: DVector<f64> = self.axes.tr_mul(&self.along);
        if across.try_normalize_mut(0.0).is_some() {
            // A reflection takes the first direction, along which they are most even, to that which matters.
            across[0] -= 1.0;
            if let Some(across) = across.try_normalize(f64::EPSILON) {
                even -= &across * (across.transpose() * &even) * 2.0;
            }
        }
        let motions = &self.axes * even;
        motions.column_iter().flat_map(|m| [m.into_owned(), -m.into_owned()]).collect()
    }

    /// The motion that lies so many deviations out along the one that matters.
    pub(super) fn out(&self, deviations: f64) -> Vector6<f64> {
        let across: DVector<f64> = self.axes.tr_mul(&self.along);
        // Where none matters, the first of the axes.
        let first = DVector::from_fn(self.axes.ncols(), |k, _| f64::from(u8::from(k == 0)));
        let unit = across.try_normalize(0.0).unwrap_or(first);
        &self.axes * unit * deviations
    }
}

/// A pose followed by a small motion in the object's frame.
pub(super) fn moved(mean: &Pose, motion: &Vector6<f64>) -> Pose {
    let (shift, turn) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
    let turn = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
    mean.after(&Pose::from_translation_rotation(Vector3::from(shift), turn))
}

/// Columns that stand for a standard normal distribution of so many dimensions: with their opposites
/// they have its mean and, where they are enough, its covariance.
fn even(dimensions: usize, pairs: usize, nodes: usize) -> DMatrix<f64> {
    let ratio = golden_ratio(dimensions.saturating_sub(1).max(1));
    let even = DMatrix::from_fn(dimensions, pairs, |k, number| {
        let share = match k {
            0 => (number as f64 + 0.5) / nodes as f64,
            k => (0.5 + ratio.powi(-(k as i32)) * (number + 1) as f64).fract(),
        };
        normal::quantile(share.clamp(1e-9, 1.0 - 1e-9))
    });
    let covariance = &even * even.transpose() / pairs as f64;
    let Some(factor) = covariance.cholesky() else { return even };
    factor.l().solve_lower_triangular(&even).unwrap_or(even)
}

/// The root above one of x^(d+1) = x + 1.
fn golden_ratio(dimensions: usize) -> f64 {
    let mut ratio = 1.5_f64;
    for _ in 0..60 {
        ratio = (1.0 + ratio).powf(1.0 / (dimensions + 1) as f64);
    }
    ratio
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix6;

    use super::super::distribution::PoseDistribution;
    use super::*;

    const PAIRS: usize = 8;

    #[test]
    fn motions_have_the_covariance_they_stand_for() {
        let mut covariance = [[0.0; 6]; 6];
        for (i, row) in covariance.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = if i == j {
                    1e-4
                } else if i / 3 == j / 3 {
                    3e-5
                } else {
                    0.0
                };
            }
        }
        let axes = PoseDistribution { mean: Pose::identity(), covariance }.axes().unwrap();
        let along = Vector6::new(1.0, 0.2, 0.0, -0.1, 0.3, 0.0);
        let motions = Spread { axes, along }.pairs(PAIRS, 2 * PAIRS);
        assert_eq!(motions.len(), 2 * PAIRS);
        let found: Matrix6<f64> =
            motions.iter().map(|m| m * m.transpose()).sum::<Matrix6<f64>>() / motions.len() as f64;
        let wanted = Matrix6::from_fn(|i, j| covariance[i][j]);
        assert!((found - wanted).amax() < 1e-15, "{found}");
    }

    #[test]
    fn one_direction_that_is_known_badly_takes_all_poses() {
        let of = |stds| {
            let axes = PoseDistribution::from_std(Pose::identity(), stds).axes().unwrap();
            let along = Vector6::new(0.0, 0.3, 1.0, 0.0, 0.0, 0.0);
            Spread { axes, along }.pairs(PAIRS, 2 * PAIRS)
        };
        let known = PoseDistribution::from_std(Pose::identity(), [0.0; 6]);
        assert!(known.axes().unwrap().is_empty());
        let along = of([0.0, 0.0, 0.02, 0.0, 0.0, 0.0]);
        assert!(along.iter().all(|m| m[0] == 0.0 && m[3] == 0.0));
        // One of sixteen is in each of as many equally likely parts.
        let mut along: Vec<f64> = along.iter().map(|m| m[2] / 0.02).collect();
        along.sort_by(f64::total_cmp);
        for (place, z) in along.iter().enumerate() {
            let share = normal::cdf(*z) * along.len() as f64;
            assert!((share - place as f64 - 0.5).abs() < 0.5, "{place}: {share}");
        }
    }
}

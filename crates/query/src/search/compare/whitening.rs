//! Lengths in standard deviations.

use cloudtouch_geom::{Covariance, Matrix3, Vector3};

use crate::cloud::{End, Surfel};

use super::meeting::LEAST_STD;

/// Lengths in standard deviations of a piece of surface, in every direction.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Whitening {
    /// Symmetric square roots of the covariance and of its inverse.
    root: Matrix3,
    inverse: Matrix3,
}

impl Whitening {
    pub(in crate::search) fn of(surfel: &Surfel) -> Self {
        match surfel.normal {
            Some(normal) if surfel.end != End::CutOff => {
                Self::of_disc(&normal, &surfel.point.covariance)
            }
            _ => Self::of_any(&surfel.point.covariance),
        }
    }

    /// Of one that is the same in all directions across a unit vector, as where a surface is known.
    fn of_disc(normal: &Vector3, covariance: &Covariance) -> Self {
        let across = covariance.variance_along(normal);
        let along = 0.5 * (covariance.matrix().trace() - across);
        let [across, along] = [across, along].map(|v| v.max(0.0).sqrt().max(LEAST_STD));
        let of = |across: f64, along: f64| {
            Matrix3::from_diagonal_element(along) + normal * normal.transpose() * (across - along)
        };
        Self { root: of(across, along), inverse: of(across.recip(), along.recip()) }
    }

    pub(super) fn of_any(covariance: &Covariance) -> Self {
        let (variances, axes) = covariance.eigen();
        let stds = variances.map(|v| v.max(0.0).sqrt().max(LEAST_STD));
        let along = |stds: Vector3| axes * Matrix3::from_diagonal(&stds) * axes.transpose();
        Self { root: along(stds), inverse: along(stds.map(f64::recip)) }
    }

    pub(in crate::search) fn root(&self) -> &Matrix3 {
        &self.root
    }

    pub(in crate::search) fn apply(&self, offset: &Vector3) -> Vector3 {
        self.inverse * offset
    }

    /// Along a unit vector, m².
    pub(super) fn variance_along(&self, direction: &Vector3) -> f64 {
        (self.root * direction).norm_squared()
    }

    pub(super) fn undo(&self, whitened: &Vector3) -> Vector3 {
        self.root * whitened
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::unit;

    use super::*;

    #[test]
    fn lengths_in_deviations_of_a_disc_are_those_of_any_covariance() {
        for (normal, stds) in
            [(Vector3::new(1.0, 2.0, -2.0) / 3.0, [0.01, 0.4]), (Vector3::y(), [0.3, 0.1])]
        {
            let covariance = Covariance::from_axis(&unit(&normal).unwrap(), stds[0], stds[1]);
            let (disc, any) =
                (Whitening::of_disc(&normal, &covariance), Whitening::of_any(&covariance));
            assert!(
                (disc.root - any.root).norm() < 1e-12 && (disc.inverse - any.inverse).norm() < 1e-9
            );
        }
    }
}

//! Covariances of what is turned, scaled, and added up.

use nalgebra::UnitQuaternion;

use super::{Covariance, Form};
use crate::vectors::Matrix3;

impl Covariance {
    /// R Σ Rᵀ.
    #[must_use]
    pub fn rotated(&self, rotation: &UnitQuaternion<f64>) -> Self {
        match &self.0 {
            // Else the matrix of the rotation is formed for nothing.
            Form::Isotropic(_) => *self,
            _ => self.turned(rotation.to_rotation_matrix().matrix()),
        }
    }

    /// The same with R as a matrix.
    #[inline]
    pub(crate) fn turned(&self, rotation: &Matrix3) -> Self {
        match &self.0 {
            Form::Isotropic(_) => *self,
            Form::Axis(axis) => Self(Form::Axis(axis.turned(rotation))),
            Form::Full(symmetric) => Self::congruent(rotation, &symmetric.matrix()),
        }
    }

    /// The covariance of `factor`·x.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let squared = factor * factor;
        Self(match &self.0 {
            Form::Isotropic(variance) => Form::Isotropic(variance * squared),
            Form::Axis(axis) => Form::Axis(axis.scaled(factor.abs())),
            Form::Full(symmetric) => Form::Full(symmetric.scaled(squared)),
        })
    }

    /// Σ + Ψ: the covariance of a sum of independent errors.
    #[inline]
    #[must_use]
    pub fn sum(&self, other: &Self) -> Self {
        match (&self.0, &other.0) {
            (Form::Isotropic(a), Form::Isotropic(b)) => Self(Form::Isotropic(a + b)),
            (Form::Isotropic(0.0), _) => *other,
            (_, Form::Isotropic(0.0)) => *self,
            (Form::Axis(axis), Form::Isotropic(variance))
            | (Form::Isotropic(variance), Form::Axis(axis)) => {
                Self(Form::Axis(axis.widened(variance.sqrt(), variance.sqrt())))
            }
            (Form::Axis(a), Form::Axis(b)) if a.axis == b.axis => {
                Self(Form::Axis(a.widened(b.along, b.across)))
            }
            _ => Self::full(self.symmetric().plus(&other.symmetric())),
        }
    }
}

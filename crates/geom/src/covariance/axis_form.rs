//! A covariance that is the same in every direction across an axis: noise along a viewing ray, a
//! piece of surface.

use crate::covariance::symmetric::Symmetric;
use crate::vectors::{Matrix3, UnitVector3, Vector3};

/// s² a aᵀ + t² (I − a aᵀ): the axis a, and the standard deviations s along it and t across it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisForm {
    /// a.
    pub axis: UnitVector3,
    /// s, m; not negative.
    pub along: f64,
    /// t, m; not negative.
    pub across: f64,
}

impl AxisForm {
    #[inline]
    pub(crate) fn symmetric(&self) -> Symmetric {
        let (along, across) = (self.along * self.along, self.across * self.across);
        let (a, extra) = (&self.axis, along - across);
        Symmetric {
            xx: across + extra * a.x * a.x,
            xy: extra * a.x * a.y,
            xz: extra * a.x * a.z,
            yy: across + extra * a.y * a.y,
            yz: extra * a.y * a.z,
            zz: across + extra * a.z * a.z,
        }
    }

    /// s² (a·d)² + t² |a × d|²: no difference of large numbers, however unequal s and t are.
    #[inline]
    pub(crate) fn variance_along(&self, direction: &Vector3) -> f64 {
        let along = self.along * self.axis.dot(direction);
        along * along + self.across * self.across * self.axis.cross(direction).norm_squared()
    }

    /// Variances in descending order and their axes.
    pub(crate) fn eigen(&self) -> (Vector3, Matrix3) {
        let (along, across) = (self.along * self.along, self.across * self.across);
        let axis = self.axis.into_inner();
        // The coordinate axis least along it gives the best conditioned tangent.
        let first = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
        let second = axis.cross(&first);
        if along > across {
            let axes = Matrix3::from_columns(&[axis, first, second]);
            (Vector3::new(along, across, across), axes)
        } else {
            let axes = Matrix3::from_columns(&[first, second, axis]);
            (Vector3::new(across, across, along), axes)
        }
    }

    /// t I + (s − t) a aᵀ, m.
    pub(crate) fn root(&self) -> Matrix3 {
        let outer = self.axis.into_inner() * self.axis.transpose();
        Matrix3::identity() * self.across + outer * (self.along - self.across)
    }

    pub(crate) fn turned(&self, rotation: &Matrix3) -> Self {
        let mut axis = UnitVector3::new_unchecked(rotation * self.axis.into_inner());
        // Or its length would drift when it is turned often.
        axis.renormalize_fast();
        Self { axis, ..*self }
    }

    pub(crate) fn scaled(&self, factor: f64) -> Self {
        Self { along: self.along * factor, across: self.across * factor, ..*self }
    }

    /// With an independent error of these standard deviations.
    pub(crate) fn widened(&self, along: f64, across: f64) -> Self {
        let [along, across] =
            [(self.along, along), (self.across, across)].map(|(a, b)| (a * a + b * b).sqrt());
        Self { along, across, ..*self }
    }
}

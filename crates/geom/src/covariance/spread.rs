//! How much a covariance says in some direction, or at most.

use super::{Covariance, Form};
use crate::covariance::axis_form::AxisForm;
use crate::covariance::symmetric::Symmetric;
use crate::covariance::variance::not_negative;
use crate::vectors::{Matrix3, Vector3};

/// Relative slack of a largest variance, far above the rounding of eigenvalues.
const WITHIN: f64 = 1e-12;

impl Covariance {
    /// Variances in descending order and the unit axes (columns, right-handed or not) they
    /// belong to.
    pub fn eigen(&self) -> (Vector3, Matrix3) {
        match &self.0 {
            Form::Isotropic(variance) => (Vector3::repeat(*variance), Matrix3::identity()),
            Form::Axis(axis) => axis.eigen(),
            Form::Full(symmetric) => in_order(symmetric.eigen()),
        }
    }

    /// What [`Self::eigen`] says of either, to the bit, in little more than the time of one.
    pub fn eigen_of_two(two: [&Self; 2]) -> [(Vector3, Matrix3); 2] {
        match two.map(|one| &one.0) {
            [Form::Full(one), Form::Full(other)] => {
                Symmetric::eigen_of_two([one, other]).map(in_order)
            }
            _ => two.map(Self::eigen),
        }
    }

    /// The symmetric root S with S S = Σ, in metres.
    pub fn sqrt(&self) -> Matrix3 {
        match &self.0 {
            Form::Isotropic(variance) => Matrix3::identity() * variance.sqrt(),
            Form::Axis(axis) => axis.root(),
            Form::Full(_) => {
                let (values, axes) = self.eigen();
                axes * Matrix3::from_diagonal(&values.map(f64::sqrt)) * axes.transpose()
            }
        }
    }

    /// Variance (m²) of the component along `direction`, which need not have unit length.
    #[inline]
    pub fn variance_along(&self, direction: &Vector3) -> f64 {
        match &self.0 {
            Form::Isotropic(variance) => variance * direction.norm_squared(),
            Form::Axis(axis) => axis.variance_along(direction),
            Form::Full(symmetric) => not_negative(symmetric.quadratic(direction)),
        }
    }

    /// Standard deviation (m) of the component along `direction`.
    pub fn std_along(&self, direction: &Vector3) -> f64 {
        self.variance_along(direction).sqrt()
    }

    /// An upper bound on the standard deviation in any direction: √trace ≥ √λ₁.
    ///
    /// At most √3 too large, and much cheaper than the eigenvalue; see [`Self::max_std`].
    pub fn std_bound(&self) -> f64 {
        match &self.0 {
            Form::Isotropic(variance) => (3.0 * variance).sqrt(),
            Form::Axis(AxisForm { along, across, .. }) => {
                (along * along + 2.0 * across * across).sqrt()
            }
            Form::Full(symmetric) => (symmetric.xx + symmetric.yy + symmetric.zz).sqrt(),
        }
    }

    /// The largest standard deviation in any direction, m.
    pub fn max_std(&self) -> f64 {
        match &self.0 {
            Form::Isotropic(variance) => variance.sqrt(),
            Form::Axis(AxisForm { along, across, .. }) => along.max(*across),
            Form::Full(_) => self.eigen().0[0].sqrt(),
        }
    }

    /// The largest standard deviation in any direction, m, or up to a millionth more: a bound that is soon
    /// told, see [`Self::max_std`].
    pub fn max_std_at_most(&self) -> f64 {
        match &self.0 {
            Form::Isotropic(_) | Form::Axis(_) => self.max_std(),
            Form::Full(symmetric) => symmetric.largest_at_most().sqrt(),
        }
    }

    /// Whether no standard deviation is above this one, m: soon told, without eigenvalues. Perhaps not
    /// where the largest is less than 1e-12 below it; never where it is above.
    pub fn is_within(&self, std: f64) -> bool {
        match &self.0 {
            Form::Isotropic(_) | Form::Axis(_) => self.max_std() <= std,
            Form::Full(symmetric) => symmetric.is_within(std * std * (1.0 - WITHIN)),
        }
    }
}

/// Eigenvalues in descending order, none of them negative, and the axes they belong to. If one is NaN all
/// are: the sign of a NaN is arbitrary and would decide its place.
fn in_order((values, axes): (Vector3, Matrix3)) -> (Vector3, Matrix3) {
    if values.iter().any(|value| value.is_nan()) {
        return (Vector3::repeat(f64::NAN), axes);
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i, &j| values[j].total_cmp(&values[i]));
    (
        Vector3::from_fn(|k, _| not_negative(values[order[k]])),
        Matrix3::from_fn(|row, k| axes[(row, order[k])]),
    )
}

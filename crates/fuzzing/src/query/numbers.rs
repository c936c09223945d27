//! Numbers as data has them, with now and then one that nobody should have.

use arbitrary::{Result, Unstructured};
use cloudtouch::geom::{Covariance, Matrix3, Point3, Pose, Vector3};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

/// Where sums, squares and divisions leave the range of `f64`.
const EXTREMES: [f64; 12] = [
    0.0,
    -0.0,
    f64::NAN,
    f64::INFINITY,
    f64::MAX,
    f64::MIN_POSITIVE,
    5e-324,
    1e150,
    -1e154,
    1e-160,
    1e16,
    1e-9,
];

/// Mostly a multiple of a centimetre or of a tenth of a millimetre, rarely anything at all.
pub(super) fn number(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(match u.arbitrary::<u8>()? {
        0..=199 => 0.01 * f64::from(u.arbitrary::<i8>()?),
        200..=239 => 1e-4 * f64::from(u.arbitrary::<i16>()?),
        240..=249 => *u.choose(&EXTREMES)?,
        250..=255 => u.arbitrary()?,
    })
}

/// Mostly a setting in its range, rarely any number.
pub(super) fn setting(u: &mut Unstructured<'_>, usual: f64, low: f64, high: f64) -> Result<f64> {
    Ok(match u.arbitrary::<u8>()? {
        0..=127 => usual,
        128..=247 => low + (high - low) * f64::from(u.arbitrary::<u8>()?) / 255.0,
        248..=255 => number(u)?,
    })
}

/// Mostly a small count, rarely any.
pub(super) fn count(u: &mut Unstructured<'_>, usual: usize) -> Result<usize> {
    Ok(match u.arbitrary::<u8>()? {
        0..=127 => usual,
        128..=247 => usize::from(u.arbitrary::<u8>()? % 64),
        248..=255 => u.arbitrary()?,
    })
}

pub(super) fn point(u: &mut Unstructured<'_>) -> Result<Point3> {
    Ok(Point3::new(number(u)?, number(u)?, number(u)?))
}

/// A covariance as its constructors make them: checked, of any scale, flat or long or nothing.
pub(super) fn covariance(u: &mut Unstructured<'_>) -> Result<Covariance> {
    Ok(match u.arbitrary::<u8>()? % 4 {
        0 => Covariance::zero(),
        1 => Covariance::isotropic(number(u)?.powi(2)),
        2 => Covariance::diagonal([number(u)?, number(u)?, number(u)?]),
        _ => {
            let factor = Matrix3::from_columns(&[vector(u)?, vector(u)?, vector(u)?]);
            let matrix = factor * factor.transpose();
            Covariance::try_from_matrix(&matrix).unwrap_or_else(|_| Covariance::zero())
        }
    })
}

/// A rigid motion, of which the constructors do not see to it that it is finite.
pub(super) fn pose(u: &mut Unstructured<'_>) -> Result<Pose> {
    let translation = Translation3::from(vector(u)?);
    let rotation = match u.arbitrary::<u8>()? {
        0..=99 => UnitQuaternion::identity(),
        _ => UnitQuaternion::from_scaled_axis(vector(u)?),
    };
    Ok(Pose::from_isometry(Isometry3::from_parts(translation, rotation)))
}

fn vector(u: &mut Unstructured<'_>) -> Result<Vector3> {
    Ok(point(u)?.coords)
}

//! Rung 0, the linear certificate: a plane that keeps every point of two clouds on its own side by
//! so many standard deviations that no kernel problem needs to be solved.

mod gjk;
mod search;

use cloudtouch_geom::message::number;
use cloudtouch_geom::{Point3, UncertainPoint, Vector3, normal};

use crate::plane::search::{Pair, Side};
use crate::problem::sample::Class;

/// The κ at which a search usually stops: every probability is then below 1.1e-6.
pub const DEFAULT_KAPPA_MAX: f64 = 4.75;

/// A plane between two clouds, with a guarantee.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Separation {
    /// A point of the plane, in the frame of the clouds, to the digits that coordinates there have.
    pub point: Point3,
    /// Unit normal from cloud A to cloud B.
    pub normal: Vector3,
    /// Every point is at least this many of its standard deviations on its own side of the plane,
    /// exact points strictly so; positive, and at most the maximum asked for.
    pub kappa: f64,
}

impl Separation {
    /// Upper bound on the probability that any one point is on the wrong side: 1 − Φ(κ).
    ///
    /// This bounds the points one by one; it says nothing on the surface between them.
    pub fn point_probability_bound(&self) -> f64 {
        normal::upper_tail(self.kappa)
    }

    /// Distance from the plane, positive on the side of cloud A (as the decision function is).
    pub fn signed_distance(&self, point: &Point3) -> f64 {
        (self.point - point).dot(&self.normal)
    }
}

/// Why there is no plane.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoSeparation {
    /// A cloud has no points.
    #[error("cloud {class:?} has no points: a plane needs two clouds to separate")]
    Empty {
        /// Which cloud.
        class: Class,
    },
    /// A coordinate or a covariance is NaN or infinite.
    #[error("point {index} of cloud {class:?} is not finite: remove it")]
    NotFinite {
        /// Which cloud.
        class: Class,
        /// Which of its points.
        index: usize,
    },
    /// The largest κ asked for is not positive, or not finite.
    #[error("the largest kappa is {}: it must be positive and finite", number(*value))]
    KappaMax {
        /// What was given.
        value: f64,
    },
    /// No plane was found, as between clouds that reach into one another; no proof that they do.
    #[error("no plane was found with all of A on one side and all of B on the other")]
    NotFound,
    /// The best plane found keeps some point off by no more than rounding.
    #[error("the best plane found passes some point within rounding: the clouds touch, or nearly")]
    WithinRounding,
}

/// Finds a plane between two clouds that is as many standard deviations as possible, up to
/// `kappa_max`, from every point.
///
/// A returned κ is checked against every point and the plane as returned, with an allowance for rounding
/// of distances and of standard deviations, whatever the search did; it can only be too small, usually by
/// less than one part in a thousand of the best possible. So far from the origin that coordinates are
/// rounded to more than a part of the noise it is smaller, or there is no plane.
///
/// The search asks whether the clouds of ellipsoids of radius κ can be separated, by GJK on the
/// difference of their hulls with the support function v·x ± κ|S v|: at once for `kappa_max`, and
/// failing that by climbing (each separating direction has an exact best κ, from which the next
/// search starts). Cost: a few passes over the points when `kappa_max` is reached, some dozens
/// otherwise.
///
/// # Errors
/// When no plane with κ > 0 was found, which is no proof that the clouds touch; when a cloud is empty
/// or not finite, or `kappa_max` not positive or not finite.
pub fn separate(
    a: &[UncertainPoint],
    b: &[UncertainPoint],
    kappa_max: f64,
) -> Result<Separation, NoSeparation> {
    if !(kappa_max.is_finite() && kappa_max > 0.0) {
        return Err(NoSeparation::KappaMax { value: kappa_max });
    }
    let anchor = check(a, Class::A)?;
    check(b, Class::B)?;
    let (side_a, side_b) = (Side::new(a, &anchor), Side::new(b, &anchor));
    let found = Pair { a: &side_a, b: &side_b, anchor, kappa_max }.best_plane();
    let found = found.ok_or(NoSeparation::NotFound)?;
    if found.kappa <= 0.0 {
        return Err(NoSeparation::WithinRounding);
    }
    Ok(Separation { point: found.point, normal: -found.direction, kappa: found.kappa })
}

/// The first point, of a cloud that has one and is finite.
fn check(cloud: &[UncertainPoint], class: Class) -> Result<Point3, NoSeparation> {
    let first = cloud.first().ok_or(NoSeparation::Empty { class })?;
    let is_finite =
        |p: &UncertainPoint| p.mean.iter().all(|v| v.is_finite()) && p.covariance.is_finite();
    match cloud.iter().position(|p| !is_finite(p)) {
        Some(index) => Err(NoSeparation::NotFinite { class, index }),
        None => Ok(first.mean),
    }
}

//! Covariances kept within what bounds promise.

use cloudtouch_geom::Covariance;

/// The covariance scaled down, if need be, so that no standard deviation exceeds `limit`.
pub(crate) fn limited(covariance: Covariance, limit: f64) -> Covariance {
    let std = covariance.max_std();
    // A hair inside the limit, so that rounding does not cross it.
    if std > limit { covariance.scaled((limit / std) * (1.0 - 1e-12)) } else { covariance }
}

//! What a query says in one number, and between what bounds.

use crate::recalibration::ContactEvidence;

/// A probability with its bounds, and what it rests on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Estimate {
    pub probability: f64,
    /// Lower and upper bound on the probability under the same model.
    pub bounds: [f64; 2],
    /// For two clouds in the calibrated mode.
    pub evidence: Option<ContactEvidence>,
}

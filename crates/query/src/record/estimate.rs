//! What a query says in one number, and between what bounds.

use crate::judge::ContactEvidence;
use crate::report::{Clearance, Contact};

/// Where two bodies touch and how far apart they are.
#[derive(Debug, Clone, Default)]
pub(crate) struct Places {
    /// In the local frame of A.
    pub contacts: Vec<Contact>,
    pub clearance: Option<Clearance>,
    pub at_least: Option<f64>,
}

/// A probability with its bounds, and what it rests on.
#[derive(Debug, Clone)]
pub(crate) struct Estimate {
    pub probability: f64,
    /// Lower and upper bound on the probability under the same model.
    pub bounds: [f64; 2],
    /// On the default path, but for two meshes.
    pub evidence: Option<ContactEvidence>,
    pub log_likelihood_ratio: Option<f64>,
    /// Contacts and clearance where geometry told them.
    pub places: Option<Places>,
    /// Whether the time was over before anything was looked at: then nothing else is either.
    pub is_too_late: bool,
}

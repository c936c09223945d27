//! When points are close to each other, and when they count at all (section 4.4 of the paper).

use serde::{Deserialize, Serialize};

/// Which points the noisy-or takes for witnesses of their own. The paper says "close to each other"
/// without a number; these are ours.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Closeness {
    /// Points below this share of the largest probability add nothing but noise; more than 0 and less than 1.
    pub share_of_max: f64,
    /// Points nearer than this many spacings share the samples their position was estimated from, and
    /// count once; not negative.
    pub spacings: f64,
}

impl Default for Closeness {
    fn default() -> Self {
        Self { share_of_max: 0.8, spacings: 3.0 }
    }
}

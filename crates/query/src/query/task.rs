//! What one query has to do, and in what time.

use cloudtouch_bvh::TraversalSettings;

use crate::classifier::{ClassifierSettings, Clock};

use super::settings::QuerySettings;

/// What every part of one query goes by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task<'a> {
    /// Checked.
    pub settings: &'a QuerySettings,
    pub classifier: ClassifierSettings,
    /// What the traversal of two trees is asked.
    pub traversal: TraversalSettings,
    pub clock: Clock,
}

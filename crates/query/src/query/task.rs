//! What one query has to do, and in what time.

use crate::classifier::{ClassifierSettings, Clock};

use super::settings::QuerySettings;

/// What every part of one query goes by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task<'a> {
    /// Checked.
    pub settings: &'a QuerySettings,
    pub classifier: ClassifierSettings,
    pub clock: Clock,
}

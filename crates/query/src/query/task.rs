//! What one query has to do, and in what time.

use crate::classifier::{ClassifierSettings, Clock};

use crate::judge::Judge;

use super::settings::QuerySettings;

/// What every part of one query goes by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task<'a> {
    /// Checked.
    pub settings: &'a QuerySettings,
    /// That of the settings, as far as it believes the classifier of these bodies.
    pub judge: Judge,
    pub classifier: ClassifierSettings,
    pub clock: Clock,
}

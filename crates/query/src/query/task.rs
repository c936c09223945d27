//! What one query has to do, and in what time.

use crate::classifier::{ClassifierSettings, Clock};

use crate::judge::{Blur, JudgeOfPair};

use super::settings::QuerySettings;

/// What every part of one query goes by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Task<'a> {
    /// Checked.
    pub settings: &'a QuerySettings,
    /// That of the settings for these bodies.
    pub judge: JudgeOfPair,
    /// What it is for.
    pub blur: Blur,
    pub classifier: ClassifierSettings,
    pub clock: Clock,
}

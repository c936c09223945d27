//! What is looked at beside the evidence before a pair may read as free.

use serde::{Deserialize, Serialize};

use crate::doubt::unseen::Unseen;
use crate::doubt::warning::Warning;
use crate::error::SettingsError;

/// Surface where something rather is counts for so many times as much as what is in a shadow
/// (docs/decisions/0049-close-behind-what-was-seen.md).
const RATHER_THERE: f64 = 10.0;

/// Limits beyond which a pair that would read as free, or between the thresholds, is undecided.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Safeguards {
    /// Share of a body's surface that may lie where a single depth image saw nothing, 0 to 1; 1 never
    /// objects. Of what is [`Unseen::close_behind`] a tenth of it.
    pub max_unseen: f64,
    /// Share of the rows of a cloud without image layout that may have no return, 0 to 1; 1 never
    /// objects.
    pub max_missing: f64,
    /// Whether sizes and distances that cannot be meant make a pair undecided. They are warned of in
    /// either case.
    pub doubt_units: bool,
}

impl Default for Safeguards {
    /// 2 % unseen: the tip of a finger. A quarter missing. Units are doubted.
    fn default() -> Self {
        Self { max_unseen: 0.02, max_missing: 0.25, doubt_units: true }
    }
}

impl Safeguards {
    /// Checks every field.
    ///
    /// # Errors
    /// Names the setting that is out of range, and its value.
    pub fn validate(&self) -> Result<(), SettingsError> {
        for (name, value) in [("max_unseen", self.max_unseen), ("max_missing", self.max_missing)] {
            if !(0.0..=1.0).contains(&value) {
                return Err(SettingsError::NotAShare { name, value });
            }
        }
        Ok(())
    }

    /// What is to be said of surface that was not seen, where it is more than may be.
    pub(crate) fn exceeded_by(&self, unseen: &Unseen) -> Option<Warning> {
        let Unseen { body, close_behind: share, .. } = *unseen;
        if unseen.share() > self.max_unseen {
            return Some(Warning::Unseen { body, share: unseen.share(), limit: self.max_unseen });
        }
        let limit = self.most_rather_there().filter(|limit| share > *limit)?;
        Some(Warning::CloseBehind { body, share, limit })
    }

    /// How much of a surface may lie where something rather is, as a share; `None` where nothing objects.
    pub(crate) fn most_rather_there(&self) -> Option<f64> {
        (self.max_unseen < 1.0).then_some(self.max_unseen / RATHER_THERE)
    }
}

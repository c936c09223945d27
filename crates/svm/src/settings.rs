//! How far to solve: accuracy, step budget, and whether the fallback may run.

use cloudtouch_geom::message::number;

/// Checked settings of a solve; every value of this type is valid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    relative_gap: f64,
    max_steps: Option<usize>,
    fallback: bool,
}

/// Why a setting was refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettingsError {
    /// The tolerance is not a number in its range.
    #[error(
        "relative gap {} is outside (0, 0.1]: 1e-3 serves verdicts, 1e-4 reported figures",
        number(*value)
    )]
    RelativeGap {
        /// What was given.
        value: f64,
    },
}

impl Default for Settings {
    /// A relative gap of 1e-3, the automatic step budget, and the fallback on.
    fn default() -> Self {
        Self { relative_gap: 1e-3, max_steps: None, fallback: true }
    }
}

impl Settings {
    /// Default settings with another tolerance for (primal − dual) / primal.
    ///
    /// At 1e-3 a probability between 0.05 and 0.95 is off by at most about 0.015, at 1e-4 by less
    /// than 0.01.
    ///
    /// # Errors
    /// When `relative_gap` is not in (0, 0.1].
    pub fn with_relative_gap(relative_gap: f64) -> Result<Self, SettingsError> {
        if relative_gap > 0.0 && relative_gap <= 0.1 {
            Ok(Self { relative_gap, ..Self::default() })
        } else {
            Err(SettingsError::RelativeGap { value: relative_gap })
        }
    }

    /// Lets SMO take exactly up to `steps` steps, instead of the automatic budget that also gives
    /// up early when the gap shrinks too slowly.
    #[must_use]
    pub fn max_steps(self, steps: usize) -> Self {
        Self { max_steps: Some(steps), ..self }
    }

    /// Whether the fallback may run when SMO does not reach the tolerance.
    #[must_use]
    pub fn fallback(self, allowed: bool) -> Self {
        Self { fallback: allowed, ..self }
    }

    /// The relative gap at which a solve counts as converged.
    pub fn relative_gap(&self) -> f64 {
        self.relative_gap
    }

    pub(crate) fn step_budget(&self) -> Option<usize> {
        self.max_steps
    }

    pub(crate) fn allows_fallback(&self) -> bool {
        self.fallback
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_out_of_range_are_refused() {
        for value in [0.0, -1.0, 0.2, f64::NAN, f64::INFINITY] {
            assert!(Settings::with_relative_gap(value).is_err(), "{value}");
        }
        assert_eq!(Settings::with_relative_gap(1e-9).unwrap().relative_gap(), 1e-9);
    }
}

//! How far to solve: accuracy, step budget, and whether other rungs may follow SMO.

use cloudtouch_geom::message::number;

/// Settings of a solve; [`Solver::new`](crate::Solver::new) checks them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Settings {
    /// The (primal − dual) / primal at which a solve counts as converged, in (0, 0.1].
    ///
    /// At 1e-3 a probability between 0.05 and 0.95 was mostly seen off by at most about 0.015, at 1e-4 by
    /// less than 0.01. Of some dozens of ellipsoids, many of them flat, one in fifty was farther off, by up to
    /// 0.27 and 0.11; at 1e-6 none by more than 0.01. What is guaranteed is
    /// [`ErrorBounds`](crate::ErrorBounds).
    pub relative_gap: f64,
    /// Lets SMO take exactly up to this many steps, instead of the automatic budget that also gives
    /// up early when the gap shrinks too slowly.
    pub max_steps: Option<usize>,
    /// Whether the interior point method and Clarabel may run where SMO does not reach the tolerance.
    pub fallback: bool,
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
    /// A relative gap of 1e-3, the automatic step budget, and all rungs allowed.
    fn default() -> Self {
        Self { relative_gap: 1e-3, max_steps: None, fallback: true }
    }
}

impl Settings {
    /// Checks every value.
    ///
    /// # Errors
    /// When `relative_gap` is not in (0, 0.1].
    pub fn validate(&self) -> Result<(), SettingsError> {
        let value = self.relative_gap;
        if value > 0.0 && value <= 0.1 { Ok(()) } else { Err(SettingsError::RelativeGap { value }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_out_of_range_are_refused() {
        for value in [0.0, -1.0, 0.2, f64::NAN, f64::INFINITY] {
            let settings = Settings { relative_gap: value, ..Settings::default() };
            assert!(settings.validate().is_err(), "{value}");
        }
        assert_eq!(Settings::default().validate(), Ok(()));
    }
}

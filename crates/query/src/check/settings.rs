//! Checks that the settings of both paths share.

use crate::error::SettingsError;

/// Whether 0 ≤ reject ≤ ½ ≤ accept ≤ 1.
pub(crate) fn thresholds(accept: f64, reject: f64) -> Result<(), SettingsError> {
    if (0.0..=0.5).contains(&reject) && (0.5..=1.0).contains(&accept) {
        Ok(())
    } else {
        Err(SettingsError::Thresholds { accept, reject })
    }
}

/// Whether a setting is a positive finite number.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), SettingsError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(SettingsError::NotPositive { name, value })
    }
}

/// Whether a setting is a finite number that is not negative.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<(), SettingsError> {
    if value >= 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(SettingsError::Negative { name, value })
    }
}

/// Whether a setting is between 0 and 1, ends excluded.
pub(crate) fn fraction(name: &'static str, value: f64) -> Result<(), SettingsError> {
    if value > 0.0 && value < 1.0 {
        Ok(())
    } else {
        Err(SettingsError::NotAFraction { name, value })
    }
}

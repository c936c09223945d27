//! What can be wrong with a setting, and the checks that say so.

use cloudtouch_geom::message::number;

/// A setting that is out of range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("setting `{name}` is {}: it must be finite and {requirement}", number(*value))]
pub struct SettingsError {
    /// Which setting.
    pub name: &'static str,
    /// What was given.
    pub value: f64,
    /// The range it must be in.
    pub requirement: &'static str,
}

pub(crate) fn check_positive(name: &'static str, value: f64) -> Result<(), SettingsError> {
    check(value > 0.0, name, value, "positive")
}

pub(crate) fn check_not_negative(name: &'static str, value: f64) -> Result<(), SettingsError> {
    check(value >= 0.0, name, value, "not negative")
}

pub(crate) fn check_at_least_one(name: &'static str, value: usize) -> Result<(), SettingsError> {
    check(value >= 1, name, value as f64, "at least 1")
}

pub(crate) fn check_at_most(
    name: &'static str,
    value: usize,
    (most, requirement): (usize, &'static str),
) -> Result<(), SettingsError> {
    check(value <= most, name, value as f64, requirement)
}

fn check(
    holds: bool,
    name: &'static str,
    value: f64,
    requirement: &'static str,
) -> Result<(), SettingsError> {
    if holds && value.is_finite() {
        return Ok(());
    }
    Err(SettingsError { name, value, requirement })
}

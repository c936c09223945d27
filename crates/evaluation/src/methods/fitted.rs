//! The constants that turn evidence into a probability, as they are kept.

use std::{collections::BTreeMap, path::Path};

use anyhow::{Context, Result};
use cloudtouch::Recalibration;
use cloudtouch_io::write_atomically;
use serde::{Deserialize, Serialize};

/// Where they are, seen from the project's folder.
const PLACE: &str = "crates/evaluation/recalibration.json";

/// Slopes and intercepts of two logistic regressions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Coefficients {
    /// Intercept, and slopes of crossing and deviations.
    pub by_geometry: [f64; 3],
    /// The same and the slope of ln(misclassified + 0.02).
    pub by_all: [f64; 4],
}

/// The fitted constants: those of the library, and for every family those fitted without it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fitted {
    /// How they were made.
    pub command: String,
    /// Fitted on all families.
    pub all: Coefficients,
    /// For each family, fitted on the others.
    pub without: BTreeMap<String, Coefficients>,
    /// The same for the oracle.
    pub oracle_without: BTreeMap<String, Coefficients>,
}

impl Fitted {
    /// The fit in the repository.
    ///
    /// # Errors
    /// When the file is not one.
    pub fn stored() -> Result<Self> {
        serde_json::from_str(include_str!("../../recalibration.json")).context(PLACE)
    }

    /// Constants that do not know a family, to judge answers about it: ours, or the oracle's.
    ///
    /// # Errors
    /// When a slope has the wrong sign.
    pub fn to_judge(&self, family: &str, is_oracle: bool) -> Result<Recalibration> {
        let without = if is_oracle { &self.oracle_without } else { &self.without };
        without.get(family).unwrap_or(&self.all).recalibration()
    }

    /// Keeps it.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn write(&self, root: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self)? + "\n";
        Ok(write_atomically(root.join(PLACE), |out| out.write_all(text.as_bytes()))?)
    }
}

impl Coefficients {
    fn recalibration(&self) -> Result<Recalibration> {
        let Self { by_geometry, by_all } = *self;
        let recalibration = Recalibration { by_geometry, by_all };
        recalibration.validate()?;
        Ok(recalibration)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_testkit::family::Family;

    use super::*;

    #[test]
    fn the_default_of_the_library_is_what_was_fitted() {
        let stored = Fitted::stored().unwrap();
        assert_eq!(stored.all.recalibration().unwrap(), Recalibration::default());
    }

    #[test]
    fn no_family_is_judged_with_constants_fitted_on_it() {
        let stored = Fitted::stored().unwrap();
        for family in Family::ALL {
            assert!(stored.without.contains_key(family.name()), "{}", family.name());
            assert!(stored.oracle_without.contains_key(family.name()), "{}", family.name());
        }
    }
}

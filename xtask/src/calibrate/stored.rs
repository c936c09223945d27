//! The fitted constants as they are kept: those of the library, and for every family those fitted
//! without it, with which it is judged.

use std::{collections::BTreeMap, path::Path};

use anyhow::{Context, Result};
use cloudtouch::Recalibration;
use serde::{Deserialize, Serialize};

use super::fit::Coefficients;
use crate::common::files::write_whole;

/// Where they are, from the root of the workspace.
const PLACE: &str = "xtask/recalibration.json";

/// All fits of one run.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Fitted {
    /// How they were made.
    pub command: String,
    /// On all families; the default of the library.
    pub all: Coefficients,
    /// On all families but this.
    pub without: BTreeMap<String, Coefficients>,
    /// The same for the oracle, whose evidence is cleaner.
    pub oracle_without: BTreeMap<String, Coefficients>,
}

impl Coefficients {
    /// For a query.
    pub(crate) fn recalibration(&self) -> Result<Recalibration> {
        let Self { by_geometry, by_all, .. } = *self;
        let recalibration = Recalibration { by_geometry, by_all };
        recalibration.validate()?;
        Ok(recalibration)
    }
}

impl Fitted {
    /// Those of the last fit.
    pub(crate) fn stored() -> Result<Self> {
        serde_json::from_str(include_str!("../../recalibration.json")).context(PLACE)
    }

    /// The constants that a family may be judged with; those of all where it took no part in any.
    pub(crate) fn to_judge(&self, family: &str) -> Result<Recalibration> {
        self.without.get(family).unwrap_or(&self.all).recalibration()
    }

    /// ... and those of the oracle.
    pub(crate) fn oracle_to_judge(&self, family: &str) -> Result<Recalibration> {
        self.oracle_without.get(family).unwrap_or(&self.all).recalibration()
    }

    pub(super) fn write(&self, root: &Path) -> Result<()> {
        write_whole(&root.join(PLACE), serde_json::to_string_pretty(self)? + "\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_of_the_library_is_what_was_fitted() {
        let stored = Fitted::stored().unwrap();
        assert_eq!(stored.all.recalibration().unwrap(), Recalibration::default());
    }

    #[test]
    fn no_family_is_judged_with_constants_fitted_on_it() {
        let stored = Fitted::stored().unwrap();
        for family in cloudtouch_testkit::family::Family::ALL {
            let is_mesh = *family == cloudtouch_testkit::family::Family::Tabletop;
            let name = family.name();
            assert_eq!(stored.without.contains_key(name), !is_mesh, "{name}");
            assert_eq!(stored.oracle_without.contains_key(name), !is_mesh, "{name}");
        }
    }
}

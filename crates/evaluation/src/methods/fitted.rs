//! The surfaces that turn evidence into a probability, as they are kept.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::path::Path;

use anyhow::{Context, Result};
use cloudtouch::Judge;
use cloudtouch_io::write_atomically;
use serde::{Deserialize, Serialize};

/// Where they are, seen from the project's folder.
const PLACE: &str = "crates/evaluation/judges.json";
/// ... and where the library has its default.
const SOURCE: &str = "crates/query/src/judge/fitted.rs";

/// What was fitted: the judge of the library, and for every family one fitted without it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Fitted {
    /// How they were made.
    pub command: String,
    /// Fitted on all families.
    pub all: Judge,
    /// For each family, fitted on the others.
    pub without: BTreeMap<String, Judge>,
    /// The same for the oracle.
    pub oracle_without: BTreeMap<String, Judge>,
}

impl Fitted {
    /// The fit in the repository.
    pub fn stored() -> Result<Self> {
        serde_json::from_str(include_str!("../../judges.json")).context(PLACE)
    }

    /// The fit in the repository as it is now: one just made is not compiled in yet.
    pub fn read(root: &Path) -> Result<Self> {
        serde_json::from_slice(&std::fs::read(root.join(PLACE)).context(PLACE)?).context(PLACE)
    }

    /// A judge that does not know a family, for answers about it: ours, or the oracle's.
    pub fn to_judge(&self, family: &str, is_oracle: bool) -> Judge {
        let without = if is_oracle { &self.oracle_without } else { &self.without };
        *without.get(family).unwrap_or(&self.all)
    }

    /// Keeps it, in the lab and as the library's default.
    pub fn write(&self, root: &Path) -> Result<()> {
        let text = serde_json::to_string(self)? + "\n";
        for (place, text) in [(PLACE, text), (SOURCE, self.as_source())] {
            write_atomically(root.join(place), |out| out.write_all(text.as_bytes()))?;
        }
        Ok(())
    }

    /// The default of the library as a Rust file, a row a line.
    pub fn as_source(&self) -> String {
        let Judge { by_geometry, over_extent, revised } = &self.all;
        let rows = |table: &dyn Debug| format!("{table:?}").replace("], [", "],\n    [");
        format!(
            "//! Made by `{} --update`.\n\n\
             #![allow(clippy::approx_constant, reason = \"what is fitted may look like π\")]\n\n\
             use super::knots::{{EXTENT_NOISES, NOISE_KNOTS, OverDoubt, OverExtent, OverGeometry}};\n\n\
             pub(super) const BY_GEOMETRY: [OverGeometry; NOISE_KNOTS.len()] = {};\n\n\
             pub(super) const OVER_EXTENT: [OverExtent; EXTENT_NOISES] = {};\n\n\
             pub(super) const REVISED: OverDoubt = {};\n",
            self.command,
            rows(by_geometry),
            rows(over_extent),
            rows(revised),
        )
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_testkit::family::Family;

    use super::*;

    #[test]
    fn the_default_of_the_library_is_what_was_fitted() {
        assert_eq!(Fitted::stored().unwrap().all, Judge::default());
    }

    #[test]
    fn no_family_is_judged_by_a_judge_fitted_on_it() {
        let stored = Fitted::stored().unwrap();
        for family in Family::ALL {
            assert!(stored.without.contains_key(family.name()), "{}", family.name());
            assert!(stored.oracle_without.contains_key(family.name()), "{}", family.name());
        }
    }
}

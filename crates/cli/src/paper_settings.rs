//! All settings of the paper's mode in one file.

use std::path::{Path, PathBuf};

use cloudtouch::noise::SensorModel;
use cloudtouch::{PaperCloudSettings, PaperModel, PaperSettings};
use serde::Deserialize;

/// The defaults with what they mean, as `cloudtouch settings` prints them.
pub(crate) const DEFAULTS: &str = include_str!("settings.toml");

/// What the file says; what it leaves out has its default.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Settings {
    pub query: PaperSettings,
    pub cloud: PaperModel,
}

/// A file, and what it says.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SettingsFile {
    pub path: PathBuf,
    pub settings: Settings,
}

/// Reads the file, and checks it as far as it goes without bodies.
pub(crate) fn read(path: &str) -> Result<SettingsFile, String> {
    let text = std::fs::read_to_string(Path::new(path)).map_err(|error| error.to_string())?;
    let settings: Settings = toml::from_str(&text).map_err(|error| error.to_string())?;
    settings.query.validate().map_err(|error| error.to_string())?;
    // Any sensor: a wrong one is told where it is given.
    let cloud = PaperCloudSettings::new(SensorModel::Exact);
    let cloud = PaperCloudSettings { model: settings.cloud, ..cloud };
    cloud.validate().map_err(|error| error.to_string())?;
    Ok(SettingsFile { path: path.into(), settings })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use std::collections::BTreeSet;

    use serde::Serialize;

    use super::*;

    /// Names of all values, with those of their tables.
    fn names(value: &serde_json::Value, above: &str) -> BTreeSet<String> {
        let Some(table) = value.as_object() else { return BTreeSet::from([above.to_owned()]) };
        table.iter().flat_map(|(name, value)| names(value, &format!("{above}.{name}"))).collect()
    }

    #[test]
    fn the_printed_settings_are_the_defaults_and_name_all_of_them() {
        assert_eq!(toml::from_str::<Settings>(DEFAULTS).unwrap(), Settings::default());
        #[derive(Serialize)]
        struct All {
            query: PaperSettings,
            cloud: PaperModel,
        }
        let Settings { query, cloud } = Settings::default();
        let all = serde_json::to_value(All { query, cloud }).unwrap();
        let printed: serde_json::Value = toml::from_str(DEFAULTS).unwrap();
        assert_eq!(names(&printed, ""), names(&all, ""));
    }

    #[test]
    fn a_file_that_named_one_value_of_the_tree_changed_another() {
        let read = |text: &str| toml::from_str::<Settings>(text).unwrap();
        for table in ["query", "query.closeness", "query.safeguards", "cloud", "cloud.tree"] {
            assert_eq!(read(&format!("[{table}]")), Settings::default(), "{table}");
        }
        let mut named = Settings::default();
        named.cloud.tree.max_leaf_points = 20;
        assert_eq!(read("[cloud.tree]\nmax_leaf_points = 20"), named);
    }

    #[test]
    fn a_wrong_name_or_value_is_refused_by_its_name() {
        let refused = |text: &str| {
            let path = tempfile::NamedTempFile::new().unwrap();
            std::fs::write(&path, text).unwrap();
            read(path.path().to_str().unwrap()).unwrap_err()
        };
        assert!(refused("[query]\ngama = 3.0").contains("gama"));
        assert!(refused("[query]\nkappa = 0.2").contains("kappa is 0.2"));
        assert!(refused("[cloud.tree]\nmax_variation = true").contains("max_variation"));
        assert!(refused("[cloud.tree]\nmax_variation = 0.5").contains("max_variation` is 0.5"));
        assert!(refused("[cloud.discretization]\nwidth = 0.0").contains("discretization.width"));
        let negative = refused("[cloud.motion]\ndeformation_std = -1.0");
        assert!(negative.contains("motion.deformation_std` is -1"), "{negative}");
    }
}

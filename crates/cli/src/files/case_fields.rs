//! Names of fields in a case file: what is passed over in silence would change nothing, whatever was meant.

use anyhow::{Result, bail};
use serde_json::{Map, Value};

use crate::files::near_name;

/// Fields that an answer depends on: what nearly has one of these names is an error, all else is passed over.
const USED: [&str; 6] = ["id", "scene", "object", "pose", "scene_sensor", "object_sensor"];

/// Fields of scene files, and options spelt as fields, that no case has, and what says the same of a case.
const OF_OTHERS: [(&str, &str); 36] = [
    ("sensor", SENSORS),
    ("unit", UNITS),
    ("mesh_unit", UNITS),
    ("cloud_unit", UNITS),
    ("scene_unit", UNITS),
    ("object_unit", UNITS),
    ("scale", UNITS),
    ("object_scale", UNITS),
    ("threshold", "give --reject, for all cases"),
    ("accept", OPTION),
    ("reject", OPTION),
    ("prior", OPTION),
    ("margin", OPTION),
    ("sensor_pose", OPTION),
    ("intrinsics", OPTION),
    ("depth_scale", OPTION),
    ("min_range", OPTION),
    ("max_range", OPTION),
    ("outliers", OPTION),
    ("keep_veil", OPTION),
    ("collision_map", OPTION),
    ("robot_padding", OPTION),
    ("max_unseen", OPTION),
    ("max_missing", OPTION),
    ("trust_units", OPTION),
    ("deadline", OPTION),
    ("translate", POSES),
    ("rotate_rpy", POSES),
    ("rotate_deg", POSES),
    ("quaternion", POSES),
    ("scene_pose", POSES),
    ("object_pose", POSES),
    ("pose_std", OF_ONE),
    ("pose_covariance", OF_ONE),
    ("also", SCANS),
    ("kappas", OF_ONE),
];
const OPTION: &str = "give it as an option of the command, for all cases";
const POSES: &str = "write all of the pose as 4 rows in `pose`";
const OF_ONE: &str = "ask about such a pair by `cloudtouch query`, which has an option for it";
const SCANS: &str = "merge the scans into one file, or ask by `cloudtouch query` with --also";
const SENSORS: &str = "write `scene_sensor` or `object_sensor` in each case, or give --sensor or \
                       --object-sensor for all";
const UNITS: &str = "give --unit for all meshes, --cloud-unit for all clouds";

/// Refuses names in a case that nearly are those of fields it lacks, and those that others have.
pub(crate) fn check(fields: &Map<String, Value>) -> Result<()> {
    let is_given = |name: &str| fields.contains_key(name);
    for (name, value) in fields.iter().filter(|(name, _)| !USED.contains(&name.as_str())) {
        if let Some(known) = near_name::meant(name, &USED, is_given) {
            bail!("there is no field `{name}`: is `{known}` meant? Then rename it");
        }
        // Beside the sensor that counts it is a note.
        let is_note = is_given("scene_sensor") && name.eq_ignore_ascii_case("sensor");
        // An answer that is handed on tells a margin as an object.
        let is_answer = name == "margin" && value.is_object();
        if is_note || is_answer || value.is_null() {
            continue;
        }
        if near_name::is_spelt(name, "length_unit") && value != "m" {
            bail!("`{name}` is in a case, and all are in metres: {UNITS}");
        }
        check_of_others(name)?;
    }
    Ok(())
}

/// The same for a name beside the cases.
pub(crate) fn check_beside(name: &str) -> Result<()> {
    if name == "scene_sensor" || name == "object_sensor" {
        bail!("`{name}` is beside the cases: {SENSORS}");
    }
    check_of_others(name)
}

fn check_of_others(name: &str) -> Result<()> {
    match OF_OTHERS.iter().find(|(other, _)| near_name::is_spelt(name, other)) {
        Some((_, remedy)) => {
            bail!("there is no field `{name}`: {remedy}; if it is a note, rename it")
        }
        None => Ok(()),
    }
}

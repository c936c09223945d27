//! Options that bodies of a file may say for themselves: where each of them does, an option is of none. What is said
//! of cameras is for those that say less.

use anyhow::{Result, ensure};
use cloudtouch_cli::files::scene::BodyEntry;

use crate::args::CommonArguments;
use crate::load::Kind;
use crate::usage::WrongUsage;

/// An option, whether it is given, and the field that goes before it.
struct Known {
    option: &'static str,
    is_given: bool,
    field: &'static str,
    /// What it is for, one and many.
    kind: [&'static str; 2],
    is_for: fn(Kind) -> bool,
    is_said: fn(&BodyEntry) -> bool,
}

/// Refuses an option where all that it is for has the field. `files` are those of bodies, with their entries, and
/// others, which have none.
pub(super) fn check<'a>(
    common: &CommonArguments,
    files: impl Iterator<Item = (Option<&'a BodyEntry>, Kind)> + Clone,
) -> Result<()> {
    let clouds = ["cloud", "clouds"];
    let all = [
        Known {
            option: "--sensor",
            is_given: common.sensor.is_some(),
            field: "sensor",
            kind: clouds,
            is_for: |kind| !kind.is_mesh(),
            is_said: |body| body.sensor.is_some(),
        },
        Known {
            option: "--unit",
            is_given: common.unit.is_some(),
            field: "unit",
            kind: ["mesh", "meshes"],
            is_for: Kind::is_mesh,
            is_said: |body| body.unit.is_some(),
        },
        Known {
            option: "--cloud-unit",
            is_given: common.cloud_unit.is_some(),
            field: "unit",
            kind: clouds,
            is_for: |kind| matches!(kind, Kind::Cloud(_)),
            is_said: |body| body.unit.is_some(),
        },
    ];
    for Known { option, is_given, field, kind: [one, many], is_for, is_said } in all {
        let mut bodies = files.clone().filter(|(_, kind)| is_for(*kind));
        let is_used = bodies.any(|(body, _)| !body.is_some_and(is_said));
        ensure!(
            is_used || !is_given,
            WrongUsage(format!(
                "{option} is for {many} without a `{field}` of their own, and each {one} has one: leave it out"
            ))
        );
    }
    Ok(())
}

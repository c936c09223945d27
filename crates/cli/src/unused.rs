//! Options that the files given have no use for: whoever gave one meant something by it.

use anyhow::{Result, bail};

use crate::args::BodyOptions;
use crate::load::{Kind, Role};
use crate::usage::WrongUsage;

/// Refuses options about clouds where no file is one, about depth images where none is, and about meshes
/// where none is. `files` are all that were read.
pub(crate) fn check(
    options: &BodyOptions<'_>,
    files: impl Iterator<Item = (Role, Kind)>,
) -> Result<()> {
    let common = options.common;
    let files: Vec<(Role, Kind)> = files.collect();
    let any_mesh = files.iter().any(|(_, kind)| kind.is_mesh());
    let any_cloud = files.iter().any(|(_, kind)| !kind.is_mesh());
    let any_image = files.iter().any(|(_, kind)| kind.is_depth_image());
    if common.unit.is_some() && !any_mesh && options.robot.is_empty() {
        let message = "--unit is for meshes, and no file is one: give --cloud-unit for clouds";
        bail!(WrongUsage(message.to_owned()));
    }
    if let Some(option) = common.depth.given().filter(|_| !any_image) {
        bail!(of_images(option));
    }
    let any_other = files.iter().any(|(_, kind)| matches!(kind, Kind::Cloud(_)));
    if common.cloud_unit.is_some() && any_image && !any_other {
        bail!(WrongUsage(CLOUD_UNIT.to_owned()));
    }
    let for_clouds = [
        ("--cloud-unit", common.cloud_unit.is_some()),
        ("--sensor", common.sensor.is_some()),
        ("--object-sensor", options.object_sensor.is_some()),
        ("--min-range", common.min_range.is_some()),
        ("--max-range", common.max_range.is_some()),
        ("--outliers", common.outliers.is_some()),
        ("--keep-veil", common.keep_veil),
        ("--max-unseen", common.caution.max_unseen.is_some()),
        ("--max-missing", common.caution.max_missing.is_some()),
        ("--refine", common.effort.refine.is_some()),
    ];
    if let Some((option, _)) = for_clouds.iter().find(|(_, is_given)| *is_given)
        && !any_cloud
    {
        bail!(of_clouds(option, "file"));
    }
    // Of clouds of one role only; the sensor of scenes is that of objects where these have none.
    if options.object_sensor.is_some() {
        let any_of = |role| files.iter().any(|(of, kind)| *of == role && !kind.is_mesh());
        if !any_of(Role::Object) {
            bail!(of_clouds("--object-sensor", "object"));
        }
        if common.sensor.is_some() && !any_of(Role::Scene) {
            bail!(of_clouds("--sensor", "scene"));
        }
    }
    Ok(())
}

/// Why a unit of clouds is refused where they are depth images.
pub(crate) const CLOUD_UNIT: &str = "--cloud-unit is not for depth images, which count in steps: give \
                                     --depth-scale, metres a step";

/// Why an option about depth images is refused where there is none.
pub(crate) fn of_images(option: &str) -> WrongUsage {
    WrongUsage(format!("{option} is for depth images (.png), and no file is one: leave it out"))
}

/// Why an option about clouds is refused where nothing of this role is one.
fn of_clouds(option: &str, role: &str) -> WrongUsage {
    WrongUsage(format!("{option} is for clouds, and no {role} is one: leave it out"))
}

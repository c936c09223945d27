//! Options that the files given have no use for: whoever gave one meant something by it.

use anyhow::{Result, bail};

use crate::args::CommonArguments;

/// Refuses options about clouds where no file is one, and about meshes where none is.
pub(crate) fn check(common: &CommonArguments, is_mesh: &[bool]) -> Result<()> {
    let (any_mesh, any_cloud) = (is_mesh.contains(&true), is_mesh.contains(&false));
    if common.unit.is_some() && !any_mesh && common.robot.is_empty() {
        bail!("--unit is for meshes, and no file is one: give --cloud-unit for clouds");
    }
    let of_clouds = [
        ("--cloud-unit", common.cloud_unit.is_some()),
        ("--object-sensor", common.object_sensor.is_some()),
        ("--min-range", common.min_range.is_some()),
        ("--max-range", common.max_range.is_some()),
        ("--outliers", common.outliers.is_some()),
        ("--keep-veil", common.keep_veil),
    ];
    if let Some((option, _)) = of_clouds.iter().find(|(_, is_given)| *is_given)
        && !any_cloud
    {
        bail!("{option} is for clouds, and no file is one: leave it out");
    }
    Ok(())
}

//! From files to bodies ready for queries.

mod frames;
mod geometry;
mod loaded;
mod of_clouds;
mod of_mesh;
pub(crate) mod path;
pub(crate) mod pose;
pub(crate) mod sensor_for;
mod short;
mod suited;
pub(crate) mod text;

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use cloudtouch::geom::{PointCloud, Pose};
use cloudtouch::{Cloud, SelfMesh};
use cloudtouch_io::{Geometry, LengthUnit, read_mesh_within};

use crate::args::BodyOptions;
use crate::body::PreparedCloud;
use crate::sensor::SensorChoice;
use crate::usage::WrongUsage;

use frames::Taken;
pub(crate) use geometry::{Kind, Units, check, geometry};
pub(crate) use loaded::{Input, Loaded, Role};
use of_clouds::of_clouds;
pub(crate) use of_mesh::SUSPICIOUS_MESH_SIZE;
use of_mesh::{of_mesh, prepared};
use short::named;

/// Reads a file and prepares it; a mesh file has no sensor.
pub(crate) fn body<C: PreparedCloud>(
    path: &Path,
    role: Role,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    bodies(&[path], role, sensor, options)
}

/// Reads a file that says its unit, and prepares it as a body of a scene.
pub(crate) fn body_in<C: PreparedCloud>(
    path: &Path,
    unit: Option<LengthUnit>,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    let usual = Units::of(options);
    let units = match unit {
        Some(unit) => Units { meshes: unit, clouds: unit, ..usual },
        None => usual,
    };
    bodies_in(&[path], units, Role::Scene, sensor, options)
}

/// Reads files and prepares them as one body: several scans of one frame, or one mesh.
pub(crate) fn bodies<C: PreparedCloud>(
    paths: &[&Path],
    role: Role,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    bodies_in(paths, Units::of(options), role, sensor, options)
}

fn bodies_in<C: PreparedCloud>(
    paths: &[&Path],
    units: Units<'_>,
    role: Role,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    let (mut scans, mut taken) = (Vec::new(), Vec::new());
    for path in paths {
        let read = geometry(path, units, &options.common.limits.read_limits())?;
        match read.geometry {
            Geometry::Mesh(mesh) if paths.len() == 1 => {
                return of_mesh(path, units.meshes, role, &mesh, options);
            }
            Geometry::Mesh(_) => bail!("{}: is a mesh: only scans make one scene", named(path)),
            Geometry::Cloud(cloud) => scans.push((cloud, read.kind)),
        }
        taken.extend(read.taken);
    }
    frames::check(&taken)?;
    if let Some((first, _)) = scans.first() {
        warn_of_place(&taken, role, first, sensor, options);
    }
    let names: Vec<String> = paths.iter().map(|path| named(path)).collect();
    let robot = if role == Role::Scene { robot(options)? } else { Vec::new() };
    of_clouds(&names, role, scans, sensor, options, robot)
}

/// Reads the surroundings of a robot, of which a scan may show these links.
pub(crate) fn surroundings(
    path: &Path,
    robot: Vec<SelfMesh>,
    options: &BodyOptions<'_>,
) -> Result<Loaded<Cloud>> {
    let common = options.common;
    let units = Units::of(options);
    let read = geometry(path, units, &common.limits.read_limits())?;
    match read.geometry {
        Geometry::Mesh(_) if !robot.is_empty() => bail!(WrongUsage(format!(
            "{}: a mesh does not show the robot: leave --scan-joints out",
            named(path)
        ))),
        Geometry::Mesh(mesh) => of_mesh(path, units.meshes, Role::Scene, &mesh, options),
        Geometry::Cloud(cloud) => {
            let taken: Vec<Taken> = read.taken.into_iter().collect();
            warn_of_place(&taken, Role::Scene, &cloud, common.scene_sensor(), options);
            let (scans, sensor) = (vec![(cloud, read.kind)], common.scene_sensor());
            of_clouds(&[named(path)], Role::Scene, scans, sensor, options, robot)
        }
    }
}

/// Warns of a scene out of a recording whose frame is no sensor's, where that matters.
fn warn_of_place(
    scans: &[Taken],
    role: Role,
    first: &PointCloud,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) {
    let is_told = options.sensor_pose.is_some() || options.collision_map.is_some();
    if role == Role::Scene && !is_told {
        frames::warn_of_place(scans, &sensor.of(first).sensor);
    }
}

fn robot(options: &BodyOptions<'_>) -> Result<Vec<SelfMesh>> {
    let common = options.common;
    options
        .robot
        .iter()
        .map(|path| {
            let unit = common.unit.unwrap_or_default();
            let mesh = read_mesh_within(path, unit, &common.limits.read_limits())?;
            let mesh = prepared(&mesh).with_context(|| named(path))?;
            Ok(SelfMesh {
                mesh: Arc::new(mesh),
                cloud_from_link: Pose::identity(),
                padding: options.robot_padding,
            })
        })
        .collect()
}

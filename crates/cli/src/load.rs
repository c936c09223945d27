//! From files to bodies ready for queries.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, bail};
use cloudtouch::geom::{Pose, TriangleMesh};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Mesh, SelfMesh};
use cloudtouch_io::{Geometry, LengthUnit, ReadLimits, read_geometry_within, read_mesh_within};

use crate::args::CommonArguments;
use crate::body::{Body, PreparedCloud};

/// What a body is used as: only scenes are cleaned of the robot and turned into collision maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Scene,
    Object,
}

/// A mesh this large is rather in millimetres than in metres, m.
pub(crate) const SUSPICIOUS_MESH_SIZE: f64 = 100.0;

/// Reads a file and prepares it; a mesh file has no sensor.
pub(crate) fn body<C: PreparedCloud>(
    path: &Path,
    role: Role,
    sensor: &SensorModel,
    common: &CommonArguments,
) -> Result<Body<C>> {
    bodies(&[path], role, sensor, common)
}

/// Reads files and prepares them as one body: several scans of one frame, or one mesh.
pub(crate) fn bodies<C: PreparedCloud>(
    paths: &[&Path],
    role: Role,
    sensor: &SensorModel,
    common: &CommonArguments,
) -> Result<Body<C>> {
    let name = || paths.iter().map(|path| named(path)).collect::<Vec<_>>().join(", ");
    let mut scans = Vec::new();
    for path in paths {
        match geometry(path, common.unit, &common.limits.read_limits())? {
            Geometry::Mesh(mesh) if paths.len() == 1 => return mesh_body(path, &mesh, common),
            Geometry::Mesh(_) => bail!("{}: is a mesh: only scans make one scene", named(path)),
            Geometry::Cloud(cloud) => {
                if cloud.covariances.is_some() && *sensor != SensorModel::PerPoint {
                    tracing::warn!(
                        "{}: its covariance columns are passed over for the sensor {sensor}: give \
                         --sensor per-point to use them",
                        path.display()
                    );
                }
                scans.push(cloud);
            }
        }
    }
    let robot = if role == Role::Scene { robot(common)? } else { Vec::new() };
    let prepared = C::prepare(&scans, *sensor, common.settings.as_ref(), |filter, sensor| {
        common.change(filter);
        if role == Role::Scene {
            filter.robot = robot;
            filter.collision_map = common.collision_map;
            if let Some(resolution) = common.collision_map {
                *sensor = SensorModel::Grid { resolution };
            }
        }
    });
    Ok(Body::Cloud(prepared.with_context(name)?))
}

fn mesh_body<C>(path: &Path, mesh: &TriangleMesh, common: &CommonArguments) -> Result<Body<C>> {
    let mesh = Mesh::prepare(mesh).with_context(|| named(path))?;
    if common.unit == LengthUnit::Metres && mesh.size() > SUSPICIOUS_MESH_SIZE {
        tracing::warn!(
            "{}: the mesh is {:.0} m across: if the file is in millimetres, give --unit mm",
            path.display(),
            mesh.size()
        );
    }
    Ok(Body::Mesh(mesh))
}

/// Reads a cloud, which is in metres, or a mesh in `unit`.
///
/// Scans know their unit and exported meshes do not, so that the two are often mixed.
pub(crate) fn geometry(path: &Path, unit: LengthUnit, limits: &ReadLimits) -> Result<Geometry> {
    // Said before the extension is looked at: `cloudtouch query folder …` is not about extensions.
    let found =
        std::fs::metadata(path).with_context(|| format!("{}: cannot be read", path.display()))?;
    if found.is_dir() {
        bail!("{}: is a folder: give a cloud or mesh file", path.display());
    }
    Ok(match read_geometry_within(path, LengthUnit::Metres, limits)? {
        Geometry::Mesh(mesh) => Geometry::Mesh(mesh.scaled(unit.in_metres())),
        cloud => cloud,
    })
}

fn robot(common: &CommonArguments) -> Result<Vec<SelfMesh>> {
    common
        .robot
        .iter()
        .map(|path| {
            let mesh = read_mesh_within(path, common.unit, &common.limits.read_limits())?;
            let mesh = Mesh::prepare(&mesh).with_context(|| named(path))?;
            Ok(SelfMesh {
                mesh: Arc::new(mesh),
                cloud_from_link: Pose::identity(),
                padding: common.robot_padding,
            })
        })
        .collect()
}

fn named(path: &Path) -> String {
    path.display().to_string()
}

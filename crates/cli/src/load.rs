//! From files to bodies ready for queries.

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result};
use cloudtouch::geom::Pose;
use cloudtouch::noise::SensorModel;
use cloudtouch::{Body, Cloud, Mesh, SelfMesh};
use cloudtouch_io::{Geometry, read_geometry, read_mesh};

use crate::args::CommonArguments;

/// What a body is used as: only scenes are cleaned of the robot and turned into collision maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Scene,
    Object,
}

/// Reads a file and prepares it; a mesh file has no sensor.
pub(crate) fn body(
    path: &Path,
    role: Role,
    sensor: &SensorModel,
    common: &CommonArguments,
) -> Result<Body> {
    let prepared = match read_geometry(path, common.unit)? {
        Geometry::Mesh(mesh) => Body::Mesh(Mesh::prepare(&mesh).with_context(|| named(path))?),
        Geometry::Cloud(cloud) => {
            let mut settings = common.cloud_settings(sensor.clone());
            if role == Role::Scene {
                settings.filter.robot = robot(common)?;
                settings.filter.collision_map = common.collision_map;
                if let Some(resolution) = common.collision_map {
                    settings.sensor = SensorModel::Grid { resolution };
                }
            }
            Body::Cloud(Cloud::prepare(&cloud, &settings).with_context(|| named(path))?)
        }
    };
    Ok(prepared)
}

fn robot(common: &CommonArguments) -> Result<Vec<SelfMesh>> {
    common
        .robot
        .iter()
        .map(|path| {
            let mesh = read_mesh(path, common.unit)?;
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

//! Prepares what is read from a mesh file.

use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use cloudtouch::geom::{MeshError, TriangleMesh};
use cloudtouch::{Mesh, PrepareError};
use cloudtouch_io::LengthUnit;

use crate::args::BodyOptions;
use crate::body::Body;
use crate::usage::{self, WrongUsage};

use super::geometry::Kind;
use super::loaded::{Input, Loaded, Role};
use super::short::{self, named};

/// A mesh this large is rather in millimetres than in metres, m.
pub(crate) const SUSPICIOUS_MESH_SIZE: f64 = 100.0;

pub(super) fn of_mesh<C>(
    path: &Path,
    unit: LengthUnit,
    role: Role,
    mesh: &TriangleMesh,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    let is_placed = options.sensor_pose.is_some();
    ensure!(!(is_placed && options.is_of_file), usage::of_a_mesh("sensor_pose", &named(path)));
    let of_clouds = [
        ("--robot", !options.robot.is_empty()),
        ("--collision-map", options.collision_map.is_some()),
        ("--sensor-pose", is_placed),
    ];
    if role == Role::Scene
        && let Some((option, _)) = of_clouds.iter().find(|(_, is_given)| *is_given)
    {
        bail!(WrongUsage(format!(
            "{}: {option} is for a scene that is a cloud, and this is a mesh: leave it out",
            named(path)
        )));
    }
    let mesh = prepared(mesh).with_context(|| named(path))?;
    if unit == LengthUnit::Metres && mesh.size() > SUSPICIOUS_MESH_SIZE {
        tracing::warn!(
            "{}: the mesh is {:.0} m across: if the file is in millimetres, give --unit mm",
            path.display(),
            mesh.size()
        );
    }
    let kind = Kind::Mesh(unit);
    let (file, unit) = (named(path), kind.unit());
    let short = short::of(std::slice::from_ref(&file));
    let input = Input { file, short, unit, sensor: None, sensor_because: None };
    Ok(Loaded { body: Body::Mesh(mesh), input, kinds: vec![kind] })
}

/// A mesh ready for queries.
pub(super) fn prepared(mesh: &TriangleMesh) -> Result<Mesh> {
    Mesh::prepare(mesh).map_err(|error| match error {
        // There are triangles, or it would not have been read.
        PrepareError::Mesh(MeshError::Empty) => anyhow!(
            "no triangle has an area, of {}: two corners of each are in one place; check the file",
            mesh.triangles().len()
        ),
        other => other.into(),
    })
}

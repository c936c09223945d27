//! From files to bodies ready for queries.

pub(crate) mod path;
pub(crate) mod pose;
pub(crate) mod sensor_for;
mod text;

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, anyhow, bail, ensure};
use cloudtouch::geom::{MeshError, PointCloud, Pose, TriangleMesh};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, Mesh, PrepareError, SelfMesh};
use cloudtouch_cli::numbers::Rigid;
use cloudtouch_io::{
    Geometry, LengthUnit, ReadLimits, check_extension, read_geometry_within, read_mesh_within,
    recording::file_of, scaled_cloud,
};
use serde::Serialize;

use crate::args::{BodyOptions, CommonArguments, Refine};
use crate::body::{Body, PreparedCloud};
use crate::sensor::{Chosen, SensorChoice};
use crate::usage::WrongUsage;

/// What a body is used as: only scenes are cleaned of the robot and turned into collision maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Role {
    Scene,
    Object,
}

/// A mesh this large is rather in millimetres than in metres, m.
pub(crate) const SUSPICIOUS_MESH_SIZE: f64 = 100.0;

/// A body and what it was taken for.
pub(crate) struct Loaded<C> {
    pub body: Body<C>,
    pub input: Input,
}

impl<C> Loaded<C> {
    pub(crate) fn is_mesh(&self) -> bool {
        matches!(self.body, Body::Mesh(_))
    }
}

impl<C: PreparedCloud> Loaded<C> {
    /// With the surface of a cloud computed everywhere, if that pays for so many poses.
    pub(crate) fn refined_for(self, poses: usize, refine: Refine) -> Result<Self> {
        Ok(match self.body {
            Body::Cloud(cloud) if refine.pays(cloud.count(), poses) => {
                let body = Body::Cloud(cloud.refined().with_context(|| self.input.file.clone())?);
                Self { body, ..self }
            }
            _ => self,
        })
    }
}

/// What a file was taken for: part of the answer, for slips to be seen.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Input {
    pub file: String,
    /// In which its coordinates were taken.
    pub unit: String,
    /// By its spec; a mesh has none.
    pub sensor: Option<String>,
    /// Why it was chosen, where `auto` was asked for.
    pub sensor_because: Option<&'static str>,
}

/// Reads a file and prepares it; a mesh file has no sensor.
pub(crate) fn body<C: PreparedCloud>(
    path: &Path,
    role: Role,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    bodies(&[path], role, sensor, options)
}

/// Reads a file that says its unit, and prepares it as an object.
pub(crate) fn body_in<C: PreparedCloud>(
    path: &Path,
    unit: Option<LengthUnit>,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    let usual = Units::of(options.common);
    let units = unit.map_or(usual, |unit| Units { meshes: unit, clouds: unit });
    bodies_in(&[path], units, Role::Object, sensor, options)
}

/// Reads files and prepares them as one body: several scans of one frame, or one mesh.
pub(crate) fn bodies<C: PreparedCloud>(
    paths: &[&Path],
    role: Role,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    bodies_in(paths, Units::of(options.common), role, sensor, options)
}

fn bodies_in<C: PreparedCloud>(
    paths: &[&Path],
    units: Units,
    role: Role,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    let mut scans = Vec::new();
    for path in paths {
        match geometry(path, units, &options.common.limits.read_limits())? {
            Geometry::Mesh(mesh) if paths.len() == 1 => {
                return of_mesh(path, units.meshes, role, &mesh, options);
            }
            Geometry::Mesh(_) => bail!("{}: is a mesh: only scans make one scene", named(path)),
            Geometry::Cloud(cloud) => scans.push(cloud),
        }
    }
    let names: Vec<String> = paths.iter().map(|path| named(path)).collect();
    let robot = if role == Role::Scene { robot(options)? } else { Vec::new() };
    of_clouds(&names.join(", "), (units.clouds, role), scans, sensor, options, robot)
}

/// Reads the surroundings of a robot, of which a scan may show these links.
pub(crate) fn surroundings(
    path: &Path,
    robot: Vec<SelfMesh>,
    options: &BodyOptions<'_>,
) -> Result<Loaded<Cloud>> {
    let common = options.common;
    let units = Units::of(common);
    match geometry(path, units, &common.limits.read_limits())? {
        Geometry::Mesh(mesh) => of_mesh(path, units.meshes, Role::Scene, &mesh, options),
        Geometry::Cloud(cloud) => {
            let scene = (units.clouds, Role::Scene);
            of_clouds(&named(path), scene, vec![cloud], common.scene_sensor(), options, robot)
        }
    }
}

fn of_mesh<C>(
    path: &Path,
    unit: LengthUnit,
    role: Role,
    mesh: &TriangleMesh,
    options: &BodyOptions<'_>,
) -> Result<Loaded<C>> {
    let of_clouds = [
        ("--robot", !options.robot.is_empty()),
        ("--collision-map", options.collision_map.is_some()),
        ("--sensor-pose", options.sensor_pose.is_some()),
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
    let unit = unit.to_string();
    let input = Input { file: named(path), unit, sensor: None, sensor_because: None };
    Ok(Loaded { body: Body::Mesh(mesh), input })
}

fn prepared(mesh: &TriangleMesh) -> Result<Mesh> {
    Mesh::prepare(mesh).map_err(|error| match error {
        // There are triangles, or it would not have been read.
        PrepareError::Mesh(MeshError::Empty) => anyhow!(
            "no triangle has an area, of {}: two corners of each are in one place; check the file",
            mesh.triangles().len()
        ),
        other => other.into(),
    })
}

/// The sensor of several scans is that chosen for the first.
fn of_clouds<C: PreparedCloud>(
    name: &str,
    (unit, role): (LengthUnit, Role),
    mut scans: Vec<PointCloud>,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
    robot: Vec<SelfMesh>,
) -> Result<Loaded<C>> {
    if role == Role::Scene
        && let Some(Rigid(pose)) = options.sensor_pose
    {
        let several = "--sensor-pose is for one scan, and these are several";
        ensure!(scans.len() == 1, WrongUsage(format!("{name}: {several}")));
        scans.iter_mut().for_each(|scan| scan.sensor_pose = Some(pose));
    }
    let first = scans.first().with_context(|| format!("{name}: no scan"))?;
    let Chosen { sensor, because } = sensor.of(first);
    if scans.iter().any(|scan| scan.covariances.is_some()) && sensor != SensorModel::PerPoint {
        tracing::warn!(
            "{name}: its covariance columns are passed over for the sensor {sensor}: give \
             --sensor per-point to use them"
        );
    }
    let settings = options.settings.map(|file| &file.settings);
    let prepared = C::prepare(&scans, sensor, settings, |filter, sensor| {
        options.common.change(filter);
        if role == Role::Scene {
            filter.robot = robot;
            filter.collision_map = options.collision_map;
            if let Some(resolution) = options.collision_map {
                *sensor = SensorModel::Grid { resolution };
            }
        }
    });
    let input = Input {
        file: name.to_owned(),
        unit: unit.to_string(),
        sensor: Some(sensor.to_string()),
        sensor_because: because,
    };
    Ok(Loaded { body: Body::Cloud(prepared.with_context(|| name.to_owned())?), input })
}

/// What the coordinates of files are in.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Units {
    pub meshes: LengthUnit,
    pub clouds: LengthUnit,
}

impl Units {
    fn of(common: &CommonArguments) -> Self {
        Self {
            meshes: common.unit.unwrap_or_default(),
            clouds: common.cloud_unit.unwrap_or_default(),
        }
    }
}

/// Whether a file is there and has an extension that is read: asked of all files before any is read.
pub(crate) fn check(path: &Path) -> Result<()> {
    // Said before the extension is looked at: `cloudtouch query folder …` is not about extensions.
    let found = std::fs::metadata(file_of(path))
        .with_context(|| format!("{}: cannot be read", path.display()))?;
    ensure!(!found.is_dir(), "{}: is a folder: give a cloud or mesh file", path.display());
    ensure!(
        found.is_file() || path.extension().is_some(),
        "{}: is no file, and its name does not tell the format: save it to one, such as scan.pcd",
        path.display()
    );
    Ok(check_extension(path)?)
}

/// Reads a cloud or a mesh in its own unit: scans mostly know theirs and exported meshes do not, so
/// that the two are often mixed.
pub(crate) fn geometry(path: &Path, units: Units, limits: &ReadLimits) -> Result<Geometry> {
    check(path)?;
    Ok(match read_geometry_within(path, LengthUnit::Metres, limits)? {
        Geometry::Mesh(mesh) => Geometry::Mesh(mesh.scaled(units.meshes.in_metres())),
        Geometry::Cloud(cloud) => Geometry::Cloud(scaled_cloud(cloud, units.clouds.in_metres())),
    })
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

fn named(path: &Path) -> String {
    path.display().to_string()
}

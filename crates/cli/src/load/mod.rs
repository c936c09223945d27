//! From files to bodies ready for queries.

mod frames;
mod geometry;
pub(crate) mod path;
pub(crate) mod pose;
pub(crate) mod sensor_for;
mod short;
mod suited;
pub(crate) mod text;

use std::path::Path;
use std::sync::Arc;

use anyhow::{Context, Result, anyhow, bail, ensure};
use cloudtouch::geom::{MeshError, PointCloud, Pose, TriangleMesh};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, Mesh, PrepareError, SelfMesh};
use cloudtouch_cli::numbers::Rigid;
use cloudtouch_io::{Geometry, LengthUnit, read_mesh_within};
use serde::Serialize;

use crate::args::{BodyOptions, Refine};
use crate::body::{Body, PreparedCloud};
use crate::sensor::{Chosen, SensorChoice};
use crate::usage::{self, WrongUsage};

use frames::Taken;
pub(crate) use geometry::{Kind, Units, check, geometry};

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
    /// What its files were taken for: of a body made of several scans, each of them.
    pub kinds: Vec<Kind>,
}

impl<C> Loaded<C> {
    pub(crate) fn is_mesh(&self) -> bool {
        matches!(self.body, Body::Mesh(_))
    }

    /// What its files are, each with what the body is used as.
    pub(crate) fn files(&self, role: Role) -> impl Iterator<Item = (Role, Kind)> {
        self.kinds.iter().map(move |kind| (role, *kind))
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
    /// The same without folders, as a page names it.
    #[serde(skip)]
    pub short: String,
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

fn of_mesh<C>(
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

/// The sensor of several scans is that chosen for the first; each has its name.
fn of_clouds<C: PreparedCloud>(
    names: &[String],
    role: Role,
    scans: Vec<(PointCloud, Kind)>,
    sensor: SensorChoice,
    options: &BodyOptions<'_>,
    robot: Vec<SelfMesh>,
) -> Result<Loaded<C>> {
    let name = names.join(", ");
    let name = name.as_str();
    let (mut scans, kinds): (Vec<PointCloud>, Vec<Kind>) = scans.into_iter().unzip();
    if role == Role::Scene
        && let Some(Rigid(pose)) = options.sensor_pose
    {
        let several = "--sensor-pose is for one scan, and these are several";
        ensure!(scans.len() == 1, WrongUsage(format!("{name}: {several}")));
        for (scan, kind) in scans.iter_mut().zip(&kinds) {
            // Other files have their points in some frame, and a depth image only where its camera stood.
            if kind.is_depth_image() {
                *scan = scan.transformed(&pose);
            }
            scan.sensor_pose = Some(pose);
        }
    }
    if scans.len() > 1 && kinds.iter().any(|kind| kind.is_depth_image()) {
        tracing::warn!(
            "{name}: a depth image is in the frame of its camera, and several scans are taken to be in one: \
             that is so of a camera that stood still; if it moved, make each a body of a scene file, with \
             its pose"
        );
    }
    let first = scans.first().with_context(|| format!("{name}: no scan"))?;
    // The boxes of a map are as noisy as they are large, whatever saw what is in them.
    let collision_map = options.collision_map.filter(|_| role == Role::Scene);
    let grid = collision_map.map(|resolution| SensorModel::Grid { resolution });
    let Chosen { sensor, because } = sensor.of(first);
    if scans.iter().any(|scan| scan.covariances.is_some()) && sensor != SensorModel::PerPoint {
        tracing::warn!(
            "{name}: its covariance columns are passed over for the sensor {sensor}: give \
             --sensor per-point to use them"
        );
    }
    suited::check_max_range(name, first, &sensor, options)?;
    if let Some(cell) = collision_map {
        suited::warn_of_small_cells(name, first, (&sensor, cell), options);
    }
    let settings = options.settings.map(|file| &file.settings);
    let prepared = C::prepare(&scans, sensor, settings, |filter, sensor| {
        options.common.change(filter);
        if role == Role::Scene {
            filter.robot = robot;
            filter.collision_map = collision_map;
        }
        *sensor = grid.unwrap_or(*sensor);
    });
    let mut units: Vec<String> = kinds.iter().map(|kind| kind.unit()).collect();
    units.dedup();
    let input = Input {
        file: name.to_owned(),
        short: short::of(names),
        unit: units.join(", "),
        sensor: Some(grid.unwrap_or(sensor).to_string()),
        sensor_because: because.filter(|_| grid.is_none()),
    };
    let prepared = prepared.map_err(|error| match error {
        PrepareError::Scan { scan, error, .. } => anyhow!(*error).context(names[scan - 1].clone()),
        PrepareError::RepeatedScan { scan } => anyhow!("{error}").context(names[scan - 1].clone()),
        other => anyhow!(other).context(name.to_owned()),
    })?;
    Ok(Loaded { body: Body::Cloud(prepared), input, kinds })
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

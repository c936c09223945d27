//! Prepares what is read from the files of scans as one cloud.

use anyhow::{Context, Result, anyhow, ensure};
use cloudtouch::geom::PointCloud;
use cloudtouch::noise::SensorModel;
use cloudtouch::{PrepareError, SelfMesh};
use cloudtouch_cli::numbers::Rigid;

use crate::args::BodyOptions;
use crate::body::{Body, PreparedCloud};
use crate::sensor::{Chosen, SensorChoice};
use crate::usage::WrongUsage;

use super::geometry::Kind;
use super::loaded::{Input, Loaded, Role};
use super::{short, suited};

/// The sensor of several scans is that chosen for the first; each has its name.
pub(super) fn of_clouds<C: PreparedCloud>(
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
    if role == Role::Scene {
        place(name, (&mut scans, &kinds), options)?;
    }
    warn_of_frames(name, &kinds);
    let first = scans.first().with_context(|| format!("{name}: no scan"))?;
    let Chosen { sensor, because } = sensor.of(first);
    warn_of_covariances(name, &scans, sensor);
    suited::check_max_range(name, first, &sensor, options)?;
    // The boxes of a map are as noisy as they are large, whatever saw what is in them.
    let collision_map = options.collision_map.filter(|_| role == Role::Scene);
    if let Some(cell) = collision_map {
        suited::warn_of_small_cells(name, first, (&sensor, cell), options);
    }
    let grid = collision_map.map(|resolution| SensorModel::Grid { resolution });
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
        PrepareError::Scan { scan, error, .. } => anyhow!(*error).context(names[scan].clone()),
        PrepareError::RepeatedScan { scan } => anyhow!("{error}").context(names[scan].clone()),
        other => anyhow!(other).context(name.to_owned()),
    })?;
    Ok(Loaded { body: Body::Cloud(prepared), input, kinds })
}

/// Tells a scan where its sensor stood, if that is said.
fn place(
    name: &str,
    (scans, kinds): (&mut [PointCloud], &[Kind]),
    options: &BodyOptions<'_>,
) -> Result<()> {
    let Some(Rigid(pose)) = options.sensor_pose else { return Ok(()) };
    let several = "--sensor-pose is for one scan, and these are several";
    ensure!(scans.len() == 1, WrongUsage(format!("{name}: {several}")));
    for (scan, kind) in scans.iter_mut().zip(kinds) {
        // Other files have their points in some frame, and a depth image only where its camera stood.
        if kind.is_depth_image() {
            *scan = scan.transformed(&pose);
        }
        scan.sensor_pose = Some(pose);
    }
    Ok(())
}

/// Warns of several scans that can be in one frame only if their camera stood still.
fn warn_of_frames(name: &str, kinds: &[Kind]) {
    if kinds.len() > 1 && kinds.iter().any(|kind| kind.is_depth_image()) {
        tracing::warn!(
            "{name}: a depth image is in the frame of its camera, and several scans are taken to be in one: \
             that is so of a camera that stood still; if it moved, make each a body of a scene file, with \
             its pose"
        );
    }
}

/// Warns of noise that files bring and that is not used.
fn warn_of_covariances(name: &str, scans: &[PointCloud], sensor: SensorModel) {
    if scans.iter().any(|scan| scan.covariances.is_some()) && sensor != SensorModel::PerPoint {
        tracing::warn!(
            "{name}: its covariance columns are passed over for the sensor {sensor}: give \
             --sensor per-point to use them"
        );
    }
}

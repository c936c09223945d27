//! Bodies that nobody has prepared yet: two clouds, and depth frames with a gripper.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use cloudtouch::{
    Cloud, CloudSettings, FilterSettings, Mesh, Query, QuerySettings, noise::SensorModel,
};
use cloudtouch_geom::{PointCloud, Pose, seed};
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};
use cloudtouch_testkit::{
    family::{Family, Side},
    noise::NoiseKind,
};

use super::{
    scene::{Class, POINTS, STD, Scene},
    timing::{p95, time, timed, times},
};
use crate::{
    real_scans::cases,
    report::{Findings, Section, Table, Target},
    statistics::median,
};

/// Frames of each kind, returns of a frame, and poses asked of it.
const FRAMES: usize = 20;
const RETURNS: usize = 40_000;
const POSES: usize = 10;
/// Standard deviation of a simulated depth at 1 m, growing with its square, m.
const DEPTH_STD: f64 = 0.002;
/// Standard deviation that the real scan is said to have, m.
const SCAN_STD: f64 = 0.005;
/// Preparation and ten poses may take this long, s.
const LIMIT: f64 = 0.025;

/// A cloud prepared with a noise of this standard deviation.
pub(super) fn prepare(cloud: &PointCloud, std: f64) -> Result<Cloud> {
    let sensor = SensorModel::Isotropic { std };
    Ok(Cloud::prepare(cloud, &CloudSettings::new(sensor))?)
}

/// Prepares both clouds anew for every near pose.
pub(super) fn first_query(scene: &Scene) -> Findings {
    let (room, piano) = (scene.room(POINTS, STD), scene.piano(STD));
    let query = Query::new(QuerySettings::default())?;
    let mut parts = [const { Vec::new() }; 3];
    for pose in scene.of(Class::Near) {
        let both = || Ok((prepare(&room.cloud, STD)?, prepare(&piano.cloud, STD)?));
        let ((a, b), preparing) = timed(both)?;
        let (_, asking) = timed(|| Ok(query.run(&a, &b, &pose.scene_from_object)?))?;
        for (list, value) in parts.iter_mut().zip([preparing, asking, preparing + asking]) {
            list.push(value);
        }
    }
    let mut table = Table::new(["part", "median", "p95"]);
    for (name, part) in ["prepare both clouds", "first query", "both"].into_iter().zip(&parts) {
        let [median, p95] = times(part);
        table.row([name.to_owned(), median, p95]);
    }
    let what = "first query of a fresh 10k pair, preparation included: near, median ≤ 15 ms";
    let both = median(&parts[2]);
    let target = Target::new(what, time(both), both <= 0.015);
    let section = Section::new("First query of two fresh clouds").text(format_args!(
        "The near poses again, {} of them, with {:.0} mm of noise. Both clouds are prepared anew for \
         each: filter, sensor model, neighbour index, tree. The query then computes the noise model \
         where it looks; its answers are those of the prepared queries.",
        parts[2].len(),
        1e3 * STD,
    ));
    Ok((section.text(table), vec![target]))
}

/// Depth frames, each prepared anew and asked about ten poses of a gripper.
pub(super) fn frames(scene: &Scene, data: Option<&Path>) -> Findings {
    let mut table =
        Table::new(["frames", "prepare", "ten poses", "both", "both, p95", "wrong at ½"]);
    let mut targets = Vec::new();
    let mut add = |name: &str, frames: Frames| {
        let [prepare, queries] = [&frames.prepare, &frames.queries].map(|part| time(median(part)));
        let both: Vec<f64> =
            frames.prepare.iter().zip(&frames.queries).map(|(p, q)| p + q).collect();
        let (middle, p95) = (median(&both), time(p95(&both)));
        let wrong = format!("{} of {}", frames.wrong, frames.known);
        table.row([name.to_owned(), prepare, queries, time(middle), p95, wrong]);
        let what =
            format!("40k-point depth frame ({name}), prepared, and 10 gripper poses ≤ 25 ms");
        targets.push(Target::new(what, time(middle), middle <= LIMIT));
    };
    add("simulated", simulated(scene.seed)?);
    if let Some(data) = data {
        add("stereo scan", real(data)?);
    }
    let section = Section::new("Depth frames and a gripper").text(format_args!(
        "{FRAMES} frames of about {RETURNS} returns, as a camera at 20 Hz has 50 ms for. *Prepare* \
         is all of it: near returns and veils dropped, sensor model, neighbour index, tree. Then \
         {POSES} poses of a gripper, known as a mesh and prepared once, are asked of the frame, \
         first queries all of them. Medians over frames. Simulated frames are of household objects \
         on a table, each drawn anew ({:.0} mm of depth noise at 1 m, veils at edges). The stereo \
         scan of a mug on a table is thinned to as many returns ({:.0} mm of noise said); its clear \
         cases count as known.",
        1e3 * DEPTH_STD,
        1e3 * SCAN_STD,
    ));
    Ok((section.text(table), targets))
}

/// Times of frames, s, and answers on the wrong side of ½ among those that are known.
#[derive(Default)]
struct Frames {
    prepare: Vec<f64>,
    queries: Vec<f64>,
    wrong: usize,
    known: usize,
}

impl Frames {
    /// One frame: preparation and all queries on one thread.
    fn ask(
        &mut self,
        frame: &PointCloud,
        sensor: SensorModel,
        gripper: &Mesh,
        poses: &[(Pose, Option<bool>)],
    ) -> Result<()> {
        // The stages that suit a camera.
        let filter = FilterSettings::for_sensor(&SensorModel::Kinect);
        let settings = CloudSettings { filter, ..CloudSettings::new(sensor) };
        let query = Query::new(QuerySettings::default())?;
        let (cloud, prepare) = timed(|| Ok(Cloud::prepare(frame, &settings)?))?;
        let run = |(pose, _): &(Pose, Option<bool>)| {
            anyhow::Ok(query.run(&cloud, gripper, pose)?.collision_probability >= 0.5)
        };
        let (said, queries) = timed(|| poses.iter().map(run).collect::<Result<Vec<bool>>>())?;
        self.prepare.push(prepare);
        self.queries.push(queries);
        for (said, (_, known)) in said.into_iter().zip(poses) {
            self.known += usize::from(known.is_some());
            self.wrong += usize::from(known.is_some_and(|collides| collides != said));
        }
        Ok(())
    }
}

fn simulated(from: u64) -> Result<Frames> {
    let scene = Family::Tabletop.scene(seed::derive(from, 3, 0));
    let poses: Vec<(Pose, Option<bool>)> = scene
        .poses(4 * POSES, seed::derive(from, 3, 1))
        .iter()
        .map(|p| (p.scene_from_object, Some(p.in_collision)))
        .collect();
    let gripper = Mesh::prepare(scene.b.mesh())?;
    let mut frames = Frames::default();
    for (number, asked) in (0..FRAMES).zip(poses.chunks(POSES).cycle()) {
        let draw = seed::derive(from, 4, number as u64);
        let frame = scene.observe(Side::A, RETURNS, NoiseKind::Gaussian, DEPTH_STD, draw).cloud;
        frames.ask(&frame, SensorModel::PerPoint, &gripper, asked)?;
    }
    Ok(frames)
}

/// The approach series of the stereo scan, ten poses of it.
fn real(data: &Path) -> Result<Frames> {
    let series = cases::series(data)?;
    let every = series.len().div_ceil(POSES);
    let series: Vec<_> =
        series.into_iter().map(|(_, case)| case).skip(every - 1).step_by(every).collect();
    ensure!(series.len() == POSES, "{} poses of a series, not {POSES}", series.len());
    let frame = thinned(&read_cloud(&series[0].scene)?, RETURNS)?;
    let gripper = Mesh::prepare(&read_mesh(&series[0].object, LengthUnit::Metres)?)?;
    let known = |label: &str| match label {
        "free" => Some(false),
        "collision" => Some(true),
        _ => None,
    };
    let poses: Vec<_> = series.iter().map(|case| (case.pose, known(&case.label))).collect();
    let mut frames = Frames::default();
    for _ in 0..FRAMES {
        frames.ask(&frame, SensorModel::Isotropic { std: SCAN_STD }, &gripper, &poses)?;
    }
    Ok(frames)
}

/// The depth image with rows and columns left out evenly until about so many returns remain.
fn thinned(cloud: &PointCloud, returns: usize) -> Result<PointCloud> {
    let (width, height) = cloud.image_size.context("the scan is no depth image")?;
    let all = cloud.points.iter().filter(|p| p.iter().all(|v| v.is_finite())).count();
    let step = (all as f64 / returns as f64).sqrt().max(1.0);
    let kept = |count: usize| -> Vec<usize> {
        (0..).map(|i| (f64::from(i) * step) as usize).take_while(|&i| i < count).collect()
    };
    let (columns, rows) = (kept(width), kept(height));
    let pixels = rows.iter().flat_map(|&row| columns.iter().map(move |c| row * width + c));
    let points = pixels.map(|i| cloud.points[i]).collect();
    let image_size = Some((columns.len(), rows.len()));
    Ok(PointCloud { points, image_size, covariances: None, normals: None, ..cloud.clone() })
}

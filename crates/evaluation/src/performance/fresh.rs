//! Bodies that nobody has prepared yet: two clouds, and depth frames with a gripper.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use cloudtouch::noise::SensorModel;
use cloudtouch::{Cloud, CloudSettings, FilterSettings, Mesh, Query, QuerySettings, Report};
use cloudtouch_geom::seed::derive;
use cloudtouch_geom::{PointCloud, Pose};
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};
use cloudtouch_testkit::exact::ExactMesh;
use cloudtouch_testkit::family::{Family, Observation, Side};
use cloudtouch_testkit::noise::NoiseKind;
use cloudtouch_testkit::poses::{LabelledPose, poses_near_contact};
use cloudtouch_testkit::poses_by_class::Class;
use cloudtouch_testkit::scene::cuboid;
use rayon::ThreadPoolBuilder;

use super::scene::{POINTS, STD, Scene, seeds};
use super::timing::{p95, time, timed, within};
use crate::SEED;
use crate::methods::{prepared, sampled};
use crate::real_scans::cases;
use crate::report::{Findings, Section, Table};
use crate::statistics::median;

/// Frames of each kind, returns of a frame, and poses asked of it.
const FRAMES: usize = 20;
const RETURNS: usize = 40_000;
const POSES: usize = 10;
/// Standard deviation of a simulated depth at 1 m, growing with its square, m.
const DEPTH_STD: f64 = 0.002;
/// Standard deviation that the real scan is said to have, m.
const SCAN_STD: f64 = 0.005;
/// Standard deviations of things much blurred for their size, m: boxes of 12 cm with a sample every 3 mm, and
/// poses asked of each pair.
const BLURRED: [f64; 2] = [0.01, 0.02];
const BOX_POSES: usize = 30;

/// A pose, and whether it collides where that is known.
type Labelled = (Pose, Option<bool>);

/// Two clouds for every near pose, and depth frames for ten poses of a gripper.
pub(super) fn measure(scene: &Scene, data: Option<&Path>) -> Findings {
    let head = ["bodies", "prepare", "on two", "ask", "both", "both, p95", "wrong at ½"];
    let mut table = Table::new(head);
    let mut targets = Vec::new();
    let mut add = |name: &str, what: &str, limit: f64, fresh: Fresh| {
        let parts = [&fresh.prepare, &fresh.on_two, &fresh.ask];
        let [prepare, on_two, ask] = parts.map(|part| time(median(part)));
        let both: Vec<f64> = fresh.prepare.iter().zip(&fresh.ask).map(|(p, q)| p + q).collect();
        let middle = median(&both);
        let wrong = format!("{} of {}", fresh.wrong, fresh.known);
        table.row([name.to_owned(), prepare, on_two, ask, time(middle), time(p95(&both)), wrong]);
        targets.push(within(what, middle, limit));
    };
    let what = "first query of a fresh 10k pair, preparation included: near, median";
    add("two clouds", what, 0.015, clouds(scene)?);
    for std in BLURRED {
        let name = format!("two boxes, {:.0} mm", 1e3 * std);
        let what = format!("{name} of noise, prepared, and {BOX_POSES} poses");
        add(&name, &what, 0.005 * BOX_POSES as f64, boxes(std)?);
    }
    let frame = |kind| format!("40k-point depth frame ({kind}), prepared, and 10 gripper poses");
    add("simulated frame", &frame("simulated"), 0.02, simulated()?);
    if let Some(data) = data {
        add("stereo scan", &frame("stereo scan"), 0.025, real(data)?);
    }
    let section = Section::new("Fresh clouds and depth frames").text(format_args!(
        "*Two clouds*: the near poses again, with {:.0} mm of noise. Both clouds are prepared anew for each: filter, \
         sensor model, neighbour index, tree; *on two* threads too. The query then computes the noise model where it \
         looks; its answers are those of the prepared queries.\n\n*Two boxes* of 12 cm in {POINTS} points each, much \
         blurred for their size as by a stereo camera: {BOX_POSES} poses near contact are asked of each of three \
         pairs; times are of all.\n\n*Frames*: {FRAMES} of about {RETURNS} returns, as a camera at 20 Hz has 50 ms \
         for. *Prepare* is all of it: near returns and veils dropped, sensor model, neighbour index, tree. Then \
         {POSES} poses of a gripper, known as a mesh and prepared once, are asked of the frame, first queries all of \
         them. Simulated frames are of household objects on a table, each drawn anew ({:.0} mm of depth noise at 1 m, \
         veils at edges). The stereo scan of a mug on a table is thinned to as many returns ({:.0} mm of noise said); \
         its clear cases count as known. Times are medians where nothing else is said.",
        1e3 * STD,
        1e3 * DEPTH_STD,
        1e3 * SCAN_STD,
    ));
    Ok((section.text(table), targets))
}

/// Times of bodies prepared anew, s, and answers on the wrong side of ½ among those that are known.
#[derive(Default)]
struct Fresh {
    prepare: Vec<f64>,
    /// The same on two threads.
    on_two: Vec<f64>,
    ask: Vec<f64>,
    wrong: usize,
    known: usize,
}

impl Fresh {
    /// Preparation, and all queries on one thread.
    fn add<B: Send>(
        &mut self,
        prepare: impl Fn() -> Result<B> + Sync,
        ask: impl Fn(&B, &Pose) -> Result<Report>,
        poses: &[Labelled],
    ) -> Result<()> {
        let two = ThreadPoolBuilder::new().num_threads(2).build().context("start threads")?;
        two.install(&prepare)?;
        self.on_two.push(timed(|| two.install(&prepare))?.1);
        let (bodies, seconds) = timed(prepare)?;
        self.prepare.push(seconds);
        let run = |(pose, _): &Labelled| ask(&bodies, pose);
        let (said, seconds) = timed(|| poses.iter().map(run).collect::<Result<Vec<Report>>>())?;
        self.ask.push(seconds);
        for (said, (_, known)) in said.into_iter().zip(poses) {
            let says = said.collision_probability >= 0.5;
            self.known += usize::from(known.is_some());
            self.wrong += usize::from(known.is_some_and(|collides| collides != says));
        }
        Ok(())
    }

    fn add_pair(&mut self, [a, b]: [&Observation; 2], poses: &[Labelled]) -> Result<()> {
        let query = Query::new(QuerySettings::default())?;
        let both = || Ok((prepared(a)?, prepared(b)?));
        self.add(both, |(a, b), pose| Ok(query.run(a, b, pose)?), poses)
    }

    fn add_frame(
        &mut self,
        frame: &PointCloud,
        sensor: SensorModel,
        gripper: &Mesh,
        poses: &[Labelled],
    ) -> Result<()> {
        // The stages that suit a camera.
        let filter = FilterSettings::for_sensor(&SensorModel::Kinect);
        let settings = CloudSettings { filter, ..CloudSettings::new(sensor) };
        let query = Query::new(QuerySettings::default())?;
        let prepare = || Ok(Cloud::prepare(frame, &settings)?);
        self.add(prepare, |cloud, pose| Ok(query.run(cloud, gripper, pose)?), poses)
    }
}

fn clouds(scene: &Scene) -> Result<Fresh> {
    let (room, piano) = (scene.room(POINTS, STD), scene.piano(STD));
    let mut fresh = Fresh::default();
    let near = scene.poses.iter().filter(|pose| Class::of(pose) == Some(Class::Near));
    for pose in near.copied() {
        fresh.add_pair([&room, &piano], &known(&[pose]))?;
    }
    Ok(fresh)
}

fn boxes(std: f64) -> Result<Fresh> {
    let cube = cuboid([0.12; 3]);
    let exact = ExactMesh::new(&cube);
    let poses = known(&poses_near_contact(&exact, &exact, BOX_POSES, derive(SEED, 5, 0)));
    let mut fresh = Fresh::default();
    for draw in 0..3 {
        let [a, b] =
            [0, 1].map(|side| sampled(&cube, POINTS, std, seeds(derive(SEED, 6 + side, draw))));
        fresh.add_pair([&a, &b], &poses)?;
    }
    Ok(fresh)
}

/// Poses with what the exact surfaces say.
fn known(poses: &[LabelledPose]) -> Vec<Labelled> {
    poses.iter().map(|pose| (pose.scene_from_object, Some(pose.in_collision))).collect()
}

fn simulated() -> Result<Fresh> {
    let scene = Family::Tabletop.scene(derive(SEED, 3, 0));
    let poses = known(&scene.poses(4 * POSES, derive(SEED, 3, 1)));
    let gripper = Mesh::prepare(scene.b.mesh())?;
    let mut fresh = Fresh::default();
    for (number, asked) in (0..FRAMES).zip(poses.chunks(POSES).cycle()) {
        let draw = derive(SEED, 4, number as u64);
        let frame = scene.observe(Side::A, RETURNS, NoiseKind::Gaussian, DEPTH_STD, draw).cloud;
        fresh.add_frame(&frame, SensorModel::PerPoint, &gripper, asked)?;
    }
    Ok(fresh)
}

/// The approach series of the stereo scan, ten poses of it.
fn real(data: &Path) -> Result<Fresh> {
    let series = cases::series(data)?;
    let every = series.len().div_ceil(POSES);
    let series: Vec<_> =
        series.into_iter().map(|(_, case)| case).skip(every - 1).step_by(every).collect();
    ensure!(series.len() == POSES, "{} poses of a series, not {POSES}", series.len());
    let frame = thinned(&read_cloud(&series[0].scene)?, RETURNS)?;
    let gripper = Mesh::prepare(&read_mesh(&series[0].object, LengthUnit::Metres)?)?;
    let clear = [("free", false), ("collision", true)];
    let said =
        |label: &str| clear.iter().find(|(of, _)| *of == label).map(|(_, collides)| *collides);
    let poses: Vec<_> = series.iter().map(|case| (case.pose, said(&case.label))).collect();
    let mut fresh = Fresh::default();
    for _ in 0..FRAMES {
        fresh.add_frame(&frame, SensorModel::Isotropic { std: SCAN_STD }, &gripper, &poses)?;
    }
    Ok(fresh)
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

//! Depth frames, each prepared anew and asked about ten poses of a gripper.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use cloudtouch::{
    Cloud, CloudSettings, FilterSettings, Mesh, Mode, Query, QuerySettings, noise::SensorModel,
};
use cloudtouch_geom::{Point3, PointCloud, Pose, seed};
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};
use cloudtouch_testkit::{
    family::{Family, Side},
    noise::NoiseKind,
    poses::LabelledPose,
};

use super::{
    scene::Scene,
    target::{Findings, Target},
    timing::{time, timed, times},
};
use crate::{
    measures::{Sample, auc},
    page::Section,
    real_scans::cases::{self, Labelled},
    statistics::median,
    table::Table,
};

/// Frames of each kind.
const FRAMES: usize = 20;
/// Returns of a frame.
const RETURNS: usize = 40_000;
/// Poses asked of a frame.
const POSES: usize = 10;
/// Standard deviation of a simulated depth at 1 m, growing with its square, m.
const DEPTH_STD: f64 = 0.002;
/// Standard deviation that the real scan is said to have, m.
const SCAN_STD: f64 = 0.005;
/// Preparation and ten poses may take this long, s.
const LIMIT: f64 = 0.025;

/// Times of frames, s.
#[derive(Default)]
struct Frames {
    prepare: Vec<f64>,
    queries: Vec<f64>,
    total: Vec<f64>,
}

impl Frames {
    /// One frame: preparation and all queries on one thread.
    fn ask(
        &mut self,
        frame: &PointCloud,
        sensor: SensorModel,
        gripper: &Mesh,
        poses: &[Pose],
    ) -> Result<Vec<f64>> {
        // The stages that suit a camera.
        let filter = FilterSettings::for_sensor(&SensorModel::Kinect);
        let settings = CloudSettings { filter, ..CloudSettings::new(sensor, Mode::Calibrated) };
        let query = Query::new(QuerySettings::default())?;
        let (cloud, prepare) = timed(|| Cloud::prepare(frame, &settings));
        let cloud = cloud?;
        let run = |pose| Ok(query.run(&cloud, gripper, pose)?.collision_probability);
        let (probabilities, queries) = timed(|| poses.iter().map(run).collect());
        self.prepare.push(prepare);
        self.queries.push(queries);
        self.total.push(prepare + queries);
        probabilities
    }

    fn row(&self, name: &str, error: String) -> [String; 7] {
        let [prepare, queries] = [&self.prepare, &self.queries].map(|part| time(median(part)));
        let [both, p95] = times(&self.total);
        [name.to_owned(), self.total.len().to_string(), prepare, queries, both, p95, error]
    }
}

/// Measures simulated and, where there are some, real frames.
pub(super) fn measure(scene: &Scene, data: Option<&Path>) -> Findings {
    let mut table =
        Table::new(["frames", "number", "prepare", "ten poses", "both", "both, p95", "error"]);
    let mut targets = Vec::new();
    for name in ["simulated", "stereo scan"] {
        let what =
            format!("40k-point depth frame ({name}), prepared, and 10 gripper poses ≤ 25 ms");
        let measured = match data {
            _ if name == "simulated" => simulated(scene.seed)?,
            Some(data) => real(data)?,
            None => {
                targets.push(Target::skipped(what, "no real scans here"));
                continue;
            }
        };
        let (frames, error) = measured;
        table.row(frames.row(name, error));
        targets.push(Target::at_most(what, median(&frames.total), LIMIT, time));
    }
    let section = Section::new("Depth frames and a gripper")
        .text(format_args!(
            "Frames of about {RETURNS} returns, as a camera at 20 Hz has 50 ms for. *Prepare* is all \
             of it: near returns and veils dropped, sensor model, neighbour index, tree. Then ten \
             poses of a gripper, known as a mesh and prepared once, are asked of the frame, first \
             queries all of them. Medians over frames."
        ))
        .text(table)
        .text(format_args!(
            "The simulated frames are of household objects on a table, each drawn anew ({:.0} mm of \
             depth noise at 1 m, growing with the square of the depth, veils at edges, covariances \
             known). The scan of a mug on a table is thinned to as many returns and prepared anew \
             each time ({:.0} mm of noise said); its clear cases are `free` and `collision` of its \
             labels, to be answered below 0.1 and above 0.9.",
            1e3 * DEPTH_STD,
            1e3 * SCAN_STD,
        ));
    Ok((section, targets))
}

fn simulated(from: u64) -> Result<(Frames, String)> {
    let scene = Family::Tabletop.scene(seed::derive(from, 3, 0));
    let poses: Vec<LabelledPose> = scene.poses(4 * POSES, seed::derive(from, 3, 1));
    let gripper = Mesh::prepare(scene.b.mesh())?;
    let (mut frames, mut scored) = (Frames::default(), Vec::new());
    for (number, asked) in (0..FRAMES).zip(poses.chunks(POSES).cycle()) {
        let draw = seed::derive(from, 4, number as u64);
        let frame = scene.observe(Side::A, RETURNS, NoiseKind::Gaussian, DEPTH_STD, draw).cloud;
        let placed: Vec<Pose> = asked.iter().map(|p| p.scene_from_object).collect();
        let said = frames.ask(&frame, SensorModel::PerPoint, &gripper, &placed)?;
        scored.extend(said.into_iter().zip(asked.iter().map(|p| p.in_collision)));
    }
    let wrong = |collides: bool| {
        let of = || scored.iter().filter(|s| s.1 == collides);
        format!("{} of {}", of().filter(|s| (s.0 >= 0.5) != collides).count(), of().count())
    };
    let (stops, misses) = (wrong(false), wrong(true));
    let sample = Sample::of_probabilities(scored);
    let auc = auc(&sample, &sample.ones());
    Ok((frames, format!("AUC {auc:.3}, {stops} false stops, {misses} misses")))
}

fn real(data: &Path) -> Result<(Frames, String)> {
    let cases = series(data)?;
    let frame = thinned(&read_cloud(&cases[0].scene)?, RETURNS)?;
    let gripper = Mesh::prepare(&read_mesh(&cases[0].object, LengthUnit::Metres)?)?;
    let poses: Vec<Pose> = cases.iter().map(|case| case.pose).collect();
    let mut frames = Frames::default();
    let mut said = Vec::new();
    for _ in 0..FRAMES {
        let sensor = SensorModel::Isotropic { std: SCAN_STD };
        said = frames.ask(&frame, sensor, &gripper, &poses)?;
    }
    let is_right = |label: &str, p: f64| match label {
        "free" => Some(p < 0.1),
        "collision" => Some(p > 0.9),
        _ => None,
    };
    let answers = cases.iter().zip(&said);
    let right: Vec<bool> = answers.filter_map(|(case, p)| is_right(&case.label, *p)).collect();
    let count = right.iter().filter(|right| **right).count();
    Ok((frames, format!("{count} of {} clear cases right", right.len())))
}

/// Ten cases of the approach series, spread over all of it.
///
/// # Errors
/// When there are fewer: times of fewer poses would look better than they are.
fn series(data: &Path) -> Result<Vec<Labelled>> {
    let all = cases::series(data)?;
    let every = all.len().div_ceil(POSES);
    let spread = all.into_iter().skip(every - 1).step_by(every);
    let cases: Vec<Labelled> = spread.map(|(_, case)| case).collect();
    ensure!(cases.len() == POSES, "cases.json: {} poses of a series, not {POSES}", cases.len());
    Ok(cases)
}

/// The depth image with rows and columns left out evenly until about so many returns remain.
fn thinned(cloud: &PointCloud, returns: usize) -> Result<PointCloud> {
    let (width, height) = cloud.image_size.context("the scan is no depth image")?;
    let all = cloud.points.iter().filter(|p| is_return(p)).count();
    let step = (all as f64 / returns as f64).sqrt().max(1.0);
    let kept = |count: usize| -> Vec<usize> {
        (0..).map(|i| (f64::from(i) * step) as usize).take_while(|&i| i < count).collect()
    };
    let (columns, rows) = (kept(width), kept(height));
    let pixels = rows.iter().flat_map(|&row| columns.iter().map(move |c| row * width + c));
    Ok(PointCloud {
        image_size: Some((columns.len(), rows.len())),
        sensor_origin: cloud.sensor_origin,
        ..PointCloud::from_points(pixels.map(|i| cloud.points[i]).collect())
    })
}

fn is_return(point: &Point3) -> bool {
    point.iter().all(|v| v.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thinned_image_is_an_image_with_as_many_returns_as_wanted() {
        let mut points: Vec<Point3> = (0..200 * 100)
            .map(|i| Point3::new(f64::from(i % 200), f64::from(i / 200), 1.0))
            .collect();
        points[0].z = f64::NAN;
        let image = PointCloud { image_size: Some((200, 100)), ..PointCloud::from_points(points) };
        let thin = thinned(&image, 5000).unwrap();
        let (width, height) = thin.image_size.unwrap();
        assert_eq!(thin.len(), width * height);
        assert!(!is_return(&thin.points[0]) && is_return(&thin.points[1]));
        // A row of the thin image is one of the whole image.
        let row = &thin.points[width..2 * width];
        assert!(row.windows(2).all(|p| p[0].y == p[1].y && p[0].x < p[1].x));
        let left = thin.points.iter().filter(|p| is_return(p)).count();
        assert!((4900..=5200).contains(&left), "{left}");
        // Fewer returns than wanted: nothing is left out.
        assert_eq!(thinned(&image, 50_000).unwrap().len(), 20_000);
        assert!(thinned(&PointCloud::from_points(Vec::new()), 10).is_err());
    }
}

//! Depth frames, each prepared anew and asked about ten poses of a gripper.

use std::{fmt::Write as _, path::Path};

use anyhow::{Context, Result};
use cloudtouch::{
    Cloud, CloudSettings, FilterSettings, Mesh, Mode, Query, QuerySettings, Verdict,
    geom::{PointCloud, Pose, TriangleMesh},
    noise::SensorModel,
};
use cloudtouch_geom::{Point3, Vector3, seed};
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};
use cloudtouch_testkit::{
    family::{Family, Side},
    noise::NoiseKind,
    poses::LabelledPose,
};
use nalgebra::Matrix4;

use super::{
    Run, Section,
    target::Target,
    timing::{median, p95, time, timed},
};
use crate::{
    common::{statistics::auc, table::Table},
    evaluate::case_file::CaseFile,
};

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

/// One frame: preparation and all queries on one thread.
struct Asked {
    probabilities: Vec<f64>,
    verdicts: Vec<Verdict>,
}

impl Frames {
    fn ask(
        &mut self,
        frame: &PointCloud,
        settings: &CloudSettings,
        gripper: &Mesh,
        poses: &[Pose],
    ) -> Result<Asked> {
        let (cloud, prepare) = timed(|| Cloud::prepare(frame, settings));
        let cloud = cloud?;
        let query = Query::new(QuerySettings::default())?;
        let run = || poses.iter().map(|pose| query.run(&cloud, gripper, pose)).collect();
        let (reports, queries): (Result<Vec<_>, _>, f64) = timed(run);
        self.prepare.push(prepare);
        self.queries.push(queries);
        self.total.push(prepare + queries);
        let reports = reports?;
        Ok(Asked {
            probabilities: reports.iter().map(|r| r.collision_probability).collect(),
            verdicts: reports.iter().map(|r| r.verdict).collect(),
        })
    }

    fn row(&self, name: &str, error: String) -> Vec<String> {
        let mut cells = vec![name.to_owned(), self.total.len().to_string()];
        cells.extend([&self.prepare, &self.queries].map(|part| time(median(part))));
        cells.extend([time(median(&self.total)), time(p95(&self.total)), error]);
        cells
    }

    fn target(&self, name: &str) -> Target {
        Target::at_most(what(name), median(&self.total), LIMIT, time)
    }
}

fn what(name: &str) -> String {
    format!("40k-point depth frame ({name}), prepared, and 10 gripper poses ≤ 25 ms")
}

/// Measures simulated and, where there are some, real frames.
pub(super) fn measure(run: &Run<'_>) -> Result<Section> {
    let header = ["frames", "number", "prepare", "ten poses", "both", "both, p95", "error"];
    let mut table = Table::new(&header);
    let (frames, error) = simulated(run)?;
    table.row(frames.row("simulated", error));
    let mut targets = vec![frames.target("simulated")];
    let mut text = format!(
        "Frames of about {RETURNS} returns, as a camera at 20 Hz has 50 ms for. *Prepare* is all of \
         it: near returns and veils dropped, sensor model, neighbour index, tree. Then ten poses of a \
         gripper, known as a mesh and prepared once, are asked of the frame, first queries all of \
         them. Medians over frames.\n\n"
    );
    if run.data.join("cases.json").is_file() {
        let (frames, error) = real(&run.data, run.plan.frames)?;
        table.row(frames.row("stereo scan", error));
        targets.push(frames.target("stereo scan"));
    } else {
        println!("no real scans at {}: that frame is skipped", run.data.display());
        targets.push(Target::skipped(what("stereo scan"), "no real scans here"));
    }
    write!(
        text,
        "{table}\nThe simulated frames are of household objects on a table, each drawn anew ({:.0} mm \
         of depth noise at 1 m, growing with the square of the depth, veils at edges, covariances \
         known). The scan of a mug on a table is thinned to as many returns and prepared anew each \
         time ({:.0} mm of noise said); its clear cases are `free` and `collision` of its labels, to \
         be answered below 0.1 and above 0.9.\n",
        1e3 * DEPTH_STD,
        1e3 * SCAN_STD,
    )?;
    Ok(Section { title: "Depth frames and a gripper", text, targets })
}

/// The stages that suit a camera.
fn settings(sensor: SensorModel) -> CloudSettings {
    let filter = FilterSettings::for_sensor(&SensorModel::Kinect);
    CloudSettings { filter, ..CloudSettings::new(sensor, Mode::Calibrated) }
}

fn simulated(run: &Run<'_>) -> Result<(Frames, String)> {
    let scene = Family::Tabletop.scene(seed::derive(run.seed, 3, 0));
    let poses: Vec<LabelledPose> = scene.poses(4 * POSES, seed::derive(run.seed, 3, 1));
    let gripper = Mesh::prepare(scene.b.mesh())?;
    let (mut frames, mut scored) = (Frames::default(), Vec::new());
    for number in 0..run.plan.frames as u64 {
        let draw = seed::derive(run.seed, 4, number);
        let frame = scene.observe(Side::A, RETURNS, NoiseKind::Gaussian, DEPTH_STD, draw).cloud;
        let asked: Vec<LabelledPose> = poses
            .iter()
            .cycle()
            .skip(number as usize * POSES % poses.len())
            .take(POSES)
            .copied()
            .collect();
        let placed: Vec<Pose> = asked.iter().map(|p| p.scene_from_object).collect();
        let said = frames.ask(&frame, &settings(SensorModel::PerPoint), &gripper, &placed)?;
        scored.extend(said.probabilities.into_iter().zip(asked.iter().map(|p| p.in_collision)));
    }
    let wrong = |collides: bool| {
        let of = scored.iter().filter(|s| s.1 == collides);
        format!("{} of {}", of.clone().filter(|s| (s.0 >= 0.5) != collides).count(), of.count())
    };
    let error =
        format!("AUC {:.3}, {} false stops, {} misses", auc(&scored), wrong(false), wrong(true));
    Ok((frames, error))
}

fn real(data: &Path, count: usize) -> Result<(Frames, String)> {
    let file = CaseFile::read(&data.join("cases.json"))?;
    let series = file.only(data, |case| case.series.is_some()).cases;
    let every = series.len().div_ceil(POSES).max(1);
    let cases: Vec<_> = series.into_iter().skip(every - 1).step_by(every).collect();
    let first = cases.first().context("there is no approach series in cases.json")?;
    let object: TriangleMesh = read_mesh(&first.object, LengthUnit::Metres)?;
    let frame = thinned(&read_cloud(&first.scene)?, RETURNS)?;
    let place = |matrix: &[[f64; 4]; 4]| Matrix4::from_fn(|row, column| matrix[row][column]);
    let poses: Result<Vec<Pose>, _> =
        cases.iter().map(|case| Pose::try_from_matrix(&place(&case.pose))).collect();
    let (gripper, poses) = (Mesh::prepare(&object)?, poses?);
    let settings = settings(SensorModel::Isotropic { std: SCAN_STD });
    let (mut frames, mut clear) = (Frames::default(), 0);
    let labels: Vec<&str> = cases.iter().filter_map(|c| c.label.as_deref()).collect();
    let is_clear = |label: &str| label == "free" || label == "collision";
    for _ in 0..count {
        let said = frames.ask(&frame, &settings, &gripper, &poses)?;
        let right = |(label, p): (&&str, &f64)| match *label {
            "free" => *p < 0.1,
            "collision" => *p > 0.9,
            _ => false,
        };
        clear = labels.iter().zip(&said.probabilities).filter(|pair| right(*pair)).count();
        if said.verdicts.len() != POSES {
            // Said in the table: times of fewer poses would look better than they are.
            return Ok((frames, format!("only {} poses", said.verdicts.len())));
        }
    }
    let all = labels.iter().filter(|label| is_clear(label)).count();
    Ok((frames, format!("{clear} of {all} clear cases right")))
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
    let nothing = Point3::from(Vector3::repeat(f64::NAN));
    let pixel = |row: usize, column: usize| {
        let point = cloud.points[row * width + column];
        if is_return(&point) { point } else { nothing }
    };
    let points = rows.iter().flat_map(|&row| columns.iter().map(move |&c| pixel(row, c))).collect();
    Ok(PointCloud {
        image_size: Some((columns.len(), rows.len())),
        sensor_pose: cloud.sensor_pose,
        ..PointCloud::from_points(points)
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
        assert!(thin.points[0].x.is_nan() && thin.points[1].x.is_finite());
        // A row of the thin image is one of the whole image.
        assert!(
            thin.points[width..2 * width].windows(2).all(|p| p[0].y == p[1].y && p[0].x < p[1].x)
        );
        let left = thin.points.iter().filter(|p| is_return(p)).count();
        assert!((4900..=5200).contains(&left), "{left}");
        // Fewer returns than wanted: nothing is left out.
        assert_eq!(thinned(&image, 50_000).unwrap().len(), 20_000);
        assert!(thinned(&PointCloud::from_points(Vec::new()), 10).is_err());
    }
}

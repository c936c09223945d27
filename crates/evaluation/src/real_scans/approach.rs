//! A gripper that advances on a mug, step by step: the probability must rise, and the contacts
//! must lie on the scene.

use std::path::Path;

use anyhow::Result;
use cloudtouch::{
    Cloud, CloudSettings, Mesh, Mode, Query, QuerySettings, Report, noise::SensorModel,
};
use cloudtouch_geom::{Point3, Pose};
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};

use super::{cases, side_view};
use crate::{
    either::{EitherCloud, EitherQuery},
    figure::{Axis, Figure, Panel, Series},
    page::Section,
};

/// A fall of the probability by this much along the approach is noise.
const NOISE_OF_PROBABILITY: f64 = 0.05;
/// Contacts must be this near to a scene point, m: three standard deviations.
const CONTACT_REACH: f64 = 0.015;
/// Standard deviation that the sensor is said to have, m, and the mode. The first run is checked:
/// the scan has about that noise.
const RUNS: [(f64, Mode, &str); 4] = [
    (0.005, Mode::Calibrated, "calibrated, sensor of 5 mm"),
    (0.002, Mode::Calibrated, "calibrated, sensor of 2 mm"),
    (0.015, Mode::Calibrated, "calibrated, sensor of 15 mm"),
    (0.005, Mode::Paper, "paper, sensor of 5 mm"),
];
/// How far past first contact the pictured poses are, mm.
const PICTURED: [f64; 3] = [-30.0, -2.0, 40.0];

pub(super) fn evaluate(data: &Path) -> Result<(Section, Vec<String>)> {
    let series = cases::series(data)?;
    let (advances, poses): (Vec<f64>, Vec<Pose>) =
        series.iter().map(|(advance, case)| (*advance, case.pose)).unzip();
    let scan = read_cloud(&series[0].1.scene)?;
    let object = read_mesh(&series[0].1.object, LengthUnit::Metres)?;
    let mesh = Mesh::prepare(&object)?;
    let sensor = |std| SensorModel::Isotropic { std };
    let mut answers: Vec<Vec<Report>> = Vec::new();
    for (std, mode, _) in RUNS {
        let cloud = EitherCloud::prepare(&scan, sensor(std), mode)?;
        let query = EitherQuery::new(mode);
        let ask = |pose| query.run(&cloud, &mesh, pose);
        answers.push(poses.iter().map(ask).collect::<Result<_, _>>()?);
    }

    // No early stop: every likely point is to be seen.
    let query = Query::new(QuerySettings { stop_above: 1.0, ..QuerySettings::default() })?;
    let main = Cloud::prepare(&scan, &CloudSettings::new(sensor(RUNS[0].0)))?;
    let mut shown = Vec::new();
    for advance in PICTURED {
        let pose = poses[cases::at_advance(&series, advance)?];
        shown.push((pose, query.run(&main, &mesh, &pose)?));
    }
    let picture = side_view::figure(&main, &object, &shown)?;

    let contacts = || answers[0].iter().flat_map(|report| &report.contacts);
    let advance = poses[poses.len() - 1].translation() - poses[0].translation();
    let facing = contacts().filter(|c| c.normal_a_to_b.dot(&advance) < 0.0).count();
    let distances: Vec<f64> = contacts().map(|c| nearest(&scan.points, &c.point)).collect();
    let drops: Vec<f64> = answers.iter().map(|run| largest_drop(run)).collect();
    let of_runs = RUNS.iter().zip(&drops);
    let text = format!(
        "A PR2 gripper, known as a mesh, moves along a straight line towards a mug on a table, from \
         {:.0} mm before its first contact with a measured point to {:.0} mm past it. Largest fall \
         of P below its running maximum: {}. In the first run (checked), P may fall by \
         {NOISE_OF_PROBABILITY}, and every contact must be within {:.0} mm of a scene point: of {} \
         contacts the farthest is {:.1} mm from one. {facing} have a normal (scene to gripper) that \
         faces the gripper, that is, against its advance.",
        -advances[0],
        advances[advances.len() - 1],
        of_runs
            .map(|((.., name), drop)| format!("{drop:.3} ({name})"))
            .collect::<Vec<_>>()
            .join(", "),
        1e3 * CONTACT_REACH,
        distances.len(),
        1e3 * distances.iter().copied().fold(0.0, f64::max),
    );
    let shows = "A slice through a mug on a table as a depth camera measured it, and the outline \
                 of a gripper at three poses: free, touching and in collision";
    let section = Section::new("Approach of a gripper to a mug")
        .text(text)
        .figure("gripper-mug", shows, picture)
        .figure("approach", "Probability along the approach", figure(&advances, &answers));
    Ok((section, failures(drops[0], &distances)))
}

/// What is wrong with a fall of the probability and with the distances of contacts from the scene.
fn failures(drop: f64, distances: &[f64]) -> Vec<String> {
    let mut failures = Vec::new();
    // NaN is no small fall and not near.
    if !(0.0..=NOISE_OF_PROBABILITY).contains(&drop) {
        failures.push(format!("approach: P falls by {drop:.3} below its running maximum"));
    }
    let stray = distances.iter().filter(|distance| !(0.0..=CONTACT_REACH).contains(*distance));
    failures.extend(stray.map(|d| format!("approach: a contact is {d:.3} m from any scene point")));
    if distances.is_empty() {
        failures.push("approach: no contact was reported".into());
    }
    failures
}

/// Distance to the nearest point, m; missing returns do not count.
fn nearest(points: &[Point3], to: &Point3) -> f64 {
    let squares = points.iter().map(|p| (p - to).norm_squared()).filter(|d| d.is_finite());
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// How far the probability falls below its own running maximum, at most.
fn largest_drop(reports: &[Report]) -> f64 {
    let mut highest = f64::NEG_INFINITY;
    let drops = reports.iter().map(|report| {
        highest = highest.max(report.collision_probability);
        highest - report.collision_probability
    });
    drops.max_by(f64::total_cmp).unwrap_or(f64::NAN)
}

/// Our mode beside the paper's, and ours told of three sensors.
fn figure(advances: &[f64], answers: &[Vec<Report>]) -> Figure {
    let panel = |title: &str, runs: &[usize]| {
        let x = Axis::linear("advance past first contact (mm)");
        let panel = Panel::new(x, Axis::unit("collision probability"))
            .title(title)
            .series(Series::guide([(0.0, 0.0), (0.0, 1.0)]));
        runs.iter().fold(panel, |panel, &run| {
            let said = || advances.iter().zip(&answers[run]);
            let bounds = said().map(|(x, r)| (*x, r.bounds[0], r.bounds[1]));
            let p = said().map(|(x, r)| (*x, r.collision_probability));
            let name = RUNS[run].2;
            panel.series(Series::band(name, bounds)).series(Series::curve(name, p))
        })
    };
    Figure::new("Gripper advancing on a mug: collision probability and its bounds")
        .panel(panel("two modes", &[0, 3]))
        .panel(panel("three sensors", &[0, 1, 2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falls_and_stray_contacts_are_failures_and_so_are_numbers_that_are_none() {
        assert!(failures(0.05, &[0.0, 0.015]).is_empty());
        assert_eq!(failures(0.06, &[0.016, f64::NAN, f64::INFINITY, 0.0]).len(), 4);
        assert_eq!(failures(f64::NAN, &[]).len(), 2);
        let points = [Point3::new(f64::NAN, 0.0, 0.0), Point3::new(3.0, 4.0, 0.0)];
        assert_eq!(nearest(&points, &Point3::origin()), 5.0);
        assert_eq!(nearest(&points[..1], &Point3::origin()), f64::INFINITY);
    }
}

//! A gripper that advances on a mug, step by step: the probability must rise, and the contacts
//! must lie on the scene and face the gripper.

use std::path::Path;

use anyhow::{Context, Result};
use cloudtouch::{
    Cloud, CloudSettings, Mesh, Mode, Query, QuerySettings, Report, noise::SensorModel,
};
use cloudtouch_geom::{Point3, TriangleMesh, Vector3};
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};

use super::{
    cases::{self, Labelled, at_advance, file_name},
    side_view,
};
use crate::{
    figure::{Axis, Figure, Panel, Series},
    page::Section,
    table::{Table, probability},
};

/// A fall of the probability by this much along the approach is noise.
const NOISE_OF_PROBABILITY: f64 = 0.05;
/// Contacts must be this near to a scene point, m: three standard deviations.
const CONTACT_REACH: f64 = 0.015;
/// Standard deviation that the sensor is said to have, m, and the mode. The first is checked: the
/// scan has about that noise.
const RUNS: [(f64, Mode); 4] = [
    (0.005, Mode::Calibrated),
    (0.002, Mode::Calibrated),
    (0.015, Mode::Calibrated),
    (0.005, Mode::Paper),
];
/// How far past first contact the pictured poses are, m.
const PICTURED: [f64; 3] = [-0.03, -0.002, 0.04];

/// One run over the series.
struct Run {
    name: String,
    reports: Vec<Report>,
}

pub(super) fn evaluate(_root: &Path, data: &Path) -> Result<(Section, Vec<String>)> {
    let cases = cases::series(data, f64::NEG_INFINITY)?;
    let scan = read_cloud(&cases[0].scene)?;
    let object = read_mesh(&cases[0].object, LengthUnit::Metres)?;
    let mesh = Mesh::prepare(&object)?;
    let run = |(std, mode): (f64, Mode)| -> Result<Run> {
        let sensor = SensorModel::Isotropic { std };
        let cloud = Cloud::prepare(&scan, &CloudSettings::new(sensor, mode))?;
        let query = Query::new(QuerySettings::new(mode))?;
        let ask = |case: &Labelled| query.run(&cloud, &mesh, &case.scene_from_object);
        let reports = cases.iter().map(ask).collect::<Result<_, _>>()?;
        let mode = if mode == Mode::Paper { "paper" } else { "calibrated" };
        Ok(Run { name: format!("{mode}, sensor of {} mm", 1e3 * std), reports })
    };
    let runs = RUNS.into_iter().map(run).collect::<Result<Vec<_>>>()?;
    let main = &runs[0];
    let contacts = ContactCheck::of(&scan.points, &cases, &main.reports);
    let mut failures = contacts.failures();
    let drop = largest_drop(main.reports.iter().map(|r| r.collision_probability));
    // NaN is a failure too.
    if drop.is_nan() || drop > NOISE_OF_PROBABILITY {
        failures.push(format!("approach: P falls by {drop:.3} below its running maximum"));
    }
    let introduction = format!(
        "`{}` moves along a straight line in `{}`, from {:.0} mm before its first contact with a \
         measured point to {:.0} mm past it. Checked for the calibrated mode and a sensor of 5 mm: \
         P falls by at most {NOISE_OF_PROBABILITY} below its running maximum, and every contact is \
         within {:.0} mm of a scene point. {contacts}",
        file_name(&cases[0].object),
        file_name(&cases[0].scene),
        -1e3 * cases[0].advance_m(),
        1e3 * cases[cases.len() - 1].advance_m(),
        1e3 * CONTACT_REACH,
    );
    let section = Section::new("Approach of a gripper to a mug")
        .text(introduction)
        .figure(
            "gripper-mug",
            "A slice through a mug on a table as a depth camera measured it, and the outline of a \
             gripper at three poses: free, touching and in collision",
            picture(&scan, &object, &mesh, &cases)?,
        )
        .figure("approach", "Probability along the approach", figure(&cases, &runs))
        .text(table(&cases, &runs));
    Ok((section, failures))
}

fn picture(
    scan: &cloudtouch_geom::PointCloud,
    object: &TriangleMesh,
    mesh: &Mesh,
    cases: &[Labelled],
) -> Result<Figure> {
    let sensor = SensorModel::Isotropic { std: RUNS[0].0 };
    let cloud = Cloud::prepare(scan, &CloudSettings::new(sensor, Mode::Calibrated))?;
    // No early stop: every likely point is to be seen.
    let query = Query::new(QuerySettings { stop_above: 1.0, ..QuerySettings::default() })?;
    let mut shown = Vec::new();
    for advance in PICTURED {
        let pose = cases[at_advance(cases, advance)?].scene_from_object;
        shown.push((pose, query.run(&cloud, mesh, &pose)?));
    }
    side_view::figure(&cloud, object, &shown).context("the side view")
}

/// Where the contacts of a series are and where their normals point.
struct ContactCheck {
    /// Contacts farther from any scene point than they may be, by case.
    stray: Vec<String>,
    largest_distance: f64,
    contacts: usize,
    facing: usize,
}

impl ContactCheck {
    fn of(scene: &[Point3], cases: &[Labelled], reports: &[Report]) -> Self {
        let place = |case: &Labelled| case.scene_from_object.translation();
        let advance: Vector3 = place(&cases[cases.len() - 1]) - place(&cases[0]);
        let mut check = Self { stray: Vec::new(), largest_distance: 0.0, contacts: 0, facing: 0 };
        for (case, report) in cases.iter().zip(reports) {
            for contact in &report.contacts {
                let distance = nearest(scene, &contact.point);
                // NaN is stray too.
                if distance.is_nan() || distance > CONTACT_REACH {
                    check.stray.push(format!("{} ({:.1} mm)", case.id, 1e3 * distance));
                }
                check.largest_distance = check.largest_distance.max(distance);
                check.contacts += 1;
                check.facing += usize::from(contact.normal_a_to_b.dot(&advance) < 0.0);
            }
        }
        check
    }

    fn failures(&self) -> Vec<String> {
        let stray = self.stray.iter();
        let mut failures: Vec<String> = stray
            .map(|case| format!("approach: a contact of {case} is on no scene point"))
            .collect();
        if self.contacts == 0 {
            failures.push("approach: no contact was reported".into());
        }
        failures
    }
}

impl std::fmt::Display for ContactCheck {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            out,
            "Of {} contacts the farthest is {:.1} mm from one; {} have a normal (scene to gripper) \
             that faces the gripper, that is, against its advance.",
            self.contacts,
            1e3 * self.largest_distance,
            self.facing
        )
    }
}

/// Distance to the nearest point, m; missing returns do not count.
fn nearest(points: &[Point3], to: &Point3) -> f64 {
    let squares = points.iter().map(|p| (p - to).norm_squared()).filter(|d| d.is_finite());
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// How far a series falls below its own running maximum, at most; NaN where a value is.
fn largest_drop(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut highest, mut drop) = (f64::NEG_INFINITY, 0.0_f64);
    for value in values {
        if value.is_nan() {
            return f64::NAN;
        }
        highest = highest.max(value);
        drop = drop.max(highest - value);
    }
    drop
}

/// Our mode beside the paper's, and ours told of three sensors.
fn figure(cases: &[Labelled], runs: &[Run]) -> Figure {
    let panel = |title: &str, of: &[usize]| {
        let panel = Panel::new(
            Axis::linear("advance past first contact (mm)"),
            Axis::unit("collision probability"),
        );
        let contact = Series::guide([(0.0, 0.0), (0.0, 1.0)]);
        of.iter().fold(panel.title(title).series(contact), |panel, &number| {
            let run = &runs[number];
            let x = cases.iter().map(|case| 1e3 * case.advance_m());
            let answers: Vec<(f64, &Report)> = x.zip(&run.reports).collect();
            let bounds = answers.iter().map(|(x, r)| (*x, r.bounds[0], r.bounds[1]));
            let p = answers.iter().map(|(x, r)| (*x, r.collision_probability));
            panel.series(Series::band(&run.name, bounds)).series(Series::curve(&run.name, p))
        })
    };
    Figure::new("Gripper advancing on a mug: collision probability and its bounds")
        .panel(panel("two modes", &[0, 3]))
        .panel(panel("three sensors", &[0, 1, 2]))
}

fn table(cases: &[Labelled], runs: &[Run]) -> Table {
    let mut table =
        Table::new(std::iter::once("advance (mm)").chain(runs.iter().map(|r| r.name.as_str())));
    for (row, case) in cases.iter().enumerate() {
        let p = runs.iter().map(|run| probability(run.reports[row].collision_probability));
        table.row(std::iter::once(format!("{:+.0}", 1e3 * case.advance_m())).chain(p));
    }
    let drops = runs.iter().map(|run| {
        format!("{:.3}", largest_drop(run.reports.iter().map(|r| r.collision_probability)))
    });
    table.row(std::iter::once("largest drop".to_owned()).chain(drops));
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_returns_are_never_nearest() {
        let points = [Point3::new(f64::NAN, 0.0, 0.0), Point3::new(3.0, 4.0, 0.0)];
        assert_eq!(nearest(&points, &Point3::origin()), 5.0);
        assert_eq!(nearest(&points[..1], &Point3::origin()), f64::INFINITY);
    }

    #[test]
    fn the_drop_is_taken_from_the_running_maximum() {
        assert_eq!(largest_drop([0.0, 0.5, 0.25, 0.75, 0.625]), 0.25);
        assert_eq!(largest_drop([]), 0.0);
        assert!(largest_drop([0.5, f64::NAN]).is_nan());
    }
}

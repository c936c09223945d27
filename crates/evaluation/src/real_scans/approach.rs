//! A gripper that advances on a mug, step by step: the probability must rise, and the contacts must lie on the scene.

use std::path::Path;

use anyhow::Result;
use cloudtouch::noise::SensorModel;
use cloudtouch::{
    Cloud, CloudSettings, Contact, Mesh, PaperCloud, PaperCloudSettings, PaperQuery, PaperSettings,
    Query, QuerySettings, Report,
};
use cloudtouch_geom::Pose;
use cloudtouch_io::{LengthUnit, read_cloud, read_mesh};
use cloudtouch_testkit::brute::minimum_distance;

use super::{cases, side_view};
use crate::report::{Axis, Figure, Findings, Panel, Place, Section, Series, Target};

/// A fall of the probability by this much along the approach is noise.
const NOISE_OF_PROBABILITY: f64 = 0.05;
/// Contacts must be this near to a scene point, m: three standard deviations, and half the spacing of the points.
const CONTACT_REACH: f64 = 0.016;
/// Standard deviation that the sensor is said to have, m, and who answers. The first run is checked:
/// the scan has about that noise. The last is by the paper.
const RUNS: [(f64, &str); 4] =
    [(0.005, "told 5 mm"), (0.002, "told 2 mm"), (0.015, "told 15 mm"), (0.005, "paper")];
/// How far past first contact the pictured poses are, mm.
const PICTURED: [f64; 3] = [-30.0, -2.0, 40.0];

pub(super) fn evaluate(data: &Path) -> Findings {
    let series = cases::series(data)?;
    let (advances, poses): (Vec<f64>, Vec<Pose>) =
        series.iter().map(|(advance, case)| (*advance, case.pose)).unzip();
    let scan = read_cloud(&series[0].1.scene)?;
    let object = read_mesh(&series[0].1.object, LengthUnit::Metres)?;
    let mesh = Mesh::prepare(&object)?;
    let sensor = |run: usize| SensorModel::Isotropic { std: RUNS[run].0 };
    let clouds = [0, 1, 2].map(|run| Cloud::prepare(&scan, &CloudSettings::new(sensor(run))));
    let clouds: Vec<Cloud> = clouds.into_iter().collect::<Result<_, _>>()?;
    let query = Query::new(QuerySettings::default())?;
    let all = |cloud: &Cloud| -> Result<Vec<Report>> {
        poses.iter().map(|pose| Ok(query.run(cloud, &mesh, pose)?)).collect()
    };
    let mut answers: Vec<Vec<Report>> = clouds.iter().map(all).collect::<Result<_>>()?;
    let (query, by) = (PaperSettings::default(), PaperCloudSettings::new(sensor(3)));
    let (query, cloud) = (PaperQuery::new(query)?, PaperCloud::prepare(&scan, &by)?);
    answers.push(query.run_batch(&cloud, &mesh, &poses).into_iter().collect::<Result<_, _>>()?);

    // No early stop: every likely point is to be seen.
    let query = Query::new(QuerySettings { stop_above: 1.0, ..QuerySettings::default() })?;
    let mut shown = Vec::new();
    for advance in PICTURED {
        let pose = poses[cases::at_advance(&series, advance)?];
        shown.push((pose, query.run(&clouds[0], &mesh, &pose)?));
    }
    let picture = side_view::figure(&clouds[0], &object, &shown)?;

    let contacts = || answers[0].iter().flat_map(|report| &report.contacts);
    // Missing returns do not count.
    let to_scan = |contact: &Contact| minimum_distance(&scan.points, &[contact.point]);
    let distances: Vec<f64> = contacts().map(to_scan).collect();
    let drops = RUNS.iter().zip(&answers).map(|((_, name), run)| (largest_drop(run), name));
    let drops: Vec<String> = drops.map(|(drop, name)| format!("{drop:.3} ({name})")).collect();
    let text = format!(
        "A PR2 gripper, known as a mesh, moves along a straight line towards a mug on a table, from \
         {:.0} mm before its first contact with a measured point to {:.0} mm past it. Largest fall \
         of P below its running maximum, by what the sensor is said to have: {}, told 5 mm. The \
         first run is checked, the scan has about that noise.",
        -advances[0],
        advances[advances.len() - 1],
        drops.join(", "),
    );
    let shows = "A slice through a mug on a table as a depth camera measured it, and the outline \
                 of a gripper at three poses: free, touching and in collision";
    let section = Section::new("Approach of a gripper to a mug")
        .text(text)
        .figure("gripper-mug", shows, picture)
        .figure("approach", "Probability along the approach", figure(&advances, &answers));
    Ok((section, targets(largest_drop(&answers[0]), &distances)))
}

fn targets(drop: f64, distances: &[f64]) -> Vec<Target> {
    let limit = NOISE_OF_PROBABILITY;
    // One that is not a number is larger than all.
    let farthest = distances.iter().copied().max_by(f64::total_cmp).unwrap_or(f64::NAN);
    let what = format!("approach: P falls by at most {limit} below its running maximum");
    let reach = format!("approach: contacts within {:.0} mm of a scene point", 1e3 * CONTACT_REACH);
    let measured = format!("{:.1} mm at most, of {} contacts", 1e3 * farthest, distances.len());
    vec![
        Target::new(what, format!("{drop:.3}"), drop <= limit),
        Target::new(reach, measured, farthest <= CONTACT_REACH),
    ]
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
    let panel = |(title, runs): (&str, &[(usize, Place)])| {
        let mut series = vec![Series::line("", [(0.0, 0.0), (0.0, 1.0)])];
        for &(run, (x, y)) in runs {
            let said = || advances.iter().zip(&answers[run]);
            let bounds = said().map(|(x, r)| (*x, r.bounds[0], r.bounds[1]));
            let p = said().map(|(x, r)| (*x, r.collision_probability));
            let name = RUNS[run].1;
            series.extend([Series::band(name, bounds), Series::curve(name, p).named_at(x, y)]);
        }
        let x = Axis::linear("advance past first contact (mm)");
        Panel { title: title.into(), x, y: Axis::unit("collision probability"), series }
    };
    // With where their names fit beside them.
    let panels: [(&str, &[(usize, Place)]); 2] = [
        ("calibrated and paper, told of a sensor of 5 mm", &[(0, (6.0, 0.9)), (3, (-44.0, 0.9))]),
        (
            "calibrated, told of three sensors",
            &[(0, (-48.0, 0.7)), (1, (-44.0, 0.6)), (2, (8.0, 0.8))],
        ),
    ];
    let turns = |run: usize| {
        let mut said = advances.iter().zip(&answers[run]);
        said.find(|(_, r)| r.collision_probability >= 0.5).map_or(f64::NAN, |(x, _)| *x)
    };
    let title = format!(
        "A gripper nears a mug: collision likelier than not from {:+.0} mm past first contact on, for \
         the paper from {:+.0} mm",
        turns(0),
        turns(3)
    );
    Figure::new(&title, panels.map(panel))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::targets::require;

    #[test]
    fn what_is_no_number_is_not_near_and_misses_are_missed() {
        let met = |drop, distances: &[f64]| require(&targets(drop, distances)).is_ok();
        assert!(met(0.05, &[0.0, 0.016]));
        assert!(!met(0.06, &[0.0]) && !met(f64::NAN, &[0.0]));
        assert!(!met(0.0, &[0.0, f64::NAN, 0.0]) && !met(0.0, &[0.017]) && !met(0.0, &[]));
    }
}

//! Whether the bounds of an answer contain what a search of everything finds.

use anyhow::{Context, Result};
use cloudtouch::{Cloud, CloudSettings, Mode, Query, QuerySettings, noise::SensorModel};
use cloudtouch_geom::seed;
use cloudtouch_testkit::{
    family::{Family, FamilyScene, Side},
    noise::NoiseKind,
    poses::LabelledPose,
};
use rayon::prelude::*;

use super::{
    SEED,
    measures::{Bootstrap, Clusters, Measure, Sample, measure},
    record::{Said, Truth},
    tables::Section,
    variant,
};
use crate::common::table::Table;

/// Searching everything is slow: few points.
const POINTS: usize = 2_500;
const STD: f64 = 0.005;
const FAMILIES: [Family; 3] = [Family::PianoRoom, Family::SphereAndPlane, Family::ThinSlab];
/// What is not worth telling apart.
const ROUNDING: f64 = 1e-9;

/// One pose: the truth, the answer, and the probability that a flat search finds.
type Row = (Truth, Said, f64);

/// The section of the document, of so many poses of each family.
pub(super) fn section(poses: usize) -> Result<Section> {
    let mut table =
        Table::new(&["family", "poses", "bounds contain it", "largest miss", "mean width"]);
    let mut all = Vec::new();
    for family in FAMILIES {
        let rows = rows(family, poses)?;
        table.row(cells(family.name(), &rows));
        all.extend(rows);
    }
    table.row(cells("all", &all));
    Ok(Section {
        title: "Coverage of bounds".into(),
        text: format!(
            "Share of the answers of `calibrated` whose bounds contain the probability that the \
             same query states when it culls next to nothing (below 1e-12) and never stops early: \
             what is left out by default must widen the bounds. {POINTS} points, {:.0} mm. The \
             largest miss is how far that probability lies outside of the bounds; the mean width \
             is that of the bounds.\n\n{table}\n",
            1e3 * STD
        ),
    })
}

fn cells(name: &str, rows: &[Row]) -> [String; 5] {
    let (truths, said): (Vec<Truth>, Vec<Said>) = rows.iter().map(|r| (r.0, r.1)).unzip();
    let reference: Vec<f64> = rows.iter().map(|r| r.2).collect();
    let sample = Sample::new(&truths, &said).with_reference(&reference);
    let clusters = Clusters::new(0..rows.len());
    let methods = [(name.to_owned(), sample)];
    let measured = measure(&methods, &[Measure::Coverage], &clusters, Bootstrap::new(SEED));
    let coverage =
        measured.estimate(name, Measure::Coverage).map_or("–".into(), |e| e.to_string());
    let of = |value: &dyn Fn([f64; 2], f64) -> f64| {
        rows.iter()
            .map(|(_, said, flat)| value(said.bounds.unwrap_or([f64::NAN; 2]), *flat))
            .collect::<Vec<f64>>()
    };
    let miss = of(&|[low, high], flat| (low - flat).max(flat - high).max(0.0));
    let width = of(&|[low, high], _| high - low);
    [
        name.to_owned(),
        rows.len().to_string(),
        coverage,
        format!("{:.1e}", miss.iter().copied().fold(0.0, f64::max)),
        format!("{:.1e}", width.iter().sum::<f64>() / width.len() as f64),
    ]
}

fn rows(family: Family, poses: usize) -> Result<Vec<Row>> {
    let of_variant = poses.div_ceil(variant::COUNT as usize);
    let variants: Vec<(FamilyScene, Vec<LabelledPose>)> = (0..variant::COUNT)
        .map(|number| {
            let seed = variant::seed_of(family, number);
            let scene = family.scene(seed);
            let poses = scene.poses(of_variant, seed::derive(seed, 1, 0));
            (scene, poses)
        })
        .collect();
    let flat =
        QuerySettings { cull_probability: 1e-12, stop_above: 1.0, ..QuerySettings::default() };
    let queries = [Query::new(QuerySettings::default())?, Query::new(flat)?];
    let asked: Vec<(&FamilyScene, &LabelledPose)> = variants
        .iter()
        .flat_map(|(scene, poses)| poses.iter().map(move |pose| (scene, pose)))
        .collect();
    asked
        .par_iter()
        .enumerate()
        .map(|(number, (scene, pose))| {
            row(scene, pose, &queries, seed::derive(SEED, number as u64, 2))
                .with_context(|| format!("{}, pose {number}", family.name()))
        })
        .collect()
}

/// The answers of the query as it is by default, and of the flat one, to the same clouds.
fn row(
    scene: &FamilyScene,
    pose: &LabelledPose,
    [default, flat]: &[Query; 2],
    draw: u64,
) -> Result<Row> {
    let cloud = |side| -> Result<Cloud> {
        let seen = scene.observe(side, POINTS, NoiseKind::Gaussian, STD, draw);
        let sensor = SensorModel::Isotropic { std: seen.std };
        Ok(Cloud::prepare(&seen.cloud, &CloudSettings::new(sensor, Mode::Calibrated))?)
    };
    let (a, b) = (cloud(Side::A)?, cloud(Side::B)?);
    let report = default.run(&a, &b, &pose.scene_from_object)?;
    let flat = flat.run(&a, &b, &pose.scene_from_object)?;
    let truth = Truth { collides: pose.in_collision, signed_distance: pose.signed_distance };
    let [low, high] = report.bounds;
    let slack = [(low - ROUNDING).max(0.0), (high + ROUNDING).min(1.0)];
    let said = Said { bounds: Some(slack), ..Said::from(&report) };
    Ok((truth, said, flat.collision_probability))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_miss_is_counted_and_measured() {
        let row = |bounds, flat| {
            let truth = Truth { collides: true, signed_distance: -0.01 };
            let said = Said {
                score: 0.5,
                probability: Some(0.5),
                bounds: Some(bounds),
                evidence: None,
                micros: 1.0,
            };
            (truth, said, flat)
        };
        let cells = cells("two", &[row([0.25, 0.5], 0.5), row([0.5, 0.5], 0.75)]);
        assert_eq!(cells[1], "2");
        assert!(cells[2].starts_with(".500 ["), "{cells:?}");
        assert_eq!([&cells[3], &cells[4]], ["2.5e-1", "1.2e-1"]);
    }
}

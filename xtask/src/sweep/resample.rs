//! How much the probability of one pose varies with the points and errors that a sensor draws.

use anyhow::{Context, Result};
use cloudtouch::{Cloud, CloudSettings, Mode, Query, QuerySettings, noise::SensorModel};
use cloudtouch_geom::seed;
use cloudtouch_testkit::{
    family::{Family, FamilyScene, Side},
    noise::NoiseKind,
    poses::LabelledPose,
};
use rayon::prelude::*;

use super::{SEED, tables::Section, variant};
use crate::common::{
    statistics::quantile,
    table::{Table, probability},
};

const FAMILY: Family = Family::SphereAndPlane;
const POINTS: usize = 5_000;
const STD: f64 = 0.005;
/// Poses among which those nearest to the wanted distances are found.
const CANDIDATES: usize = 200;
/// Signed distances of the poses, m.
const WANTED: [f64; 12] =
    [-0.03, -0.02, -0.015, -0.01, -0.006, -0.002, 0.002, 0.006, 0.01, 0.015, 0.02, 0.03];

/// The section of the document, with so many pairs of clouds for each pose.
pub(super) fn section(draws: u64) -> Result<Section> {
    let seed = variant::seed_of(FAMILY, 0);
    let scene = FAMILY.scene(seed);
    let candidates = scene.poses(CANDIDATES, seed::derive(seed, 2, 0));
    let mut table = Table::new(&[
        "signed distance (mm)",
        "collides",
        "P, 5 %",
        "P, median",
        "P, 95 %",
        "P, mean",
        "P ≥ ½",
    ]);
    for (number, pose) in nearest(candidates)?.iter().enumerate() {
        let said = (0..draws)
            .into_par_iter()
            .map(|draw| answer(&scene, pose, seed::derive(SEED, 3 + number as u64, draw)))
            .collect::<Result<Vec<f64>>>()?;
        let [low, median, high] = [0.05, 0.5, 0.95].map(|q| probability(quantile(&said, q)));
        let share = |of: f64| format!("{:.3}", of / draws as f64);
        table.row([
            format!("{:+.1}", 1e3 * pose.signed_distance),
            if pose.in_collision { "yes" } else { "no" }.to_owned(),
            low,
            median,
            high,
            share(said.iter().sum()),
            share(said.iter().filter(|p| **p >= 0.5).count() as f64),
        ]);
    }
    Ok(Section {
        title: "Fresh clouds of one pose".into(),
        text: format!(
            "A pose collides or not, but a sensor sees other points with other errors each time. \
             For each of these poses of `{}` {draws} fresh pairs of clouds were drawn from the \
             generating surfaces ({POINTS} points, {:.0} mm, so {:.0} and {:.0} mm from point to \
             point); the answers of `calibrated` spread over:\n\n{table}\n",
            FAMILY.name(),
            1e3 * STD,
            1e3 * scene.spacing(Side::A, POINTS),
            1e3 * scene.spacing(Side::B, POINTS),
        ),
    })
}

/// For each distance wanted the nearest of the poses that is not taken yet.
fn nearest(mut poses: Vec<LabelledPose>) -> Result<Vec<LabelledPose>> {
    let mut chosen = Vec::new();
    for wanted in WANTED {
        let off = |p: &LabelledPose| (p.signed_distance - wanted).abs();
        poses.sort_by(|p, q| off(q).total_cmp(&off(p)));
        chosen.push(poses.pop().context("more poses are wanted than drawn")?);
    }
    Ok(chosen)
}

fn answer(scene: &FamilyScene, pose: &LabelledPose, draw: u64) -> Result<f64> {
    let cloud = |side| -> Result<Cloud> {
        let seen = scene.observe(side, POINTS, NoiseKind::Gaussian, STD, draw);
        let sensor = SensorModel::Isotropic { std: seen.std };
        Ok(Cloud::prepare(&seen.cloud, &CloudSettings::new(sensor, Mode::Calibrated))?)
    };
    let (a, b) = (cloud(Side::A)?, cloud(Side::B)?);
    let report = Query::new(QuerySettings::default())?.run(&a, &b, &pose.scene_from_object)?;
    Ok(report.collision_probability)
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;

    use super::*;

    #[test]
    fn each_wanted_distance_gets_a_pose_of_its_own() {
        let pose = |signed_distance: f64| LabelledPose {
            scene_from_object: Pose::identity(),
            in_collision: signed_distance < 0.0,
            signed_distance,
        };
        let mut poses: Vec<LabelledPose> = WANTED.iter().rev().map(|d| pose(d + 1e-4)).collect();
        poses.push(pose(1.0));
        let chosen = nearest(poses).unwrap();
        let off = |(p, wanted): (&LabelledPose, f64)| (p.signed_distance - wanted).abs();
        assert!(chosen.iter().zip(WANTED).map(off).all(|off| off < 1.1e-4));
        assert!(nearest(vec![pose(0.0)]).is_err());
    }
}

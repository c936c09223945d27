//! How often default queries on generated scenes fall back or stay undecided.

use anyhow::{Context, Result};
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, Mode, Report, noise::SensorModel};
use cloudtouch_geom::seed;
use cloudtouch_testkit::{
    family::{Family, FamilyScene, Side},
    noise::NoiseKind,
    poses::LabelledPose,
};
use rayon::prelude::*;

use super::{
    SEED,
    cloud_cases::{default_query, unsound},
    sheet::{Sheet, small},
};
use crate::common::table::Table;

/// Poses of each family.
const POSES: usize = 16;
/// Points of each cloud.
const POINTS: usize = 2_500;
/// Standard deviations of the noise, m.
const STDS: [f64; 3] = [0.0, 0.002, 0.01];

/// Asks default queries of every family and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let header = [
        "family",
        "queries",
        "leaf pairs",
        "problems solved",
        "fallbacks",
        "undecided",
        "largest gap",
    ];
    let mut table = Table::new(&header);
    let mut total = Sum::default();
    for &family in Family::ALL {
        let reports = reports(family).with_context(|| family.name())?;
        let mut sum = Sum::default();
        for report in &reports {
            if let Some(unsound) = unsound(report) {
                sheet.fault(format!("default query, {}: {unsound}", family.name()));
            }
            sum.add(report);
        }
        table.row(sum.cells(family.name()));
        total.join(&sum);
    }
    table.row(total.cells("all"));
    let stds = STDS.map(|std| (1e3 * std).to_string()).join(", ");
    let text = format!(
        "Nine families of scenes, {POSES} poses of each, half of them within 3 cm of contact, \
         {POINTS} points a cloud, noise of {stds} mm, all settings at their defaults. *Undecided* \
         counts places without an answer.\n\n{table}"
    );
    sheet.section("Default queries", text);
    let rate = total.fallbacks as f64 / total.solves.max(1) as f64;
    sheet.goal(
        "default queries: fallbacks below 1 %, nothing undecided",
        format!(
            "{} of {} problems ({:.2} %), {} undecided",
            total.fallbacks,
            total.solves,
            100.0 * rate,
            total.undecided
        ),
        rate < 0.01 && total.undecided == 0,
    );
    Ok(())
}

#[derive(Default)]
struct Sum {
    queries: usize,
    leaf_pairs: usize,
    solves: usize,
    fallbacks: usize,
    undecided: usize,
    gap: f64,
}

impl Sum {
    fn add(&mut self, report: &Report) {
        let stats = &report.stats;
        self.join(&Self {
            queries: 1,
            leaf_pairs: stats.leaf_pairs,
            solves: stats.kernel_solves,
            fallbacks: stats.fallbacks,
            undecided: stats.undecided,
            gap: stats.max_relative_gap,
        });
    }

    fn join(&mut self, other: &Self) {
        self.queries += other.queries;
        self.leaf_pairs += other.leaf_pairs;
        self.solves += other.solves;
        self.fallbacks += other.fallbacks;
        self.undecided += other.undecided;
        self.gap = self.gap.max(other.gap);
    }

    fn cells(&self, name: &str) -> [String; 7] {
        [
            name.into(),
            self.queries.to_string(),
            self.leaf_pairs.to_string(),
            self.solves.to_string(),
            self.fallbacks.to_string(),
            self.undecided.to_string(),
            small(self.gap),
        ]
    }
}

fn reports(family: Family) -> Result<Vec<Report>> {
    let of_family = seed::derive(SEED, family as u64, 0);
    let scene = family.scene(of_family);
    let poses = scene.poses(POSES, seed::derive(of_family, 1, 0));
    let asked: Vec<(usize, &LabelledPose, f64)> = poses
        .iter()
        .enumerate()
        .flat_map(|(number, pose)| STDS.map(|std| (number, pose, std)))
        .collect();
    asked.par_iter().map(|&(number, pose, std)| ask(family, &scene, pose, number, std)).collect()
}

fn ask(
    family: Family,
    scene: &FamilyScene,
    pose: &LabelledPose,
    number: usize,
    std: f64,
) -> Result<Report> {
    let draw = seed::derive(SEED, family as u64, 1 + number as u64);
    let cloud = |side| -> Result<Body> {
        let seen = scene.observe(side, POINTS, NoiseKind::Gaussian, std, draw);
        let sensor = match &seen.cloud.covariances {
            Some(_) => SensorModel::PerPoint,
            None => SensorModel::Isotropic { std: seen.std },
        };
        let settings = CloudSettings::new(sensor, Mode::default());
        Ok(Body::Cloud(Cloud::prepare(&seen.cloud, &settings)?))
    };
    let a = cloud(Side::A)?;
    let b = match family {
        // The gripper is known exactly.
        Family::Tabletop => Body::Mesh(Mesh::prepare(scene.b.mesh())?),
        _ => cloud(Side::B)?,
    };
    Ok(default_query(Mode::default(), (&a).into(), (&b).into(), &pose.scene_from_object)?)
}

//! How often default queries on generated scenes fall back or stay undecided.

use anyhow::{Context, Result};
use cloudtouch::{Body, Cloud, CloudSettings, Mesh, Query, QuerySettings, Report};
use cloudtouch_geom::seed;
use cloudtouch_testkit::{
    family::{Family, FamilyScene, Side},
    noise::NoiseKind,
    poses::LabelledPose,
};
use rayon::prelude::*;

use super::{
    examine::examine,
    sheet::{SEED, Sheet, small},
};
use crate::{methods::sensor_of, page::Section};

/// Poses of each family.
const POSES: usize = 16;
/// Points of each cloud.
const POINTS: usize = 2_500;
/// Standard deviations of the noise, m.
const STDS: [f64; 3] = [0.0, 0.002, 0.01];

/// Asks default queries of every family and adds the section.
pub(super) fn run(sheet: &mut Sheet) -> Result<()> {
    let mut reports = Vec::new();
    for &family in Family::ALL {
        let of_family = reports_of(family).with_context(|| family.name())?;
        for report in &of_family {
            examine(sheet, &format!("default query, {}", family.name()), report, None);
        }
        reports.extend(of_family);
    }
    let sum = |of: fn(&Report) -> usize| reports.iter().map(of).sum::<usize>();
    let [solves, fallbacks, undecided] =
        [sum(|r| r.stats.kernel_solves), sum(|r| r.stats.fallbacks), sum(|r| r.stats.undecided)];
    let rate = fallbacks as f64 / solves.max(1) as f64;
    let gap = reports.iter().map(|r| r.stats.max_relative_gap).fold(0.0, f64::max);
    let text = format!(
        "{} families of scenes, {POSES} poses of each, half of them within 3 cm of contact, \
         {POINTS} points a cloud, noise of {} mm, all settings at their defaults: {} queries looked \
         at {} pairs of leaves and solved {solves} problems, with a largest gap of {}.",
        Family::ALL.len(),
        STDS.map(|std| (1e3 * std).to_string()).join(", "),
        reports.len(),
        sum(|r| r.stats.leaf_pairs),
        small(gap),
    );
    sheet.sections.push(Section::new("Default queries").text(text));
    sheet.goal(
        "default queries: fallbacks below 1 %, nothing undecided",
        format!(
            "{fallbacks} of {solves} problems ({:.2} %), {undecided} places undecided",
            100.0 * rate
        ),
        rate < 0.01 && undecided == 0,
    );
    Ok(())
}

fn reports_of(family: Family) -> Result<Vec<Report>> {
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
        let settings = CloudSettings::new(sensor_of(&seen));
        Ok(Body::Cloud(Cloud::prepare(&seen.cloud, &settings)?))
    };
    let a = cloud(Side::A)?;
    let b = match family {
        // The gripper is known exactly.
        Family::Tabletop => Body::Mesh(Mesh::prepare(scene.b.mesh())?),
        _ => cloud(Side::B)?,
    };
    Ok(Query::new(QuerySettings::default())?.run(&a, &b, &pose.scene_from_object)?)
}

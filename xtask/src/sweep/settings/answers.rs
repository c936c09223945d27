//! The answers and times of every setting on the same poses and the same clouds.

use anyhow::{Context, Result};
use cloudtouch::{Body, Cloud, CloudSettings, Query, noise::SensorModel};
use cloudtouch_geom::{Pose, seed};
use cloudtouch_testkit::{
    family::{Family, FamilyScene, Side},
    noise::NoiseKind,
    poses::LabelledPose,
};

use super::changes::Setting;
use crate::sweep::{
    SEED,
    record::{Answers, Block, Condition, Said, Truth},
    variant,
};

/// Points of each cloud.
pub(super) const POINTS: usize = 5_000;
/// Standard deviation of the noise, m.
pub(super) const STD: f64 = 0.005;
/// How often a query is timed.
const TIMED: usize = 3;
/// Which kinds of contact: solid bodies in a room, thin parts side by side, one smooth contact.
pub(super) const FAMILIES: [Family; 3] =
    [Family::PianoRoom, Family::Furniture, Family::SphereAndPlane];

/// Asks every setting about so many poses of each family, on one thread.
pub(super) fn ask(settings: &[Setting], poses: usize) -> Result<Answers> {
    let mut answers = Answers::default();
    for family in FAMILIES {
        answers.add(block(family, settings, poses)?)?;
        eprintln!("settings: {} done", family.name());
    }
    Ok(answers)
}

fn block(family: Family, settings: &[Setting], poses: usize) -> Result<Block> {
    let mut block = Block {
        condition: Condition {
            family: family.name(),
            points: POINTS,
            noise: NoiseKind::Gaussian,
            std: STD,
        },
        poses: Vec::new(),
        truths: Vec::new(),
        methods: settings.iter().map(|setting| (setting.name(), Vec::new())).collect(),
    };
    for variant in 0..variant::COUNT {
        let seed = variant::seed_of(family, variant);
        let scene = family.scene(seed);
        let drawn = scene.poses(poses.div_ceil(variant::COUNT as usize), seed::derive(seed, 1, 0));
        for pose in drawn {
            let number = block.poses.len() as u32;
            for (setting, (name, said)) in settings.iter().zip(&mut block.methods) {
                let answer = said_of(&scene, &pose, setting, seed::derive(SEED, number.into(), 1));
                said.push(answer.with_context(|| format!("pose {number}, {name}"))?);
            }
            block.poses.push(number);
            block
                .truths
                .push(Truth { collides: pose.in_collision, signed_distance: pose.signed_distance });
        }
    }
    Ok(block)
}

/// The answer, and the least time of a few equal queries after a first one, which makes what is
/// made once for all poses: other work of the machine only ever adds to a time.
fn said_of(scene: &FamilyScene, pose: &LabelledPose, setting: &Setting, draw: u64) -> Result<Said> {
    let a_from_b: &Pose = &pose.scene_from_object;
    let body = |side| -> Result<Body> {
        let observation = scene.observe(side, POINTS, NoiseKind::Gaussian, STD, draw);
        let sensor = SensorModel::Isotropic { std: observation.std };
        let settings =
            CloudSettings { tree: setting.tree, ..CloudSettings::new(sensor, setting.query.mode) };
        Ok(Body::Cloud(Cloud::prepare(&observation.cloud, &settings)?))
    };
    let (a, b) = (body(Side::A)?, body(Side::B)?);
    let query = Query::new(setting.query)?;
    let report = query.run(&a, &b, a_from_b)?;
    let mut micros = f64::INFINITY;
    for _ in 0..TIMED {
        micros = micros.min(query.run(&a, &b, a_from_b)?.stats.query_us as f64);
    }
    Ok(Said { micros, ..Said::from(&report) })
}

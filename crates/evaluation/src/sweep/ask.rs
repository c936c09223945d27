//! Draws every scene of a plan and asks every method about it.

use anyhow::{Context, Result};
use cloudtouch_geom::seed;
use cloudtouch_testkit::family::{FamilyScene, Side};
use cloudtouch_testkit::noise::NoiseKind;
use cloudtouch_testkit::poses::LabelledPose;
use rayon::prelude::*;

use super::plan::Plan;
use super::scenes::Scenes;
use crate::SEED;
use crate::answers::{Answers, Condition, Pair, Question, Row};
use crate::methods::{Draw, Method};

/// A method, and how often it is asked: slow peers answer less.
pub struct Asked {
    /// Who answers.
    pub method: Box<dyn Method>,
    /// 1 for every draw, 2 for every second one.
    pub draw_of: u32,
    /// 1 for every pose, 3 for a third of them.
    pub pose_of: usize,
}

impl Asked {
    /// About every pose of every draw.
    pub fn always(method: impl Method + 'static) -> Self {
        Self { method: Box::new(method), draw_of: 1, pose_of: 1 }
    }
}

/// One draw of a family: its scene and poses.
struct Scene<'a> {
    family: &'a Scenes,
    number: u32,
    scene: FamilyScene,
    poses: Vec<LabelledPose>,
    seed: u64,
}

/// All answers to a plan; the same for any number of threads.
///
/// # Errors
/// When a method fails or gives what is no answer.
pub fn ask(plan: &Plan, methods: &[Asked]) -> Result<Answers> {
    let names = methods.iter().map(|asked| asked.method.name()).collect();
    let mut answers = Answers { methods: names, rows: Vec::new() };
    for family in &plan.families {
        let scenes: Vec<Scene> =
            (0..plan.draws).into_par_iter().map(|number| scene(plan, family, number)).collect();
        let tasks: Vec<(&Scene<'_>, &Condition)> =
            scenes.iter().flat_map(|s| plan.conditions.iter().map(move |c| (s, c))).collect();
        let rows: Vec<Vec<Row>> = tasks
            .into_par_iter()
            .map(|(scene, condition)| {
                of_draw(scene, (&plan.pairs, condition), methods)
                    .with_context(|| format!("{}, draw {}", family.name, scene.number))
            })
            .collect::<Result<_>>()?;
        rows.into_iter().flatten().try_for_each(|row| answers.push(row))?;
        eprintln!("{}: {} answers", family.name, answers.rows.len());
    }
    Ok(answers)
}

fn scene<'a>(plan: &Plan, family: &'a Scenes, number: u32) -> Scene<'a> {
    let seed = seed::derive(SEED, family.number(), seed::derive(plan.stream, number.into(), 0));
    let scene = family.scene(seed);
    let poses = scene.poses(plan.poses, seed::derive(seed, 1, 0));
    Scene { family, number, scene, poses, seed }
}

/// The answers about one draw under one condition.
fn of_draw(
    Scene { family, number, scene, poses, seed }: &Scene<'_>,
    (pairs, condition): (&[Pair], &Condition),
    methods: &[Asked],
) -> Result<Vec<Row>> {
    let Condition { points, std } = *condition;
    // The same for every standard deviation, so that only the size of the errors differs.
    let draw = seed::derive(*seed, points as u64, 2);
    let [a, b] =
        [Side::A, Side::B].map(|side| scene.observe(side, points, NoiseKind::Gaussian, std, draw));
    let seen = Draw { family: family.name, a: &a, b: &b, mesh: scene.b.mesh() };
    let mut rows: Vec<Row> = Vec::new();
    let [of_a, of_b] = [Side::A, Side::B].map(|side| scene.spacing(side, points));
    for &pair in pairs {
        let spacing = pair.pick(of_a.max(of_b), of_a);
        rows.extend(poses.iter().zip(0..).map(|(pose, number_of_pose)| {
            let question = Question {
                family: family.name,
                kind: family.kind,
                pair,
                condition: *condition,
                draw: *number,
                pose: number_of_pose,
                collides: pose.in_collision,
                signed_distance: pose.signed_distance,
                spacing,
            };
            (question, vec![None; methods.len()])
        }));
    }
    for (which, Asked { method, draw_of, pose_of }) in methods.iter().enumerate() {
        if !number.is_multiple_of(*draw_of) {
            continue;
        }
        let prepared = method.prepare(&seen).with_context(|| method.name())?;
        for (question, said) in &mut rows {
            let number = question.pose as usize;
            if number.is_multiple_of(*pose_of) {
                let pose = &poses[number].scene_from_object;
                said[which] = prepared(question.pair, pose)
                    .with_context(|| format!("{}, {question:?}", method.name()))?;
            }
        }
    }
    Ok(rows)
}

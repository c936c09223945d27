//! Fresh clouds for every condition and pose, and what each method says of them.

use anyhow::{Context, Result};
use cloudtouch_geom::{Point3, Pose, seed};
use cloudtouch_testkit::{
    family::{FamilyScene, Observation, Side},
    poses::LabelledPose,
};
use rayon::prelude::*;

use super::{
    SEED,
    ours::Ours,
    plan::{Methods, Part, Plan},
    record::{Answers, Block, Condition, Said, Truth},
    rivals::{Answer, BoxMap, CloudDistance, ObjectMesh, Observed, PlainSvm, SmoothedDistance},
    variant,
};
use crate::calibrate::Fitted;

/// Side of the boxes of a collision map, m.
const BOX: f64 = 0.01;
/// The rank of the distance that no single bad point can move.
const RANK: usize = 5;

/// A variant of a family with its poses, and the moving body as the methods that know it see it.
struct Variant {
    scene: FamilyScene,
    poses: Vec<LabelledPose>,
    boxes_against: ObjectMesh,
}

/// The answers of all methods to all of a plan.
pub(crate) fn all(plan: &Plan) -> Result<Answers> {
    let mut answers = Answers::default();
    let fitted = Fitted::stored()?;
    for part in &plan.parts {
        let variants = variants(part)?;
        let ours = Ours::try_new(plan.methods, part.family, &fitted)?;
        for condition in &part.conditions {
            answers.add(block(&variants, condition, &ours, plan.methods)?)?;
            eprintln!(
                "sweep: {} {} points {} mm done",
                condition.family,
                condition.points,
                1e3 * condition.std
            );
        }
    }
    Ok(answers)
}

fn variants(part: &Part) -> Result<Vec<Variant>> {
    (0..part.variants)
        .into_par_iter()
        .map(|variant| {
            let of_variant = variant::seed_of(part.family, variant);
            let scene = part.family.scene(of_variant);
            let poses = scene.poses(part.poses_of_variant, seed::derive(of_variant, 1, 0));
            let boxes_against = ObjectMesh::try_new(scene.b.mesh())?;
            Ok(Variant { scene, poses, boxes_against })
        })
        .collect()
}

fn block(
    variants: &[Variant],
    condition: &Condition,
    ours: &Ours,
    methods: Methods,
) -> Result<Block> {
    let asked: Vec<(usize, &Variant, usize)> = variants
        .iter()
        .flat_map(|variant| (0..variant.poses.len()).map(move |k| (variant, k)))
        .enumerate()
        .map(|(number, (variant, k))| (number, variant, k))
        .collect();
    let answered: Vec<Vec<(&'static str, Said)>> = asked
        .par_iter()
        .map(|&(number, variant, k)| {
            let draw = seed::derive(SEED, number as u64, seed_of(condition));
            answer(variant, &variant.poses[k], condition, draw, ours, methods)
                .with_context(|| format!("{}, pose {number}", condition.family))
        })
        .collect::<Result<_>>()?;
    let truth = |pose: &LabelledPose| Truth {
        collides: pose.in_collision,
        signed_distance: pose.signed_distance,
    };
    let names = answered.first().map_or(&[][..], Vec::as_slice);
    let methods = (0..names.len())
        .map(|m| (names[m].0.to_owned(), answered.iter().map(|said| said[m].1).collect()))
        .collect();
    Ok(Block {
        condition: condition.clone(),
        poses: asked.iter().map(|&(number, ..)| number as u32).collect(),
        truths: asked.iter().map(|&(_, variant, k)| truth(&variant.poses[k])).collect(),
        methods,
    })
}

/// A number of its own for the density and the distribution; the same for every standard deviation,
/// so that only the size of the errors differs.
fn seed_of(condition: &Condition) -> u64 {
    seed::derive(condition.points as u64, condition.noise as u64, 0)
}

fn answer(
    variant: &Variant,
    pose: &LabelledPose,
    condition: &Condition,
    draw: u64,
    ours: &Ours,
    methods: Methods,
) -> Result<Vec<(&'static str, Said)>> {
    let Condition { points, noise, std, .. } = *condition;
    let [a, b] = [Side::A, Side::B].map(|s| variant.scene.observe(s, points, noise, std, draw));
    let a_from_b = &pose.scene_from_object;
    let mut all = ours.answer(variant.scene.b.mesh(), [&a, &b], a_from_b)?;
    if methods == Methods::All {
        all.extend(rivals([&finite(&a), &finite(&b)], a_from_b, a.std, &variant.boxes_against)?);
    }
    Ok(all)
}

fn rivals(
    [a, b]: [&[Point3]; 2],
    a_from_b: &Pose,
    std: f64,
    mesh_b: &ObjectMesh,
) -> Result<Vec<(&'static str, Said)>> {
    let observed = Observed::try_new(a, b, a_from_b, std)?;
    let raw = CloudDistance::new(RANK).measure(&observed)?;
    let smoothed = SmoothedDistance::new(RANK).measure(&observed)?;
    let of_smoothed = |rank| smoothed.distances.in_units_of(rank, smoothed.scale);
    let boxes = BoxMap::try_new(BOX)?;
    // Yes or no is no probability: like the distances they get one by a fit.
    let graded = |answer: Answer| said(Answer { probability: None, ..answer });
    Ok(vec![
        ("minimum distance", said(raw.in_units_of(1, smoothed.scale)?)),
        ("5th distance", said(raw.in_units_of(RANK, smoothed.scale)?)),
        ("smoothed distance", said(of_smoothed(1)?)),
        ("smoothed 5th distance", said(of_smoothed(RANK)?)),
        ("1 cm boxes, exact object", graded(boxes.against_mesh(&observed, mesh_b))),
        ("1 cm boxes", graded(boxes.against_boxes(&observed))),
        ("plain SVM", said(PlainSvm::default().answer(&observed)?)),
    ])
}

fn said(answer: Answer) -> Said {
    Said {
        score: answer.score,
        probability: answer.probability,
        bounds: None,
        evidence: None,
        micros: answer.micros,
    }
}

/// The rows with a return.
fn finite(observation: &Observation) -> Vec<Point3> {
    let is_finite = |p: &&Point3| p.iter().all(|v| v.is_finite());
    observation.cloud.points.iter().filter(is_finite).copied().collect()
}

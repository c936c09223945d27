//! Normals of contacts, against the shortest way out of the exact overlap.

use anyhow::Result;
use cloudtouch::{Query, QuerySettings};
use cloudtouch_geom::{Pose, Vector3, seed};
use cloudtouch_testkit::exact::WayOut;
use cloudtouch_testkit::family::{FamilyScene, Kind, Side};
use cloudtouch_testkit::noise::NoiseKind;
use cloudtouch_testkit::poses::LabelledPose;
use rayon::prelude::*;

use super::near_contact::{Bodies, STDS};
use crate::SEED;
use crate::answers::Pair;
use crate::methods::Draw;
use crate::report::{Findings, Section, Table, Target};
use crate::statistics::{median, share};
use crate::sweep::Scenes;

/// Classes of poses by their signed distance, from and to, m.
const CLASSES: [(&str, f64, f64); 2] =
    [("overlap to 2 cm", -0.02, 0.0), ("2 to 10 cm", -0.1, -0.02)];
/// An object that moves along the normal by the exact depth, a fourth of it and this, m, is to be free.
const SPARE: f64 = 0.005;
/// In so many overlaps of either class.
const FREED: [f64; 2] = [0.9, 0.7];
const POINTS: usize = 10_000;

const TEXT: &str = "The normal of the likeliest contact beside the shortest translation found to free the exact \
surfaces; ordinary families, 10,000 points, poses with a contact. *Angle*: \
median between the two. *Freed*: the object is out of the exact overlap after moving along the normal by \
the length of that translation, a fourth more and 5 mm.";

/// What is told of a contact.
struct Told {
    pair: Pair,
    std: f64,
    signed_distance: f64,
    angle: f64,
    /// Whether the object is free after moving along the normal.
    is_freed: bool,
}

/// How often normals lead apart.
pub(super) fn measure(draws: u32, poses: usize) -> Findings {
    let ordinary = Scenes::generated().into_iter().filter(|family| family.kind == Kind::Ordinary);
    let draws: Vec<(Scenes, u64)> =
        ordinary.flat_map(|family| (0..draws).map(move |k| (family.clone(), k.into()))).collect();
    let told = draws.par_iter().map(|(family, draw)| of_draw(family, *draw, poses));
    let told: Vec<Told> = told.collect::<Result<Vec<_>>>()?.into_iter().flatten().collect();
    let mut table = Table::new(["pair", "noise", "poses", "contacts", "angle", "freed"]);
    let mut targets = Vec::new();
    for pair in Pair::ALL {
        let of_class = |from: f64, to: f64| {
            let keep = move |t: &&Told| t.pair == pair && (from..to).contains(&t.signed_distance);
            told.iter().filter(keep)
        };
        for std in STDS {
            for (class, from, to) in CLASSES {
                let of: Vec<&Told> = of_class(from, to).filter(|t| t.std == std).collect();
                let angles: Vec<f64> = of.iter().map(|told| told.angle).collect();
                let freed = format!("{:.2}", freed(of.iter().copied()));
                let (noise, count) = (format!("{:.0} mm", 1e3 * std), of.len().to_string());
                let angle = format!("{:.0}°", median(&angles));
                table.row([pair.to_string().as_str(), &noise, class, &count, &angle, &freed]);
            }
        }
        for ((class, from, to), least) in CLASSES.into_iter().zip(FREED) {
            let (share, percent) = (freed(of_class(from, to)), 100.0 * least);
            let what = format!("{pair}, {class}: freed along the normal in ≥ {percent:.0} %");
            targets.push(Target::new(what, format!("{:.0} %", 100.0 * share), share >= least));
        }
    }
    Ok((Section::new("Normals of contacts").text(TEXT).text(table), targets))
}

fn freed<'a>(of: impl IntoIterator<Item = &'a Told>) -> f64 {
    share(of.into_iter().map(|told| told.is_freed))
}

fn of_draw(family: &Scenes, draw: u64, poses: usize) -> Result<Vec<Told>> {
    let from = seed::derive(SEED, family.number(), draw);
    let scene = family.scene(from);
    let poses = scene.poses(poses, seed::derive(from, 1, 0));
    let ways: Vec<_> = poses.iter().map(|pose| way_out(&scene, pose)).collect();
    let query = Query::new(QuerySettings::default())?;
    let mut told = Vec::new();
    for std in STDS {
        let drawn = seed::derive(from, 2, 0);
        let [a, b] = [Side::A, Side::B]
            .map(|side| scene.observe(side, POINTS, NoiseKind::Gaussian, std, drawn));
        let mesh = scene.b.mesh();
        let bodies = Bodies::prepare(&Draw { family: family.name, a: &a, b: &b, mesh })?;
        for (LabelledPose { scene_from_object, signed_distance, .. }, way) in
            poses.iter().zip(&ways)
        {
            let Some(way) = way else { continue };
            for pair in Pair::ALL {
                let (a, b) = bodies.pair(pair);
                let report = query.run(a, b, scene_from_object)?;
                let Some(contact) = report.contacts.first() else { continue };
                let normal = contact.normal_a_to_b;
                let angle = normal.dot(way).clamp(-1.0, 1.0).acos().to_degrees();
                let length = -1.25 * signed_distance + SPARE;
                let moved = Pose::from_translation(normal * length).after(scene_from_object);
                let is_freed = !scene.a.touches(&scene.b, &moved, scene.touch);
                told.push(Told { pair, std, signed_distance: *signed_distance, angle, is_freed });
            }
        }
    }
    Ok(told)
}

/// The shortest way out of an overlap; `None` beyond the classes, and where the way is not known.
fn way_out(scene: &FamilyScene, labelled: &LabelledPose) -> Option<Vector3> {
    let (pose, distance) = (&labelled.scene_from_object, labelled.signed_distance);
    let (_, deepest, _) = CLASSES[1];
    if !(deepest..0.0).contains(&distance) {
        return None;
    }
    // As long as is known, and a little longer: its direction is not.
    let known = WayOut { direction: Vector3::zeros(), length: -1.05 * distance + 1e-5 };
    let way = scene.a.shortest_way_out(&scene.b, pose, scene.touch, known);
    way.direction.try_normalize(0.0)
}

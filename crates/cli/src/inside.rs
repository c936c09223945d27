//! Points inside of a closed mesh, told beside those that may touch: in a picture of a deep overlap they are
//! what one looks for.

use std::collections::BTreeMap;

use cloudtouch::geom::Pose;
use cloudtouch::{PairAnswer, Report, Scene, SceneError};

use crate::body::{Body, PreparedCloud};

/// The report with the larger of both probabilities for every point.
pub(crate) fn with_points_inside<C: PreparedCloud>(
    mut report: Report,
    (scene, object): (&Body<C>, &Body<C>),
    scene_from_object: &Pose,
) -> Report {
    let likely = &mut report.point_probabilities;
    match (scene, object) {
        (Body::Cloud(cloud), Body::Mesh(mesh)) => {
            add(&mut likely.a, cloud.inside(mesh, &scene_from_object.inverse()));
        }
        (Body::Mesh(mesh), Body::Cloud(cloud)) => {
            add(&mut likely.b, cloud.inside(mesh, scene_from_object));
        }
        _ => {}
    }
    report
}

/// The same of a pair of bodies of a scene.
pub(crate) fn of_a_pair(
    mut report: Report,
    pair: &PairAnswer,
    scene: &Scene,
) -> Result<Report, SceneError> {
    use cloudtouch::Body::{Cloud, Mesh};

    let likely = &mut report.point_probabilities;
    let from = |seen_from, of| scene.between(seen_from, of);
    match (&**scene.body(&pair.a)?, &**scene.body(&pair.b)?) {
        (Cloud(cloud), Mesh(mesh)) => {
            add(&mut likely.a, cloud.points_inside(mesh, &from(&pair.b, &pair.a)?));
        }
        (Mesh(mesh), Cloud(cloud)) => {
            add(&mut likely.b, cloud.points_inside(mesh, &from(&pair.a, &pair.b)?));
        }
        _ => {}
    }
    Ok(report)
}

fn add(likely: &mut Vec<(usize, f64)>, inside: Vec<(usize, f64)>) {
    let mut all: BTreeMap<usize, f64> = likely.iter().copied().collect();
    for (index, probability) in inside {
        let known = all.entry(index).or_insert(probability);
        *known = known.max(probability);
    }
    *likely = all.into_iter().collect();
}

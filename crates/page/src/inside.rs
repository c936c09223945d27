//! Points inside of a closed mesh, told beside those that may touch: in a picture of a deep overlap they are
//! what one looks for.

use std::collections::BTreeMap;

use cloudtouch::{Body, PairAnswer, Report, Scene, SceneError};

/// Probabilities of points, such as those that may touch and those that are inside, each by its index: the larger
/// of both for each, in their order.
#[must_use]
pub fn larger_of_both(one: Vec<(usize, f64)>, other: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    let mut all: BTreeMap<usize, f64> = one.into_iter().collect();
    for (index, probability) in other {
        let known = all.entry(index).or_insert(probability);
        *known = known.max(probability);
    }
    all.into_iter().collect()
}

/// The answer to a pair of a scene, with the points that are inside of a mesh, if there is one.
pub(crate) fn colored(pair: &PairAnswer, scene: &Scene) -> Result<Option<Report>, SceneError> {
    let Ok(report) = &pair.answer else { return Ok(None) };
    let mut report = report.clone();
    let likely = &mut report.point_probabilities;
    let add = |known: &mut Vec<(usize, f64)>, inside| {
        *known = larger_of_both(std::mem::take(known), inside);
    };
    match (&**scene.body(&pair.a)?, &**scene.body(&pair.b)?) {
        (Body::Cloud(cloud), Body::Mesh(mesh)) => {
            let inside = cloud.points_inside(mesh, &scene.between(&pair.b, &pair.a)?);
            add(&mut likely.a, inside);
        }
        (Body::Mesh(mesh), Body::Cloud(cloud)) => {
            let inside = cloud.points_inside(mesh, &scene.between(&pair.a, &pair.b)?);
            add(&mut likely.b, inside);
        }
        _ => {}
    }
    Ok(Some(report))
}

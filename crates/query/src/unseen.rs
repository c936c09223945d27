//! Space that was never seen: an object wholly behind the surfaces of a single depth image may be
//! inside something, and no leaf pair can tell.

use cloudtouch_geom::{Point3, Pose};

use crate::cloud::Prepared;
use crate::shape::Shape;

/// How many points stand for a body here.
const SAMPLES: usize = 100;
/// An object with this share of its surface behind the scan counts as hidden.
const HIDDEN_SHARE: f64 = 0.5;

/// Whether either body lies mostly behind what the other, a cloud, saw.
pub(crate) fn is_either_hidden(a: Shape<'_>, b: Shape<'_>, a_from_b: &Pose) -> bool {
    match (a, b) {
        (Shape::Cloud(cloud), b) if is_hidden(cloud, b, a_from_b) => true,
        (a, Shape::Cloud(cloud)) => is_hidden(cloud, a, &a_from_b.inverse()),
        _ => false,
    }
}

/// Whether the other body lies mostly behind what `cloud` saw, so that "no surface near" does not
/// mean "free". False when the cloud has no depth image. Of several, one that looked into the space
/// before its surfaces tells that it is empty.
fn is_hidden(cloud: &Prepared, other: Shape<'_>, cloud_from_other: &Pose) -> bool {
    if cloud.views().is_empty() {
        return false;
    }
    let samples = coarse_samples(other);
    let measured = (cloud.points(), cloud.sensor());
    let is_hidden = |p: &&Point3| {
        let place = cloud_from_other.transform_point(p);
        let told: Vec<bool> =
            cloud.views().iter().filter_map(|view| view.is_behind(measured, &place)).collect();
        !told.is_empty() && told.iter().all(|is_behind| *is_behind)
    };
    let hidden = samples.iter().filter(is_hidden).count();
    hidden as f64 >= HIDDEN_SHARE * samples.len() as f64
}

/// Evenly chosen leaves, by their middle: close to the surface and spread over all of it.
fn coarse_samples(body: Shape<'_>) -> Vec<Point3> {
    let tree = body.tree();
    let centers: Vec<Point3> = tree.leaves().map(|leaf| leaf.obb().centre).collect();
    let step = centers.len().div_ceil(SAMPLES).max(1);
    centers.into_iter().step_by(step).collect()
}

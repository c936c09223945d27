//! Space that was never seen: an object wholly behind the surfaces of a single depth image may be
//! inside something, and no leaf pair can tell.

use cloudtouch_geom::{Point3, Pose, UncertainPoint};
use cloudtouch_svm::separate;

use crate::body::BodyRef;
use crate::cloud::Cloud;

/// How many points stand for a body here.
const SAMPLES: usize = 100;
/// An object with this share of its surface behind the scan counts as hidden.
const HIDDEN_SHARE: f64 = 0.5;

/// Whether the other body lies mostly behind what `cloud` saw, so that "no surface near" does not
/// mean "free".
///
/// False when the cloud is not a single view, or when a plane separates coarse samples of the two
/// bodies: then neither contains the other.
pub(crate) fn is_hidden(cloud: &Cloud, other: BodyRef<'_>, cloud_from_other: &Pose) -> bool {
    let Some(view) = cloud.view() else { return false };
    let of_other: Vec<Point3> =
        coarse_samples(other).iter().map(|p| cloud_from_other.transform_point(p)).collect();
    let exact = |points: &[Point3]| -> Vec<UncertainPoint> {
        points.iter().map(|&p| UncertainPoint::exact(p)).collect()
    };
    let of_cloud = coarse_samples(BodyRef::Cloud(cloud));
    if separate(&exact(&of_cloud), &exact(&of_other), 1.0).is_some() {
        return false;
    }
    let hidden = of_other.iter().filter(|p| view.is_behind(cloud, p)).count();
    hidden as f64 >= HIDDEN_SHARE * of_other.len() as f64
}

/// Evenly chosen leaves, by their middle: close to the surface and spread over all of it.
fn coarse_samples(body: BodyRef<'_>) -> Vec<Point3> {
    let tree = body.tree();
    let centers: Vec<Point3> = tree.leaves().map(|leaf| leaf.obb().centre).collect();
    let step = centers.len().div_ceil(SAMPLES).max(1);
    centers.into_iter().step_by(step).collect()
}

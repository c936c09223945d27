//! Points inside of a closed mesh, told beside those that may touch: in a picture of a deep overlap they are
//! what one looks for.

use cloudtouch::Report;
use cloudtouch::geom::Pose;
use cloudtouch_page::larger_of_both;

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

fn add(likely: &mut Vec<(usize, f64)>, inside: Vec<(usize, f64)>) {
    *likely = larger_of_both(std::mem::take(likely), inside);
}

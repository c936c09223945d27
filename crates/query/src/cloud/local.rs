//! The local frame of a cloud, in which far offsets keep their millimetres.

use std::sync::Arc;

use cloudtouch_geom::{Point3, Vector3};

/// The origin of a frame for points in the box between these corners: where it was, as long as they are not farther
/// from it than they are from one another, so that no precision is lost; else the middle of the box.
pub(super) fn origin_for(current: Vector3, (low, high): (&Point3, &Point3)) -> Vector3 {
    let middle = nalgebra::center(low, high).coords;
    if (middle - current).norm() <= (high - low).norm() { current } else { middle }
}

/// Points in the frame of an origin: those themselves where that is the frame of the file, as for most sensors.
pub(super) fn local(points: &Arc<Vec<Point3>>, origin: &Vector3) -> Arc<Vec<Point3>> {
    if *origin == Vector3::zeros() {
        return points.clone();
    }
    points.iter().map(|point| point - origin).collect::<Vec<_>>().into()
}

//! Where the object lies in the scene, for people to see whether the pose is the one they meant.

use cloudtouch_geom::{Point3, Pose};
use serde::Serialize;

use crate::shape::Shape;

/// Boxes of both bodies in the frame of A, and how far apart they and their points are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Placement {
    /// Lowest and highest corner of A along the axes of its frame, m.
    pub scene_box: [[f64; 3]; 2],
    /// Lowest and highest corner of B along the same axes, m: of its own box turned by the pose, and
    /// so never too small.
    pub object_box: [[f64; 3]; 2],
    /// Distance of the two boxes, m; zero where they overlap.
    pub box_gap_m: f64,
    /// Distance from a point of the cloud to the nearest of some hundred places on the other body, m,
    /// never smaller than that of the surfaces as sampled. `None` between meshes.
    pub nearest_m: Option<f64>,
}

/// Where `b` lies in `a` at a pose from the file frame of `b` into that of `a`. Takes about a
/// millisecond.
pub(crate) fn place(a: Shape<'_>, b: Shape<'_>, a_from_b: &Pose) -> Placement {
    let local = a.local_from(&b, a_from_b);
    let [scene_box, object_box] =
        boxes(a, b, a_from_b).map(|corners| corners.map(|p| p.coords.into()));
    Placement {
        scene_box,
        object_box,
        box_gap_m: box_gap(a, b, &local),
        nearest_m: nearest(a, b, &local).or_else(|| nearest(b, a, &local.inverse())),
    }
}

/// The boxes of both bodies along the axes of A, in its file frame, m; that of `b` never too small.
pub(crate) fn boxes(a: Shape<'_>, b: Shape<'_>, a_from_b: &Pose) -> [[Point3; 2]; 2] {
    let of_b = moved(b.corners(), &a.local_from(&b, a_from_b));
    [a.corners(), of_b].map(|corners| corners.map(|p| p + a.origin()))
}

/// Distance of the boxes of two bodies along the axes of A, m; `a_from_b` maps local frames.
pub(crate) fn box_gap(a: Shape<'_>, b: Shape<'_>, a_from_b: &Pose) -> f64 {
    gap(&a.corners(), &moved(b.corners(), a_from_b))
}

/// Distance of two boxes, m; zero where they overlap.
pub(crate) fn gap([low, high]: &[Point3; 2], [other_low, other_high]: &[Point3; 2]) -> f64 {
    let apart = (other_low - high).sup(&(low - other_high));
    apart.map(|along| along.max(0.0)).norm()
}

/// The box around a moved box.
pub(crate) fn moved([low, high]: [Point3; 2], pose: &Pose) -> [Point3; 2] {
    let middle = pose.transform_point(&nalgebra::center(&low, &high));
    let turn = pose.rotation().to_rotation_matrix().into_inner().abs();
    let half = turn * (0.5 * (high - low));
    [middle - half, middle + half]
}

/// From the points of a cloud to places on another body.
fn nearest(cloud: Shape<'_>, other: Shape<'_>, cloud_from_other: &Pose) -> Option<f64> {
    let Shape::Cloud(cloud) = cloud else { return None };
    let samples = other.samples();
    let distances = samples.iter().map(|sample| {
        cloud.distance_to(&cloud_from_other.transform_point(sample)).unwrap_or(f64::INFINITY)
    });
    Some(distances.fold(f64::INFINITY, f64::min)).filter(|distance| distance.is_finite())
}

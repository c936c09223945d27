//! Parts put where they belong.

use cloudtouch_geom::{Point3, Pose, TriangleMesh, Vector3};

use crate::scene::{cylinder, moved};

/// What stands on something sinks this far into it, so that nothing merely touches, m.
pub(super) const SUNK: f64 = 0.001;

/// Parts of a moving body keep this far apart: its mesh then has one inside, m.
pub(super) const GAP: f64 = 0.002;

/// A part shifted by an offset.
pub(super) fn at(part: &TriangleMesh, offset: [f64; 3]) -> TriangleMesh {
    placed(part, offset, [0.0; 3])
}

/// A part turned about its z axis, then shifted.
pub(super) fn turned(part: &TriangleMesh, yaw: f64, offset: [f64; 3]) -> TriangleMesh {
    placed(part, offset, [0.0, 0.0, yaw])
}

/// A part turned by roll, pitch and yaw, then shifted.
pub(super) fn placed(part: &TriangleMesh, offset: [f64; 3], rpy: [f64; 3]) -> TriangleMesh {
    moved(part, &Pose::from_translation_rpy(Vector3::from(offset), rpy))
}

/// A box by its ranges along x, y and z.
pub(super) fn ranges(x: [f64; 2], y: [f64; 2], z: [f64; 2]) -> [[f64; 3]; 2] {
    [0, 1].map(|end| [x[end], y[end], z[end]])
}

/// A cylinder that stands on z = 0.
pub(super) fn upright(radius: f64, height: f64, sides: usize) -> TriangleMesh {
    at(&cylinder(radius, height, sides), [0.0, 0.0, 0.5 * height])
}

/// A disc with its axis along y, around a middle.
pub(super) fn wheel(radius: f64, width: f64, sides: usize, middle: [f64; 3]) -> TriangleMesh {
    placed(&cylinder(radius, width, sides), middle, [std::f64::consts::FRAC_PI_2, 0.0, 0.0])
}

/// Corners of a path.
pub(super) fn path<const N: usize>(corners: [[f64; 3]; N]) -> [Point3; N] {
    corners.map(Point3::from)
}

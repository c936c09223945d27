//! Which way is up in a scene.

use cloudtouch::geom::{Point3, bounding_box};
use serde::Serialize;

/// How the picture of a scene is turned at first; the page has a button for the other way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Upright {
    /// z is up.
    Z,
    /// As a depth camera at the origin sees it: z forward, y down.
    Camera,
}

/// Nearer to its origin than this no depth camera sees, m.
const NEAREST: f64 = 0.15;

/// A guess: a scene is in a camera's frame when all of it lies ahead along z, with the origin behind
/// it and no farther to its side than it is wide.
pub(crate) fn upright<'a>(points: impl IntoIterator<Item = &'a Point3>) -> Upright {
    let Some((low, high)) = bounding_box(points) else { return Upright::Z };
    let is_around_axis = |k: usize| low[k] < 0.0 && high[k] > 0.0;
    if low.z > NEAREST && is_around_axis(0) && is_around_axis(1) {
        Upright::Camera
    } else {
        Upright::Z
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_room_stands_on_its_floor_and_a_view_of_a_camera_is_looked_at_from_there() {
        let of = |low: [f64; 3], high: [f64; 3]| upright(&[low.into(), high.into()]);
        assert_eq!(of([-2.6, -2.1, -0.05], [2.6, 2.1, 2.5]), Upright::Z);
        assert_eq!(of([-0.45, -0.42, 0.56], [0.49, 0.28, 1.4]), Upright::Camera);
        // A table as a robot has it before it.
        assert_eq!(of([0.4, -0.5, 0.7], [1.2, 0.5, 1.0]), Upright::Z);
        assert_eq!(upright(&[]), Upright::Z);
    }
}

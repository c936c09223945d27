//! Signed distances at the cost of some hundred overlap tests.

use cloudtouch_geom::{Pose, Vector3};
use nalgebra::UnitQuaternion;

use super::ExactMesh;
use crate::scene::sphere;

/// What counts as contact of two meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// The solids have a point in common; both meshes are closed.
    Solids,
    /// The surfaces have a point in common; the meshes may be open.
    Surfaces,
}

/// A translation of the second mesh that ends the contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WayOut {
    /// Unit vector in the first mesh's frame.
    pub direction: Vector3,
    /// How far along it, m.
    pub length: f64,
}

impl ExactMesh {
    /// Whether the two meshes are in contact.
    pub fn touches(&self, other: &Self, self_from_other: &Pose, touch: Touch) -> bool {
        match touch {
            Touch::Solids => self.solids_overlap(other, self_from_other),
            Touch::Surfaces => self.intersects(other, self_from_other),
        }
    }

    /// The distance when free; in contact minus an upper bound on the shortest translation that
    /// ends it, m; minus infinity when none was found.
    ///
    /// Unlike [`penetration_depth`](Self::penetration_depth) it looks first along 42 directions
    /// (for a convex contact the nearest is at most 20° off) and then closer around the best, and
    /// gives up a direction that is not free at the length to be undercut: some ten times fewer
    /// overlap tests. Never deeper than a way out that is `known`.
    pub fn signed_distance(
        &self,
        other: &Self,
        self_from_other: &Pose,
        touch: Touch,
        known: Option<WayOut>,
    ) -> f64 {
        let free_at = |offset: Vector3| {
            !self.touches(other, &Pose::from_translation(offset).after(self_from_other), touch)
        };
        if free_at(Vector3::zeros()) {
            return self.distance(other, self_from_other);
        }
        let size =
            |m: &Self| m.mesh().bounding_box().map_or(0.0, |(low, high)| (high - low).norm());
        let mut best = known.unwrap_or(WayOut {
            direction: Vector3::z(),
            // Not a way out yet, but none needs to be longer.
            length: size(self) + size(other),
        });
        let mut found = known.is_some();
        for direction in sphere(1.0, 1).vertices() {
            found |= shorten(&mut best, direction.coords, &free_at);
        }
        for angle in [0.3, 0.15, 0.08, 0.04] {
            let around = best.direction;
            for direction in ring(&around, angle) {
                found |= shorten(&mut best, direction, &free_at);
            }
        }
        if found { -best.length } else { f64::NEG_INFINITY }
    }
}

/// Takes a shorter way out along `direction`, if there is one; whether there was.
fn shorten(best: &mut WayOut, direction: Vector3, free_at: &impl Fn(Vector3) -> bool) -> bool {
    let mut high = 0.99 * best.length;
    if !free_at(direction * high) {
        return false;
    }
    let mut low = 0.0;
    while high - low > 1e-6_f64.max(2e-3 * high) {
        let middle = 0.5 * (low + high);
        if free_at(direction * middle) { high = middle } else { low = middle }
    }
    *best = WayOut { direction, length: high };
    true
}

/// Six unit vectors at an angle from a unit vector, evenly around it.
fn ring(axis: &Vector3, angle: f64) -> impl Iterator<Item = Vector3> {
    let across = axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize();
    let tilted = UnitQuaternion::from_scaled_axis(across * angle) * axis;
    let axis = *axis;
    (0..6).map(move |k| {
        UnitQuaternion::from_scaled_axis(axis * (f64::from(k) * std::f64::consts::FRAC_PI_3))
            * tilted
    })
}

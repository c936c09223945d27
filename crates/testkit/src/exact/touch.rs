//! What counts as contact, and the shortest translation that ends it.

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

    /// The shortest way out of contact that is found, given one that is known.
    ///
    /// Its length is an upper bound on the penetration depth. It looks along the 162 directions of
    /// [`penetration_depth`](Self::penetration_depth), then closer around the best, but gives up a
    /// direction that is not free at the length to be undercut: far fewer tests, and as good when
    /// the known way is not much too long.
    pub fn shortest_way_out(
        &self,
        other: &Self,
        self_from_other: &Pose,
        touch: Touch,
        known: WayOut,
    ) -> WayOut {
        let free_at = |offset: Vector3| {
            !self.touches(other, &Pose::from_translation(offset).after(self_from_other), touch)
        };
        let mut best = known;
        for direction in sphere(1.0, 2).vertices() {
            shorten(&mut best, direction.coords, &free_at);
        }
        for angle in [0.15, 0.08, 0.04] {
            let around = best.direction;
            for direction in ring(&around, angle) {
                shorten(&mut best, direction, &free_at);
            }
        }
        best
    }
}

/// Takes a shorter way out along `direction`, if there is one.
fn shorten(best: &mut WayOut, direction: Vector3, free_at: &impl Fn(Vector3) -> bool) {
    let mut high = 0.99 * best.length;
    if !free_at(direction * high) {
        return;
    }
    let mut low = 0.0;
    while high - low > 1e-6_f64.max(2e-3 * high) {
        let middle = 0.5 * (low + high);
        if free_at(direction * middle) { high = middle } else { low = middle }
    }
    *best = WayOut { direction, length: high };
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

//! How deep two solids overlap, from above.

use cloudtouch_geom::{Pose, Vector3};

use super::ExactMesh;
use crate::scene::sphere;

impl ExactMesh {
    /// An upper bound on the penetration depth, m: a translation of `other` that short ends the
    /// overlap of the two solids. Zero when they do not overlap.
    ///
    /// The shortest found among 162 directions; too large, never too small. For a convex contact
    /// the nearest direction is at most 11° off, which costs 2 %. Infinite when no direction
    /// frees them within the sum of their sizes.
    pub fn penetration_depth(&self, other: &Self, self_from_other: &Pose) -> f64 {
        if !self.solids_overlap(other, self_from_other) {
            return 0.0;
        }
        let size =
            |m: &Self| m.mesh().bounding_box().map_or(0.0, |(low, high)| (high - low).norm());
        let reach = size(self) + size(other);
        let mut best = f64::INFINITY;
        for direction in sphere(1.0, 2).vertices() {
            let limit = best.min(reach);
            if let Some(depth) = self.way_out(other, self_from_other, &direction.coords, limit) {
                best = depth;
            }
        }
        best
    }

    /// The length of a translation along `direction` below `limit` that frees the solids.
    fn way_out(&self, other: &Self, pose: &Pose, direction: &Vector3, limit: f64) -> Option<f64> {
        let free_at = |t: f64| {
            !self.solids_overlap(other, &Pose::from_translation(direction * t).after(pose))
        };
        // The overlap may end and begin again on the way: look at a few places, from afar.
        let probes = std::iter::once(0.99).chain((1..8).map(|k| 0.5_f64.powi(k)));
        let mut high = probes.map(|share| share * limit).find(|&t| free_at(t))?;
        let mut low = 0.0;
        while high - low > 1e-6_f64.max(1e-3 * high) {
            let middle = 0.5 * (low + high);
            if free_at(middle) { high = middle } else { low = middle }
        }
        Some(high)
    }
}

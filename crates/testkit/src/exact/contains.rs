//! Inside tests by the winding number: no special case at edges and corners.

use cloudtouch_geom::Point3;

use super::ExactMesh;

impl ExactMesh {
    /// Whether a point lies inside a component, by the winding number.
    ///
    /// The mesh must be closed and oriented; it may go either way within rounding of the surface.
    pub fn contains(&self, point: &Point3) -> bool {
        // A closed component does not wrap around what is outside of its box; NaN is in no box.
        let around = self.components.iter().filter(|c| c.box_contains(point));
        around.map(|c| self.winding(point, &c.triangles)).sum::<f64>().abs() > 0.5
    }

    /// How often the surface wraps around the point: 1 inside, 0 outside when oriented outward.
    ///
    /// A sum of solid angles over 4π, each by the formula of Van Oosterom and Strackee.
    pub fn winding_number(&self, point: &Point3) -> f64 {
        self.components.iter().map(|c| self.winding(point, &c.triangles)).sum()
    }

    fn winding(&self, point: &Point3, triangles: &[u32]) -> f64 {
        let half_angles: f64 = triangles
            .iter()
            .map(|&t| {
                let [a, b, c] = self.mesh().corners(t as usize).map(|p| p - point);
                let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
                let numerator = a.cross(&b).dot(&c);
                let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
                numerator.atan2(denominator)
            })
            .sum();
        half_angles / std::f64::consts::TAU
    }
}

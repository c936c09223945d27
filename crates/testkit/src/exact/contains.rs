//! Inside tests by the winding number: no special case at edges and corners.

use cloudtouch_geom::Point3;

use super::ExactMesh;

impl ExactMesh {
    /// Whether a point lies inside a component, by the winding number over every triangle.
    ///
    /// The mesh must be closed and oriented; it may go either way within rounding of the surface.
    pub fn contains(&self, point: &Point3) -> bool {
        let outside =
            |(low, high): (Point3, Point3)| (0..3).any(|k| point[k] < low[k] || point[k] > high[k]);
        // NaN is in no box and inside nothing.
        if self.mesh().bounding_box().is_none_or(outside) || point.iter().any(|v| v.is_nan()) {
            return false;
        }
        self.winding_number(point).abs() > 0.5
    }

    /// How often the surface wraps around the point: 1 inside, 0 outside when oriented outward.
    ///
    /// A sum of solid angles over 4π, each by the formula of Van Oosterom and Strackee.
    pub fn winding_number(&self, point: &Point3) -> f64 {
        let half_angles: f64 = (0..self.mesh().triangles().len())
            .map(|t| {
                let [a, b, c] = self.mesh().corners(t).map(|p| p - point);
                let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
                let numerator = a.cross(&b).dot(&c);
                let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
                numerator.atan2(denominator)
            })
            .sum();
        half_angles / std::f64::consts::TAU
    }
}

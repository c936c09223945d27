//! Uniform scaling of a pair of clouds to the unit box, covariances included.

use std::f64::consts::SQRT_2;

use cloudtouch_geom::{Point3, UncertainPoint, Vector3};

use crate::problem::sample::Sample;

/// A translation and one scale factor for all axes that bring some points to the size of a unit box;
/// a kernel width then means the same for every pair.
///
/// The size is taken from the ball around the centroid that holds all points, and set to that of
/// the ball around a unit square: a square patch of surface gets side 1 however it is turned. The
/// sides of an axis-aligned box would change with the frame, and the answer with them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct UnitBox {
    centre: Point3,
    scale: f64,
}

impl UnitBox {
    /// The map that changes nothing.
    pub(crate) fn identity() -> Self {
        Self { centre: Point3::origin(), scale: 1.0 }
    }

    /// The map that brings the means of `points` to that size; `None` when there are no points or
    /// one is not finite.
    ///
    /// Points that all coincide are scaled by their largest standard deviation instead, and by 1
    /// when that is zero too.
    pub fn around<'a>(
        points: impl IntoIterator<Item = &'a UncertainPoint, IntoIter: Clone>,
    ) -> Option<Self> {
        let points = points.into_iter();
        let first = points.clone().next()?.mean;
        let count = points.clone().count() as f64;
        // Relative to the first point: a sum of map coordinates would round.
        let shift: Vector3 = points.clone().map(|p| (p.mean - first) / count).sum();
        let centre = first + shift;
        let mut radius = 0.0_f64;
        let mut std = 0.0_f64;
        for point in points {
            let distance = (point.mean - centre).norm();
            if !distance.is_finite() {
                return None;
            }
            radius = radius.max(distance);
            std = std.max(point.covariance.std_bound());
        }
        let scale = [SQRT_2 * radius, std]
            .into_iter()
            .map(f64::recip)
            .find(|scale| *scale > 0.0 && scale.is_finite())
            .unwrap_or(1.0);
        Some(Self { centre, scale })
    }

    /// The same place with another scale, in box lengths per metre: for many pairs alike.
    #[must_use]
    pub fn with_scale(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// Box lengths per metre: a gradient inside times this is the gradient outside.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Maps a point into the box.
    pub fn point_inside(&self, point: &Point3) -> Point3 {
        Point3::from((point - self.centre) * self.scale)
    }

    /// Maps a point of the box back.
    pub fn point_outside(&self, point: &Point3) -> Point3 {
        self.centre + point.coords / self.scale
    }

    /// Maps a gradient taken in the box to one per metre.
    pub fn gradient_outside(&self, gradient: &Vector3) -> Vector3 {
        gradient * self.scale
    }

    /// Maps mean and covariance into the box: Σ becomes scale²·Σ.
    pub fn uncertain_point_inside(&self, point: &UncertainPoint) -> UncertainPoint {
        UncertainPoint {
            mean: self.point_inside(&point.mean),
            covariance: point.covariance.scaled(self.scale),
        }
    }

    /// Maps a sample into the box; radius and penalty have no length and stay.
    pub fn sample_inside(&self, sample: &Sample) -> Sample {
        Sample { point: self.uncertain_point_inside(&sample.point), ..*sample }
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Covariance;

    use super::*;

    fn point(x: f64, y: f64, z: f64) -> UncertainPoint {
        UncertainPoint { mean: Point3::new(x, y, z), covariance: Covariance::isotropic(0.04) }
    }

    #[test]
    fn a_square_gets_side_one_however_it_is_turned_and_points_come_back() {
        let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
        for angle in [0.0_f64, 0.3, 0.8] {
            let (sin, cos) = angle.sin_cos();
            let turned =
                corners.map(|(x, y)| point(5e6 + cos * x - sin * y, sin * x + cos * y, 1.0));
            let unit = UnitBox::around(&turned).unwrap();
            assert!((unit.scale() - 0.25).abs() < 1e-9);
            for p in &turned {
                let inside = unit.uncertain_point_inside(p);
                assert!((inside.mean.coords.norm() - 0.5 * SQRT_2).abs() < 1e-9);
                assert!((inside.covariance.max_std() - 0.05).abs() < 1e-9);
                assert!((unit.point_outside(&inside.mean) - p.mean).norm() < 1e-9);
            }
            let gradient = unit.gradient_outside(&Vector3::x());
            assert!((gradient - Vector3::x() * 0.25).norm() < 1e-9);
        }
    }

    #[test]
    fn degenerate_clouds_have_a_scale() {
        assert!(UnitBox::around(&[]).is_none());
        assert!(UnitBox::around(&[point(f64::NAN, 0.0, 0.0)]).is_none());
        assert!(UnitBox::around(&[point(0.0, 0.0, 0.0), point(f64::INFINITY, 0.0, 0.0)]).is_none());
        let same = UnitBox::around(&[point(1.0, 1.0, 1.0); 3]).unwrap();
        assert!((same.scale() * 0.2 * 3.0_f64.sqrt() - 1.0).abs() < 1e-12);
        let exact = UncertainPoint::exact(Point3::new(1.0, 2.0, 3.0));
        assert_eq!(UnitBox::around(&[exact]).unwrap().scale(), 1.0);
    }
}

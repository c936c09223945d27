//! Uniform scaling of a pair of clouds to the unit box, covariances included.

use cloudtouch_geom::{Point3, UncertainPoint, Vector3};

use crate::Sample;

/// A translation and one scale factor for all axes that map some points into a box of side 1
/// around the origin; a kernel width then means the same for every pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UnitBox {
    centre: Point3,
    scale: f64,
}

impl UnitBox {
    /// The map that changes nothing.
    pub(crate) fn identity() -> Self {
        Self { centre: Point3::origin(), scale: 1.0 }
    }

    /// The map that puts the means of `points` into the box; `None` when there are no points or
    /// one is not finite.
    ///
    /// Points that all coincide are scaled by their largest standard deviation instead, and by 1
    /// when that is zero too.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a UncertainPoint>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        let (mut low, mut high) = (first.mean, first.mean);
        let mut std = first.covariance.std_bound();
        let mut finite = first.mean.iter().all(|v| v.is_finite());
        for point in points {
            finite &= point.mean.iter().all(|v| v.is_finite());
            low = low.inf(&point.mean);
            high = high.sup(&point.mean);
            std = std.max(point.covariance.std_bound());
        }
        if !finite {
            return None;
        }
        let side = (high.coords * 0.5 - low.coords * 0.5).max() * 2.0;
        let scale = [side, std]
            .into_iter()
            .map(f64::recip)
            .find(|scale| *scale > 0.0 && scale.is_finite())
            .unwrap_or(1.0);
        Some(Self { centre: Point3::from(low.coords * 0.5 + high.coords * 0.5), scale })
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
    fn the_longest_side_becomes_one_and_points_come_back() {
        let points = [point(5e6, 1.0, 0.0), point(5e6 + 4.0, 2.0, 0.5)];
        let unit = UnitBox::around(&points).unwrap();
        assert!((unit.scale() - 0.25).abs() < 1e-12);
        for p in &points {
            let inside = unit.uncertain_point_inside(p);
            assert!(inside.mean.coords.amax() <= 0.5 + 1e-12);
            assert!((inside.covariance.max_std() - 0.05).abs() < 1e-12);
            assert!((unit.point_outside(&inside.mean) - p.mean).norm() < 1e-9);
        }
        assert_eq!(unit.gradient_outside(&Vector3::x()), Vector3::x() * 0.25);
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

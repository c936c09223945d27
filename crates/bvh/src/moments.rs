//! Mean and covariance of positions, computed about a local origin so that they survive
//! coordinates of millions of metres.

use cloudtouch_geom::{Covariance, Matrix3, Point3, Vector3};

use crate::Primitive;

/// How many primitives there are, and how their positions spread.
///
/// Every primitive counts 1; a triangle spreads its share over its three corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// Number of primitives.
    pub count: usize,
    /// Mean position, m.
    pub mean: Point3,
    /// Mean of (p − mean)(p − mean)ᵀ, m².
    pub covariance: Covariance,
}

impl Moments {
    /// The moments of the primitives named by `indices`; zero when there are none.
    pub(crate) fn of(primitives: &[Primitive], indices: &[u32]) -> Self {
        let Some(&first) = indices.first() else {
            return Self { count: 0, mean: Point3::origin(), covariance: Covariance::zero() };
        };
        let named = || indices.iter().map(|&i| &primitives[i as usize]);
        let origin = primitives[first as usize].centroid();
        let sum: Vector3 = named().map(|primitive| primitive.centroid() - origin).sum();
        let mean = origin + sum / indices.len() as f64;
        let mut scatter = Matrix3::zeros();
        for primitive in named() {
            let corners = primitive.corners();
            let share = 1.0 / corners.len() as f64;
            for corner in corners {
                let offset = corner - mean;
                scatter += offset * (offset.transpose() * share);
            }
        }
        let covariance = Covariance::from_symmetric(&(scatter / indices.len() as f64));
        Self { count: indices.len(), mean, covariance }
    }

    /// The moments of both sets together (Chan's update).
    pub(crate) fn merged(&self, other: &Self) -> Self {
        let count = self.count + other.count;
        let share = other.count as f64 / count as f64;
        let offset = other.mean - self.mean;
        let between = offset * offset.transpose() * (share * (1.0 - share));
        let within = self.covariance.matrix() * (1.0 - share) + other.covariance.matrix() * share;
        Self {
            count,
            mean: self.mean + offset * share,
            covariance: Covariance::from_symmetric(&(within + between)),
        }
    }

    /// The variation σ_n = σ₁/(σ₁+σ₂+σ₃) with σ₁ the smallest eigenvalue of the covariance.
    ///
    /// 0 for positions on a plane (or a line, or one point), 1/3 for an even spread.
    pub fn variation(&self) -> f64 {
        let (values, _) = self.covariance.eigen();
        let total = values.sum();
        if total > 0.0 { values[2] / total } else { 0.0 }
    }

    /// Unit axes as columns, right-handed, from the largest variance to the smallest.
    pub(crate) fn axes(&self) -> Matrix3 {
        let (_, mut axes) = self.covariance.eigen();
        if axes.determinant() < 0.0 {
            axes.column_mut(2).neg_mut();
        }
        axes
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::UncertainPoint;

    use super::*;

    fn points(count: usize, offset: Vector3) -> Vec<Primitive> {
        (0..count as u64)
            .map(|i| {
                let draw = |k| cloudtouch_geom::seed::unit(cloudtouch_geom::seed::derive(3, i, k));
                let p = Point3::new(draw(0), 0.5 * draw(1), 0.01 * draw(2)) + offset;
                Primitive::point(UncertainPoint::exact(p))
            })
            .collect()
    }

    #[test]
    fn merging_equals_computing_at_once() {
        let all = points(70, Vector3::zeros());
        let indices: Vec<u32> = (0..70).collect();
        let whole = Moments::of(&all, &indices);
        let merged = Moments::of(&all, &indices[..13]).merged(&Moments::of(&all, &indices[13..]));
        assert_eq!(merged.count, 70);
        assert!((merged.mean - whole.mean).norm() < 1e-14);
        assert!((merged.covariance.matrix() - whole.covariance.matrix()).amax() < 1e-14);
    }

    #[test]
    fn millions_of_metres_away_keep_the_spread() {
        let indices: Vec<u32> = (0..200).collect();
        let near = Moments::of(&points(200, Vector3::zeros()), &indices);
        let far = Moments::of(&points(200, Vector3::new(5e6, -4e6, 100.0)), &indices);
        // Coordinates of 5e6 are rounded to 1e-9, so variances of 1e-5 keep about five digits.
        assert!((far.variation() / near.variation() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn variation_tells_flat_from_round() {
        let corner = |x, y, z| Primitive::point(UncertainPoint::exact(Point3::new(x, y, z)));
        let flat = [corner(0.0, 0.0, 0.0), corner(1.0, 0.0, 0.0), corner(0.0, 2.0, 0.0)];
        assert!(Moments::of(&flat, &[0, 1, 2]).variation() < 1e-15);
        assert_eq!(Moments::of(&flat, &[1]).variation(), 0.0);
        let round: Vec<_> = [(1.0, 0), (-1.0, 0), (1.0, 1), (-1.0, 1), (1.0, 2), (-1.0, 2)]
            .map(|(sign, axis)| {
                Primitive::point(UncertainPoint::exact(Point3::from(Vector3::ith(axis, sign))))
            })
            .into();
        let even = Moments::of(&round, &[0, 1, 2, 3, 4, 5]).variation();
        assert!((even - 1.0 / 3.0).abs() < 1e-12);
    }
}

//! Mean and covariance of positions, computed about a local origin so that they survive
//! coordinates of millions of metres.

use cloudtouch_geom::{Covariance, Matrix3, Point3, Vector3};

use crate::tree::primitive::centroid;

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
    /// Of nothing.
    pub(crate) const NONE: Self =
        Self { count: 0, mean: Point3::new(0.0, 0.0, 0.0), covariance: Covariance::zero() };

    /// The moments of primitives, given by their corners; zero when there are none.
    pub(crate) fn of<'a>(primitives: impl Iterator<Item = &'a [Point3]> + Clone) -> Self {
        let Some(first) = primitives.clone().next() else { return Self::NONE };
        let origin = centroid(first);
        let mut count = 0;
        let mut sum = Vector3::zeros();
        for corners in primitives.clone() {
            count += 1;
            sum += centroid(corners) - origin;
        }
        let mean = origin + sum / count as f64;
        let [mut xx, mut xy, mut xz, mut yy, mut yz, mut zz] = [0.0; 6];
        for corners in primitives {
            let share = 1.0 / corners.len() as f64;
            for corner in corners {
                let offset = corner - mean;
                let part = offset * share;
                xx += part.x * offset.x;
                xy += part.x * offset.y;
                xz += part.x * offset.z;
                yy += part.y * offset.y;
                yz += part.y * offset.z;
                zz += part.z * offset.z;
            }
        }
        let scatter = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let covariance = Covariance::from_symmetric(&(scatter / count as f64));
        Self { count, mean, covariance }
    }

    /// The variation σ_n = σ₁/(σ₁+σ₂+σ₃) with σ₁ the smallest eigenvalue of the covariance.
    ///
    /// 0 for positions on a plane (or a line, or one point), 1/3 for an even spread.
    pub fn variation(&self) -> f64 {
        let (values, _) = self.covariance.eigen();
        let total = values.sum();
        if total > 0.0 { values[2] / total } else { 0.0 }
    }

    /// The same where its axes are known: the last is that of the smallest eigenvalue.
    pub(crate) fn variation_by(&self, axes: &Matrix3) -> f64 {
        let total = self.covariance.std_bound().powi(2);
        let smallest = self.covariance.variance_along(&axes.column(2).into_owned());
        if total > 0.0 { smallest / total } else { 0.0 }
    }

    /// Unit axes as columns, right-handed, from the largest variance to the smallest.
    pub(crate) fn axes(&self) -> Matrix3 {
        right_handed(self.covariance.eigen().1)
    }

    /// The axes of two, in little more than the time of one.
    pub(crate) fn axes_of_two([one, other]: [&Self; 2]) -> [Matrix3; 2] {
        let eigen = Covariance::eigen_of_two([&one.covariance, &other.covariance]);
        eigen.map(|(_, axes)| right_handed(axes))
    }
}

fn right_handed(mut axes: Matrix3) -> Matrix3 {
    if axes.determinant() < 0.0 {
        axes.column_mut(2).neg_mut();
    }
    axes
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::UncertainPoint;

    use crate::Primitive;

    use super::*;

    /// The moments of those named by indices.
    fn of(primitives: &[Primitive], indices: &[u32]) -> Moments {
        Moments::of(indices.iter().map(|&i| primitives[i as usize].corners()))
    }

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
    fn millions_of_metres_away_keep_the_spread() {
        let indices: Vec<u32> = (0..200).collect();
        let near = of(&points(200, Vector3::zeros()), &indices);
        let far = of(&points(200, Vector3::new(5e6, -4e6, 100.0)), &indices);
        // Coordinates of 5e6 are rounded to 1e-9, so variances of 1e-5 keep about five digits.
        assert!((far.variation() / near.variation() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn variation_tells_flat_from_round() {
        let corner = |x, y, z| Primitive::point(UncertainPoint::exact(Point3::new(x, y, z)));
        let flat = [corner(0.0, 0.0, 0.0), corner(1.0, 0.0, 0.0), corner(0.0, 2.0, 0.0)];
        assert!(of(&flat, &[0, 1, 2]).variation() < 1e-15);
        assert_eq!(of(&flat, &[1]).variation(), 0.0);
        let round: Vec<_> = [(1.0, 0), (-1.0, 0), (1.0, 1), (-1.0, 1), (1.0, 2), (-1.0, 2)]
            .map(|(sign, axis)| {
                Primitive::point(UncertainPoint::exact(Point3::from(Vector3::ith(axis, sign))))
            })
            .into();
        let even = of(&round, &[0, 1, 2, 3, 4, 5]).variation();
        assert!((even - 1.0 / 3.0).abs() < 1e-12);
    }
}

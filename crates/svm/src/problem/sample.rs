//! What the classifier is trained on: uncertain points with a side, a radius and a penalty.

use cloudtouch_geom::UncertainPoint;

/// Which of the two clouds a point belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Class {
    /// Label +1: the decision function is meant to be positive here.
    A,
    /// Label −1: the decision function is meant to be negative here.
    B,
}

impl Class {
    /// The label c: +1 for [`Class::A`], −1 for [`Class::B`].
    pub fn sign(self) -> f64 {
        match self {
            Self::A => 1.0,
            Self::B => -1.0,
        }
    }

    /// The other class.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::A => Self::B,
            Self::B => Self::A,
        }
    }
}

/// One training point with the ellipsoid that has to stay on its side of the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Mean and covariance, both in the frame the kernel width is meant for.
    pub point: UncertainPoint,
    /// Which cloud the point belongs to.
    pub class: Class,
    /// Radius r of the ellipsoid in standard deviations (eq. 11 and 12); 0 makes the point exact.
    pub radius: f64,
    /// Penalty C on the point's margin violation; positive.
    pub penalty: f64,
}

/// Penalties for the two classes that weigh the same in sum and average to `penalty` per point.
///
/// C_A = C·(n_A+n_B)/(2 n_A) and likewise for B, so that a small cloud is not sacrificed to a large
/// one. A class without points gets `penalty` itself.
pub fn balanced_penalties(penalty: f64, count_a: usize, count_b: usize) -> (f64, f64) {
    let total = (count_a + count_b) as f64;
    let of =
        |count: usize| if count == 0 { penalty } else { penalty * total / (2.0 * count as f64) };
    (of(count_a), of(count_b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn balanced_classes_weigh_the_same() {
        let (a, b) = balanced_penalties(100.0, 10, 40);
        assert!((a * 10.0 - b * 40.0).abs() < 1e-9);
        assert!((a * 10.0 + b * 40.0 - 100.0 * 50.0).abs() < 1e-9);
        assert_eq!(balanced_penalties(3.0, 0, 5).0, 3.0);
    }
}

//! Bounds on the spread and the movement of points.

use cloudtouch_geom::{Covariance, Matrix3, Vector3};

use crate::TreeError;

/// What a later refinement may do to the points of a leaf.
///
/// An expensive noise model is run on a leaf only when a query first visits it; these bounds, cheap
/// to get beforehand, keep [`crate::Traversal::Certified`] right about leaves it never visits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeafBounds {
    /// The largest standard deviation (m) any of the points may have after refinement, in any
    /// direction; infinite when nothing is known.
    pub std: f64,
    /// How far (m) the mean of any of the points may move; finite, as single precision has it.
    pub shift: f64,
    /// How far (m) the surface that any of the points stands for may reach from its mean, in any
    /// direction; as finite.
    pub reach: f64,
}

impl LeafBounds {
    /// Refuses what bounds nothing.
    pub(crate) fn check(&self, leaf: usize) -> Result<(), TreeError> {
        let Self { std, shift, reach } = *self;
        let is_length = |value: f64| (0.0..f64::from(f32::MAX)).contains(&value);
        if std >= 0.0 && is_length(shift) && is_length(reach) {
            Ok(())
        } else {
            Err(TreeError::LeafBounds { leaf, std, shift, reach })
        }
    }
}

/// Bounds on all points of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SpreadBounds {
    /// Largest standard deviation in any direction, m.
    pub(crate) max_std: f64,
    /// Largest standard deviation along each box axis, m.
    pub(crate) axis_std: Vector3,
    /// How far a mean may move, m.
    pub(crate) shift: f64,
    /// How far the surface a point stands for reaches from its mean, in any direction and along each
    /// box axis, m.
    pub(crate) max_reach: f64,
    pub(crate) axis_reach: Vector3,
}

impl SpreadBounds {
    pub(crate) const NONE: Self = Self {
        max_std: 0.0,
        axis_std: Vector3::new(0.0, 0.0, 0.0),
        shift: 0.0,
        max_reach: 0.0,
        axis_reach: Vector3::new(0.0, 0.0, 0.0),
    };

    /// The bounds of one primitive of this covariance (`None` for a triangle) seen along `axes`: those
    /// given for its refinement, else the covariance and the extent given.
    pub(crate) fn of(
        covariance: Option<&Covariance>,
        refined: Option<LeafBounds>,
        extent: Option<&Covariance>,
        axes: &Matrix3,
    ) -> Self {
        let own = Self::NONE;
        if let Some(LeafBounds { std, shift, reach }) = refined {
            return Self { shift, ..own.with_std(std).with_reach(reach) };
        }
        let own = match covariance {
            None => own,
            Some(covariance) => match covariance.isotropic_variance() {
                Some(variance) => own.with_std(variance.sqrt()),
                None => {
                    Self { max_std: covariance.max_std(), axis_std: along(covariance, axes), ..own }
                }
            },
        };
        match extent {
            None => own,
            Some(extent) => {
                Self { max_reach: extent.max_std(), axis_reach: along(extent, axes), ..own }
            }
        }
    }

    fn with_std(self, std: f64) -> Self {
        Self { max_std: std, axis_std: Vector3::repeat(std), ..self }
    }

    fn with_reach(self, reach: f64) -> Self {
        Self { max_reach: reach, axis_reach: Vector3::repeat(reach), ..self }
    }

    /// The same bounds along other axes: |n·a_k| s_k adds up to at least the deviation along n, and
    /// as much for the reach.
    pub(crate) fn turned(&self, from: &Matrix3, to: &Matrix3) -> Self {
        let turn = to.tr_mul(from).abs();
        let axis_std = (turn * self.axis_std).map(|std| std.min(self.max_std));
        let axis_reach = (turn * self.axis_reach).map(|reach| reach.min(self.max_reach));
        Self { axis_std, axis_reach, ..*self }
    }

    /// Bounds that hold for both, seen along the same axes.
    pub(crate) fn max(&self, other: &Self) -> Self {
        Self {
            max_std: self.max_std.max(other.max_std),
            axis_std: self.axis_std.sup(&other.axis_std),
            shift: self.shift.max(other.shift),
            max_reach: self.max_reach.max(other.max_reach),
            axis_reach: self.axis_reach.sup(&other.axis_reach),
        }
    }

    /// A bound on the standard deviation (m) along a unit vector, given the axes of the box.
    ///
    /// The deviation of a sum is at most the sum of the deviations, Σ |n·a_k| s_k.
    pub(crate) fn std_along(&self, axes: &Matrix3, direction: &Vector3) -> f64 {
        self.max_std.min(axes.tr_mul(direction).abs().dot(&self.axis_std))
    }
}

/// Variances along three axes.
pub(crate) fn variances_along(covariance: &Covariance, axes: &Matrix3) -> Vector3 {
    let of = |k| covariance.variance_along(&axes.column(k).into_owned());
    Vector3::new(of(0), of(1), of(2))
}

/// Standard deviations along three axes.
fn along(covariance: &Covariance, axes: &Matrix3) -> Vector3 {
    variances_along(covariance, axes).map(f64::sqrt)
}

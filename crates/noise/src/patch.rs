//! The neighbourhood of one point as the surface fit sees it.

use cloudtouch_geom::{Covariance, Vector3};

/// Neighbours in order of distance, relative to the point they surround.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch<'a> {
    /// xⱼ − xᵢ, m.
    pub(crate) offsets: &'a [Vector3],
    /// Σⱼ of each of them.
    noise: &'a [Covariance],
    /// Σᵢ of the point itself.
    own_noise: &'a Covariance,
    /// The least variance a residual is judged by, m².
    floor: f64,
}

/// A plane n·y = height in coordinates relative to the point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    /// Unit normal, of either sign.
    pub(crate) normal: Vector3,
    /// Height of the plane above the point along the normal, m.
    pub(crate) height: f64,
}

/// Even a noise-free surface bends between its samples: residuals of this part of the spacing
/// are taken for nothing.
const FLOOR_PER_SPACING: f64 = 0.03;

impl<'a> Patch<'a> {
    /// Neighbours about a point whose local spacing is `spacing`, m.
    pub(crate) fn new(
        offsets: &'a [Vector3],
        noise: &'a [Covariance],
        own_noise: &'a Covariance,
        spacing: f64,
    ) -> Self {
        Self { offsets, noise, own_noise, floor: (FLOOR_PER_SPACING * spacing).powi(2) }
    }

    /// The first `count` neighbours only.
    pub(crate) fn nearest(&self, count: usize) -> Self {
        Self { offsets: &self.offsets[..count], noise: &self.noise[..count], ..*self }
    }

    /// Offsets of the neighbours with the variances their residuals along a unit normal are
    /// judged by, m².
    pub(crate) fn with_variances(
        &self,
        normal: &Vector3,
    ) -> impl Iterator<Item = (&'a Vector3, f64)> {
        let (along, floor) = (Along::new(normal), self.floor);
        let variance = move |noise| along.variance(noise).max(floor);
        self.offsets.iter().zip(self.noise.iter().map(variance))
    }

    /// The variance of the point itself along a unit normal, by the same measure.
    pub(crate) fn own_variance(&self, normal: &Vector3) -> f64 {
        Along::new(normal).variance(self.own_noise).max(self.floor)
    }

    /// An upper bound of [`Self::own_variance`] over all normals.
    pub(crate) fn largest_own_variance(&self) -> f64 {
        self.own_noise.std_bound().powi(2).max(self.floor)
    }
}

/// The products of a direction that turn the six entries of a covariance into its variance along
/// it: prepared once, they take a third of the time of a matrix product.
#[derive(Clone, Copy)]
struct Along([f64; 6]);

impl Along {
    fn new(n: &Vector3) -> Self {
        let (x, y, z) = (n.x, n.y, n.z);
        Self([x * x, 2.0 * x * y, 2.0 * x * z, y * y, 2.0 * y * z, z * z])
    }

    fn variance(&self, covariance: &Covariance) -> f64 {
        let entries = covariance.upper_triangle();
        self.0.iter().zip(entries).map(|(product, entry)| product * entry).sum()
    }
}

//! The neighbourhood of one point as the surface fit sees it.

use cloudtouch_geom::{Covariance, Vector3};

/// Neighbours in order of distance, relative to the point they surround.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch<'a> {
    /// xⱼ − xᵢ, m.
    pub(crate) offsets: &'a [Vector3],
    /// Σⱼ of each of them.
    noise: PatchNoise<'a>,
    /// Σᵢ of the point itself.
    own_noise: &'a Covariance,
    /// The least variance a residual is judged by, m².
    floor: f64,
}

/// Σⱼ of each neighbour.
#[derive(Debug, Clone, Copy)]
pub(crate) enum PatchNoise<'a> {
    /// The same for all.
    Uniform(&'a Covariance),
    Each(&'a [Covariance]),
}

impl PatchNoise<'_> {
    fn nearest(&self, count: usize) -> Self {
        match self {
            Self::Uniform(covariance) => Self::Uniform(covariance),
            Self::Each(all) => Self::Each(&all[..count]),
        }
    }
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
        noise: PatchNoise<'a>,
        own_noise: &'a Covariance,
        spacing: f64,
    ) -> Self {
        Self { offsets, noise, own_noise, floor: (FLOOR_PER_SPACING * spacing).powi(2) }
    }

    /// The first `count` neighbours only.
    pub(crate) fn nearest(&self, count: usize) -> Self {
        Self { offsets: &self.offsets[..count], noise: self.noise.nearest(count), ..*self }
    }

    /// Offsets of the neighbours with the variances their residuals along a unit normal are
    /// judged by, m².
    pub(crate) fn with_variances(
        &self,
        normal: &Vector3,
    ) -> impl Iterator<Item = (&'a Vector3, f64)> {
        let (normal, floor) = (*normal, self.floor);
        let along = move |noise: &Covariance| noise.variance_along(&normal).max(floor);
        let (same, each) = match self.noise {
            PatchNoise::Uniform(covariance) => (along(covariance), None),
            PatchNoise::Each(all) => (floor, Some(all)),
        };
        let variance = move |i: usize| each.map_or(same, |all| along(&all[i]));
        self.offsets.iter().enumerate().map(move |(i, offset)| (offset, variance(i)))
    }

    /// The variance of the point itself along a unit normal, by the same measure.
    pub(crate) fn own_variance(&self, normal: &Vector3) -> f64 {
        self.own_noise.variance_along(normal).max(self.floor)
    }

    /// An upper bound of [`Self::own_variance`] over all normals.
    pub(crate) fn largest_own_variance(&self) -> f64 {
        self.own_noise.std_bound().powi(2).max(self.floor)
    }
}

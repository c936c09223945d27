//! From a measured point and its neighbourhood to an uncertain surface point.

use std::f64::consts::SQRT_2;

use cloudtouch_geom::{Covariance, UncertainPoint, UnitVector3};

use crate::discretization::sampling_error;
use crate::error::NoiseError;
use crate::index::neighbor::Neighbor;
use crate::index::spacing::{SPACING_NEIGHBORS, spacing_around};
use crate::index::spatial_order::in_spatial_order;
use crate::index::ties::widened;
use crate::limited::limited;
use crate::neighborhoods::Neighborhoods;
use crate::parallel::parallel;
use crate::posterior::{disc, posterior};
use crate::refined::{Bounds, Refined};
use crate::representatives::Representatives;
use crate::scratch::Scratch;
use crate::sensor::noise::SensorNoise;
use crate::settings::{Combination, NoiseSettings};
use crate::surface::patch::MOST_NEIGHBORS;

/// Turns measured points into uncertain surface points.
///
/// Pure: what comes out of [`refine`](Self::refine) depends on its arguments alone, bit for bit,
/// whatever was refined before and on whichever thread.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NoiseModel {
    settings: NoiseSettings,
}

/// The bounds are a hair wider than the clamps, which round.
const ROUNDING: f64 = 1e-9;

impl NoiseModel {
    /// A model with checked settings.
    ///
    /// # Errors
    /// When [`NoiseSettings::validate`] objects.
    pub fn new(settings: NoiseSettings) -> Result<Self, NoiseError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// The settings.
    pub fn settings(&self) -> &NoiseSettings {
        &self.settings
    }

    /// Mean and covariance of the surface point behind point `index`.
    ///
    /// `sensor` holds the position noise of all points. The local spacing never counts as larger
    /// than `spacing_cap` (m, not negative, infinity for no cap), and no discretization standard
    /// deviation does where [`is_capped`](crate::Discretization::is_capped) says so: on that
    /// [`bounds`](Self::bounds) rests.
    ///
    /// With [`Combination::SurfacePosterior`] the covariance is v n nᵀ + t² (I − n nᵀ), n the normal
    /// and t the disc of d spacings ([`PosteriorSettings::disc_std`](crate::PosteriorSettings::disc_std)), widened by
    /// the noise where it is uncertain which way the surface faces. A point whose neighbourhood determines no plane
    /// (alone, on a line, fewer than five distinct positions) keeps its place and gets Σᵢ + (d h)² I, h the spacing.
    /// With the other combinations a point without neighbours keeps Σᵢ, to which `Convolution` adds the
    /// cap unless it is infinite. A point that is not finite has no neighbours.
    ///
    /// Where the noise exceeds the spacing of the cloud, refine [`Representatives`]
    /// ([`refine_representative`](Self::refine_representative)): here a point that noise took off its surface is taken for
    /// one of few, and stays too far off.
    ///
    /// # Panics
    /// When `index` or the length of `sensor` does not belong to the cloud, or a covariance of `sensor` that it needs is
    /// not finite.
    pub fn refine(
        &self,
        index: usize,
        neighborhoods: &Neighborhoods,
        sensor: &SensorNoise,
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Refined {
        self.refined(index, neighborhoods, None, sensor, spacing_cap, scratch)
    }

    /// [`Self::refine`] of one of the points that stand for all: the surface is fitted to every point,
    /// but the spacing, and the disc as wide as it, are those of the representatives.
    ///
    /// # Panics
    /// When `index`, the representatives or the length of `sensor` do not belong to the cloud, or a covariance of
    /// `sensor` that it needs is not finite.
    pub fn refine_representative(
        &self,
        index: usize,
        neighborhoods: &Neighborhoods,
        representatives: &Representatives,
        sensor: &SensorNoise,
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Refined {
        self.refined(index, neighborhoods, Some(representatives), sensor, spacing_cap, scratch)
    }

    /// Makes buffers ready for the refinement of some points near one another, each by itself afterwards:
    /// it is faster then, and comes out the same. `reach` is how far about the refinement of one nearby
    /// looked ([`Scratch::reach`]), m, where that is known.
    ///
    /// # Panics
    /// When an index does not belong to the cloud.
    pub fn gather(
        &self,
        indices: impl Iterator<Item = usize>,
        neighborhoods: &Neighborhoods,
        reach: Option<f64>,
        scratch: &mut Scratch,
    ) {
        let Scratch { block, places, .. } = scratch;
        places.clear();
        places.extend(indices.map(|index| neighborhoods.points()[index]));
        block.gather(neighborhoods.positions(), places, self.neighbors(), reach);
    }

    /// How many neighbours a point is refined by.
    fn neighbors(&self) -> usize {
        match self.settings.combination {
            Combination::SurfacePosterior => MOST_NEIGHBORS,
            _ => self.settings.discretization.neighbors.max(SPACING_NEIGHBORS),
        }
    }

    fn refined(
        &self,
        index: usize,
        neighborhoods: &Neighborhoods,
        representatives: Option<&Representatives>,
        sensor: &SensorNoise,
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Refined {
        let points = neighborhoods.points();
        assert_eq!(sensor.len(), points.len(), "one sensor covariance for each point");
        let is_by_surface = self.settings.combination == Combination::SurfacePosterior;
        scratch.near_representatives.clear();
        let around = match representatives {
            // Mostly the nearest of all points tell no more than how dense they are, which is known.
            Some(representatives) if is_by_surface => {
                scratch.neighbors.clear();
                // Which points stand for the others hangs on all of them.
                scratch.reach = f64::INFINITY;
                representatives.spacing(index, neighborhoods, sensor)
            }
            _ => {
                let count = self.neighbors();
                neighborhoods.look_around(index, count, scratch);
                scratch.reach = reach(&scratch.neighbors, count);
                spacing_around(&scratch.neighbors)
            }
        };
        let spacing = around.unwrap_or(0.0).min(spacing_cap);
        if is_by_surface
            && let Some(around) = around
            && let Some(on_surface) = posterior(
                index,
                (neighborhoods, representatives, sensor),
                [around, spacing_cap],
                &self.settings.posterior,
                scratch,
            )
        {
            return on_surface;
        }
        let covariance =
            self.without_surface(index, neighborhoods, sensor, [spacing, spacing_cap], scratch);
        Refined {
            point: UncertainPoint { mean: points[index], covariance },
            spacing,
            normal: None,
            shared: 0.0,
        }
    }

    /// The noise of a point that stays where it was measured, with the neighbours in `scratch`; its spacing and the most
    /// that may be are in m.
    fn without_surface(
        &self,
        index: usize,
        neighborhoods: &Neighborhoods,
        sensor: &SensorNoise,
        [spacing, spacing_cap]: [f64; 2],
        scratch: &mut Scratch,
    ) -> Covariance {
        let own = &sensor[index];
        match self.settings.combination {
            Combination::Precision => {
                let psi = self.sampling_error(index, neighborhoods, spacing_cap, scratch);
                psi.map_or(*own, |psi| parallel(own, &psi))
            }
            Combination::Convolution => {
                let alone = if spacing_cap.is_finite() { spacing_cap } else { 0.0 };
                let psi = self
                    .sampling_error(index, neighborhoods, spacing_cap, scratch)
                    .unwrap_or(Covariance::isotropic(alone * alone));
                own.sum(&psi)
            }
            Combination::SurfacePosterior => {
                let disc = (self.settings.posterior.disc_std * spacing).powi(2);
                own.sum(&Covariance::isotropic(disc))
            }
        }
    }

    /// [`Self::refine`] of every point, on all threads of the pool; the same bits with any number of
    /// them.
    ///
    /// # Panics
    /// When the length of `sensor` does not belong to the cloud, or a covariance of it is not finite.
    pub fn refine_all(
        &self,
        neighborhoods: &Neighborhoods,
        sensor: &SensorNoise,
        spacing_cap: f64,
    ) -> Vec<Refined> {
        in_spatial_order(neighborhoods.points(), |index, scratch| {
            self.refine(index, neighborhoods, sensor, spacing_cap, scratch)
        })
    }

    /// Mean and covariance of a surface point whose normal is known, not fitted: the point stays
    /// where it was measured, with v n nᵀ + (d h)² (I − n nᵀ), d the
    /// [`disc_std`](crate::PosteriorSettings::disc_std) and h the spacing, v the variance of `sensor` along the normal
    /// and a part of the spacing. Within [`bounds`](Self::bounds).
    ///
    /// # Panics
    /// When `index` does not belong to the cloud.
    pub fn with_normal(
        &self,
        index: usize,
        normal: UnitVector3,
        neighborhoods: &Neighborhoods,
        sensor: &Covariance,
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Refined {
        neighborhoods.nearest_into(index, SPACING_NEIGHBORS, &mut scratch.neighbors);
        scratch.reach = reach(&scratch.neighbors, SPACING_NEIGHBORS);
        let spacing = spacing_around(&scratch.neighbors).unwrap_or(0.0).min(spacing_cap);
        let settings = &self.settings.posterior;
        let across = settings.disc_std * spacing;
        Refined {
            point: UncertainPoint {
                mean: neighborhoods.points()[index],
                covariance: disc(
                    &normal,
                    sensor.variance_along(&normal),
                    across,
                    spacing,
                    settings,
                ),
            },
            spacing,
            normal: Some(normal),
            shared: 0.0,
        }
    }

    /// Upper bounds on what [`refine`](Self::refine) does to a point whose position noise has no standard
    /// deviation above `sigma` (m), whatever its neighbours; infinite for `Convolution` without a cap on
    /// Ψ, where only the neighbours tell.
    pub fn bounds(&self, sigma: f64, spacing_cap: f64) -> Bounds {
        let widened = |part: f64| {
            // No part of a spacing without a cap is none.
            let spread = if part > 0.0 { part * spacing_cap } else { 0.0 };
            sigma.hypot(spread) * (1.0 + ROUNDING)
        };
        match self.settings.combination {
            Combination::Precision => Bounds { shift: 0.0, std: widened(0.0) },
            Combination::Convolution if self.settings.discretization.is_capped => {
                Bounds { shift: 0.0, std: widened(1.0) }
            }
            Combination::Convolution => Bounds { shift: 0.0, std: f64::INFINITY },
            Combination::SurfacePosterior => {
                let settings = &self.settings.posterior;
                Bounds {
                    shift: settings.most_shift * sigma * (1.0 + ROUNDING),
                    // Samples on the surface are up to the diagonal of a spacing from one another.
                    std: widened(settings.disc_std.max(SQRT_2 * settings.sampling_std)),
                }
            }
        }
    }

    /// Ψᵢ, within the cap where it has one; `None` without neighbours.
    fn sampling_error(
        &self,
        index: usize,
        neighborhoods: &Neighborhoods,
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Option<Covariance> {
        let settings = &self.settings.discretization;
        let nearest = &scratch.neighbors[..scratch.neighbors.len().min(settings.neighbors)];
        let psi = sampling_error(neighborhoods, index, nearest, settings)?;
        scratch.reach = scratch.reach.max(settings.reach(nearest));
        Some(if settings.is_capped { limited(psi, spacing_cap) } else { psi })
    }
}

/// How far the last of so many neighbours is, m, or one as near that might come before it; with fewer, any point would
/// be one more.
fn reach(neighbors: &[Neighbor], count: usize) -> f64 {
    neighbors.get(count - 1).map_or(f64::INFINITY, |last| widened(last.squared_distance).sqrt())
}

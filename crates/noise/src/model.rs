//! From a measured point and its neighbourhood to an uncertain surface point.

use cloudtouch_geom::{Covariance, Matrix3, Point3, UncertainPoint, Vector3};

use crate::discretization::{limited, weighted_scatter};
use crate::parallel::parallel;
use crate::patch::Patch;
use crate::spacing::{SPACING_NEIGHBORS, spacing_around, spacing_of_rank};
use crate::surface::{MOST_NEIGHBORS, Surface, fit_surface};
use crate::{Combination, Neighbor, Neighborhoods, NoiseError, NoiseSettings};

/// Turns measured points into uncertain surface points.
///
/// Pure: what comes out of [`refine`](Self::refine) depends on its arguments alone, bit for bit,
/// whatever was refined before and on whichever thread.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NoiseModel {
    settings: NoiseSettings,
}

/// A surface point as the noise model knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Refined {
    /// Mean and covariance of the surface point, in the frame of the cloud.
    pub point: UncertainPoint,
    /// Local spacing of the samples, m: zero for a point alone, never above the cap.
    pub spacing: f64,
    /// Unit normal of the fitted surface, of either sign; `None` where none was fitted.
    pub normal: Option<Vector3>,
}

/// How far refinement can go, without looking at neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// An upper bound on the distance between measured point and refined mean, m.
    pub shift: f64,
    /// An upper bound on the refined standard deviation in any direction, m.
    pub std: f64,
}

/// Buffers reused from one refinement to the next; holds no results.
#[derive(Debug, Default)]
pub struct Scratch {
    neighbors: Vec<Neighbor>,
    patch: Buffers,
    /// The same of a wider neighbourhood.
    wide_neighbors: Vec<Neighbor>,
    wide_patch: Buffers,
}

#[derive(Debug, Default)]
struct Buffers {
    offsets: Vec<Vector3>,
    noise: Vec<Covariance>,
}

impl Buffers {
    /// The neighbours as a patch about point `index`.
    fn patch<'a>(
        &'a mut self,
        index: usize,
        neighbors: impl Iterator<Item = &'a Neighbor> + Clone,
        points: &[Point3],
        sensor: &'a [Covariance],
        spacing: f64,
    ) -> Patch<'a> {
        self.offsets.clear();
        self.offsets.extend(neighbors.clone().map(|n| points[n.index] - points[index]));
        self.noise.clear();
        self.noise.extend(neighbors.map(|n| sensor[n.index]));
        Patch::new(&self.offsets, &self.noise, &sensor[index], spacing)
    }
}

/// A point is not moved by more than this many of its standard deviations along the normal, nor
/// trusted to lie on a surface farther off.
const MOST_SHIFT: f64 = 3.0;
/// Offsets from the surface beyond this many standard deviations are added to its variance.
const TRUSTED_OFFSET: f64 = 3.5;
/// The posterior variance of a point whose neighbourhood was chosen for its small one is
/// optimistic; doubled, and with a part of the sensor's and of the spacing, it is calibrated.
const POSTERIOR_INFLATION: f64 = 2.0;
const SENSOR_PART: f64 = 0.15;
const SPACING_PART: f64 = 0.02;
/// Where the noise is more than this many spacings the nearest neighbours are all noise: the surface
/// is looked for among as many from farther away, ...
const NOISY_SPACINGS: f64 = 1.5;
/// ... every fourth or sixteenth of four or sixteen times as many.
const STRIDES: [usize; 2] = [4, 16];
/// How often a wider neighbourhood is gathered.
const PASSES: usize = 3;
/// What the variance of a wide fit is multiplied by: on planes it then is that of the errors.
const WIDE_INFLATION: f64 = 2.0;
/// A wider patch may have this many times the variance.
const WIDER: f64 = 2.0;
/// The bounds are a hair wider than the clamps, which round.
const ROUNDING: f64 = 1e-9;

impl NoiseModel {
    /// A model with checked settings.
    ///
    /// # Errors
    /// When [`NoiseSettings::validate`] objects.
    pub fn try_new(settings: NoiseSettings) -> Result<Self, NoiseError> {
        settings.validate()?;
        Ok(Self { settings })
    }

    /// The settings.
    pub fn settings(&self) -> &NoiseSettings {
        &self.settings
    }

    /// Mean and covariance of the surface point behind point `index`.
    ///
    /// `sensor` holds the position noise of all points. Neither the local spacing nor any
    /// discretization standard deviation counts as larger than `spacing_cap` (m, not negative,
    /// infinity for no cap), so that [`bounds`](Self::bounds) holds.
    ///
    /// With [`Combination::SurfacePosterior`] the covariance is v n nᵀ + (0.35 h)² (I − n nᵀ), n
    /// the normal, h the spacing. A point whose neighbourhood determines no plane (alone, on a
    /// line, fewer than five distinct positions) keeps its place and gets Σᵢ + (0.35 h)² I. With
    /// the other combinations a point without neighbours keeps Σᵢ, to which `Convolution` adds the
    /// cap unless it is infinite. A point that is not finite has no neighbours.
    ///
    /// # Panics
    /// When `index` or the length of `sensor` does not belong to the cloud.
    pub fn refine(
        &self,
        index: usize,
        neighborhoods: &Neighborhoods,
        sensor: &[Covariance],
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Refined {
        let points = neighborhoods.points();
        assert_eq!(sensor.len(), points.len(), "one sensor covariance for each point");
        let count = match self.settings.combination {
            Combination::SurfacePosterior => MOST_NEIGHBORS,
            _ => self.settings.discretization.neighbors.max(SPACING_NEIGHBORS),
        };
        neighborhoods.nearest_into(index, count, &mut scratch.neighbors);
        let spacing = spacing_around(&scratch.neighbors).unwrap_or(0.0).min(spacing_cap);
        let unfitted = |covariance| Refined {
            point: UncertainPoint { mean: points[index], covariance },
            spacing,
            normal: None,
        };
        match self.settings.combination {
            Combination::Precision => {
                let psi = self.sampling_error(index, neighborhoods, spacing_cap, scratch);
                unfitted(psi.map_or(sensor[index], |psi| parallel(&sensor[index], &psi)))
            }
            Combination::Convolution => {
                let alone = if spacing_cap.is_finite() { spacing_cap } else { 0.0 };
                let psi = self
                    .sampling_error(index, neighborhoods, spacing_cap, scratch)
                    .unwrap_or(Covariance::isotropic(alone * alone));
                unfitted(sensor[index].sum(&psi))
            }
            Combination::SurfacePosterior => {
                let disc = (self.settings.disc_std * spacing).powi(2);
                self.posterior(index, neighborhoods, sensor, spacing_cap, scratch)
                    .unwrap_or_else(|| unfitted(sensor[index].sum(&Covariance::isotropic(disc))))
            }
        }
    }

    /// Mean and covariance of a surface point whose unit normal is known, not fitted: the point stays
    /// where it was measured, with v n nᵀ + (0.35 h)² (I − n nᵀ), v the variance of `sensor` along
    /// the normal and a part of the spacing. Within [`bounds`](Self::bounds).
    ///
    /// # Panics
    /// When `index` does not belong to the cloud.
    pub fn with_normal(
        &self,
        index: usize,
        normal: Vector3,
        neighborhoods: &Neighborhoods,
        sensor: &Covariance,
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Refined {
        neighborhoods.nearest_into(index, SPACING_NEIGHBORS, &mut scratch.neighbors);
        let spacing = spacing_around(&scratch.neighbors).unwrap_or(0.0).min(spacing_cap);
        let variance = sensor.variance_along(&normal) + (SPACING_PART * spacing).powi(2);
        Refined {
            point: UncertainPoint {
                mean: neighborhoods.points()[index],
                covariance: self.disc(&normal, variance, spacing),
            },
            spacing,
            normal: Some(normal),
        }
    }

    /// v n nᵀ + (0.35 h)² (I − n nᵀ).
    fn disc(&self, normal: &Vector3, variance: f64, spacing: f64) -> Covariance {
        let disc = (self.settings.disc_std * spacing).powi(2);
        let along = normal * normal.transpose();
        let covariance = along * variance + (Matrix3::identity() - along) * disc;
        Covariance::from_symmetric(&covariance)
    }

    /// Upper bounds on what [`refine`](Self::refine) does to a point with this position noise,
    /// whatever its neighbours.
    pub fn bounds(&self, sensor: &Covariance, spacing_cap: f64) -> Bounds {
        let sigma = sensor.max_std();
        let widened = |part: f64| sigma.hypot(part * spacing_cap) * (1.0 + ROUNDING);
        match self.settings.combination {
            Combination::Precision => Bounds { shift: 0.0, std: widened(0.0) },
            Combination::Convolution => Bounds { shift: 0.0, std: widened(1.0) },
            Combination::SurfacePosterior => Bounds {
                shift: MOST_SHIFT * sigma * (1.0 + ROUNDING),
                std: widened(self.settings.disc_std.max(SPACING_PART)),
            },
        }
    }

    /// Ψᵢ within the cap; `None` without neighbours.
    fn sampling_error(
        &self,
        index: usize,
        neighborhoods: &Neighborhoods,
        spacing_cap: f64,
        scratch: &Scratch,
    ) -> Option<Covariance> {
        let settings = &self.settings.discretization;
        let nearest = &scratch.neighbors[..scratch.neighbors.len().min(settings.neighbors)];
        weighted_scatter(neighborhoods.points(), index, nearest, settings.width)
            .map(|psi| limited(psi, spacing_cap))
    }

    /// The point given its measurement and the surface of its neighbours; `None` where there is
    /// no surface to be fitted.
    fn posterior(
        &self,
        index: usize,
        neighborhoods: &Neighborhoods,
        sensor: &[Covariance],
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Option<Refined> {
        let points = neighborhoods.points();
        let point = points[index];
        let around = spacing_around(&scratch.neighbors)?;
        let is_noisy = sensor[index].max_std() > NOISY_SPACINGS * around;
        let wide =
            is_noisy.then(|| wide_surface(index, neighborhoods, sensor, around, scratch)).flatten();
        let Scratch { neighbors, patch, .. } = scratch;
        let patch = patch.patch(index, neighbors.iter(), points, sensor, around);
        let surface = wide.or_else(|| fit_surface(&patch))?;
        let normal = surface.normal;
        let spacing = tangential_spacing(&patch, &surface)?.min(spacing_cap);

        let sensor_variance = sensor[index].variance_along(&normal);
        let mut prior_variance = surface.variance;
        if surface.height.powi(2) > TRUSTED_OFFSET.powi(2) * patch.own_variance(&normal) {
            prior_variance += surface.height.powi(2);
        }
        // Positive: the surface variance is at least a part of the floor, which is.
        let weight = sensor_variance / (sensor_variance + prior_variance);
        let most = MOST_SHIFT * sensor_variance.sqrt();
        let shift = (weight * surface.height).clamp(-most, most);
        let sampling = (SPACING_PART * spacing).powi(2);
        let variance = (POSTERIOR_INFLATION * weight * prior_variance
            + SENSOR_PART.powi(2) * sensor_variance
            + sampling)
            .min(sensor_variance + sampling);
        Some(Refined {
            point: UncertainPoint {
                mean: point + normal * shift,
                covariance: self.disc(&normal, variance, spacing),
            },
            spacing,
            normal: Some(normal),
        })
    }
}

/// The surface by neighbours from farther away, where the nearest are all noise: the widest fit that
/// is not plainly worse than a narrower one. `None` where none of them determines a plane.
fn wide_surface(
    index: usize,
    neighborhoods: &Neighborhoods,
    sensor: &[Covariance],
    spacing: f64,
    scratch: &mut Scratch,
) -> Option<Surface> {
    let mut found: Option<Surface> = None;
    for stride in STRIDES {
        let wide = strided_surface(stride, index, neighborhoods, sensor, spacing, scratch);
        let Some(wide) = wide else { continue };
        if found.is_none_or(|narrower| wide.variance < WIDER * narrower.variance) {
            found = Some(wide);
        }
    }
    // The passes leave some agreement with the point, which no residual shows.
    found.map(|mut surface| {
        surface.variance *= WIDE_INFLATION;
        surface
    })
}

/// The surface by every `stride`-th of as many times more neighbours. What is nearest to a displaced
/// point agrees with it more than it should, so they are gathered again about where the surface
/// seems to be.
fn strided_surface(
    stride: usize,
    index: usize,
    neighborhoods: &Neighborhoods,
    sensor: &[Covariance],
    spacing: f64,
    scratch: &mut Scratch,
) -> Option<Surface> {
    let points = neighborhoods.points();
    let Scratch { wide_neighbors, wide_patch, .. } = scratch;
    let mut place = points[index];
    let mut found = None;
    for _ in 0..PASSES {
        neighborhoods.nearest_to_into(&place, stride * MOST_NEIGHBORS, wide_neighbors);
        let every = wide_neighbors.iter().skip(stride - 1).step_by(stride);
        let surface = fit_surface(&wide_patch.patch(index, every, points, sensor, spacing))?;
        place = points[index] + surface.normal * surface.height;
        found = Some(surface);
    }
    found
}

/// The spacing of the samples on the surface, noise across it left out: the sixth least distance
/// across the normal among the neighbours near the surface; `None` when there is none.
fn tangential_spacing(patch: &Patch, surface: &Surface) -> Option<f64> {
    let mut nearest = [f64::INFINITY; SPACING_NEIGHBORS];
    let mut count = 0;
    for (offset, variance) in patch.with_variances(&surface.normal) {
        let (residual, reach) = surface.residual_and_reach(offset);
        let allowed = TRUSTED_OFFSET.powi(2) * (variance + surface.variance);
        if residual * residual <= allowed {
            count += 1;
            let last = SPACING_NEIGHBORS - 1;
            if reach < nearest[last] {
                let place = nearest.partition_point(|&r| r <= reach);
                nearest[place..].rotate_right(1);
                nearest[place] = reach;
            }
        }
    }
    let rank = count.min(SPACING_NEIGHBORS);
    let reach = *nearest.get(rank.checked_sub(1)?)?;
    Some(spacing_of_rank(reach, rank))
}

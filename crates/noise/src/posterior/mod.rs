//! The point given its measurement and a surface fitted to its neighbours.

pub(crate) mod settings;
mod wide;

use cloudtouch_geom::{Covariance, UncertainPoint, UnitVector3};

use crate::index::spacing::{SPACING_NEIGHBORS, is_noisy, spacing_around, spacing_of_rank};
use crate::lanes::{Kernel, Lanes, Machine, WIDTH, run};
use crate::neighborhoods::Neighborhoods;
use crate::posterior::settings::PosteriorSettings;
use crate::posterior::wide::wide_surface;
use crate::refined::Refined;
use crate::representatives::Representatives;
use crate::scratch::Scratch;
use crate::sensor::noise::SensorNoise;
use crate::surface::patch::{MOST_NEIGHBORS, Patch};
use crate::surface::{Surface, fit_surface};

/// A neighbour so many standard deviations off the surface is not a sample of it.
const SAMPLE_OFFSET: f64 = 3.5;

/// Noise of so many spacings is no longer small beside them ([`SurfaceError::sharp`]).
///
/// [`SurfaceError::sharp`]: crate::SurfaceError::sharp
const SHARP: f64 = 0.25;

/// The point given its measurement and the surface of its neighbours, which are in `scratch`; `None`
/// where there is no surface to be fitted.
///
/// With s² the variance of the noise along the normal, V that of the surface, h its height above the
/// point and d the doubt, the point moves by w h, w = s²/(s² + d V), and has the variance
/// w² V + u (o + (1 − o) u³) s² along the normal, u = (1 − w)², o the part of its own noise, less of
/// it where the noise is small beside the spacing, never more than s². Across it the disc of the spacing is
/// widened by the noise where fits to other neighbourhoods face elsewhere: what is along the normal
/// of the one is across that of the other.
pub(crate) fn posterior(
    index: usize,
    neighborhoods: &Neighborhoods,
    representatives: Option<&Representatives>,
    sensor: &SensorNoise,
    spacing_cap: f64,
    settings: &PosteriorSettings,
    scratch: &mut Scratch,
) -> Option<Refined> {
    let points = neighborhoods.points();
    let around = spacing_around(&scratch.neighbors)?;
    let is_wide = is_noisy(&sensor[index], around);
    if is_wide || representatives.is_some() {
        // Which points stand for the others hangs on all of them.
        scratch.reach = f64::INFINITY;
    }
    let wide =
        is_wide.then(|| wide_surface(index, neighborhoods, sensor, around, scratch)).flatten();
    if wide.is_none() && representatives.is_some() {
        neighborhoods.look_around(index, MOST_NEIGHBORS, scratch);
    }
    let Scratch { neighbors, patch, kept_block, near_representatives, wide_patch, .. } = scratch;
    let nearest = neighbors.iter().map(|near| near.index);
    let patch = patch.patch(index, nearest, points, sensor, around);
    let surface = wide.or_else(|| fit_surface(&patch))?;
    let spacing = match representatives {
        None => tangential_spacing(&patch, &surface)?,
        Some(kept) => {
            let (positions, in_cloud) = kept.positions();
            let found = near_representatives;
            kept_block.nearest_into(positions, &points[index], MOST_NEIGHBORS, true, found);
            let nearest = found.iter().map(|near| in_cloud(near.index));
            let others = wide_patch.patch(index, nearest, points, sensor, around);
            // One alone stands for no more than its noise.
            let alone = sensor[index].max_std();
            tangential_spacing(&others, &surface).unwrap_or(alone)
        }
    }
    .min(spacing_cap);

    let error = &settings.surface_error;
    let noise = sensor[index].variance_along(&surface.normal);
    let mut prior = error.leverage * surface.leverage
        + error.hidden * surface.hidden
        + error.bend * surface.bend
        + error.misfit * surface.misfit
        + error.suspected * surface.suspected
        + error.disagreement * surface.disagreement
        + error.tilt * surface.tilt * noise;
    if surface.height.powi(2)
        > settings.trusted_offset.powi(2) * patch.own_variance(&surface.normal)
    {
        prior += surface.height.powi(2);
    }
    let weight = share(noise, error.doubt * prior);
    let most = settings.most_shift * noise.sqrt();
    let shift = (weight * surface.height).clamp(-most, most);
    let stays = (1.0 - weight).powi(2);
    let own = stays * (error.own_noise + (1.0 - error.own_noise) * stays.powi(3)) * noise;
    let blur = (noise.sqrt() / (SHARP * around)).min(1.0);
    let stated = error.sharp + (1.0 - error.sharp) * blur;
    let along = (stated * (weight * weight * prior + own)).min(noise);
    let turned = (error.turn * surface.tilt).min(1.0) * sensor[index].max_std();
    let across = (settings.disc_std * spacing).hypot(turned);
    let point = UncertainPoint {
        mean: points[index] + surface.normal.into_inner() * shift,
        covariance: disc(&surface.normal, along, across, spacing, settings),
    };
    Some(Refined { point, spacing, normal: Some(surface.normal) })
}

/// `variance` (m²) and what bends between samples along the normal, the standard deviation `across`
/// (m) across it.
pub(crate) fn disc(
    normal: &UnitVector3,
    variance: f64,
    across: f64,
    spacing: f64,
    settings: &PosteriorSettings,
) -> Covariance {
    let along = variance.sqrt().hypot(settings.sampling_std * spacing);
    Covariance::from_axis(normal, along, across)
}

/// a/(a + b), and nothing of nothing.
fn share(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a / (a + b) }
}

/// The spacing of the samples on the surface, noise across it left out: the sixth least distance
/// across the normal among the neighbours near the surface; `None` when there is none.
fn tangential_spacing(patch: &Patch, surface: &Surface) -> Option<f64> {
    run(Spacing { patch, surface })
}

struct Spacing<'a> {
    patch: &'a Patch<'a>,
    surface: &'a Surface,
}

impl Kernel for Spacing<'_> {
    type Output = Option<f64>;

    #[inline(always)]
    fn run<S: Machine>(self, machine: S) -> Option<f64> {
        tangential(machine, self.patch, self.surface)
    }
}

#[inline(always)]
fn tangential<S: Machine>(machine: S, patch: &Patch, surface: &Surface) -> Option<f64> {
    let mut nearest = [f64::INFINITY; SPACING_NEIGHBORS];
    let mut count = 0;
    let precisions = patch.precisions(&surface.normal);
    let allowance = SAMPLE_OFFSET * SAMPLE_OFFSET * surface.expected_error;
    for group in 0..patch.groups() {
        let offsets = patch.group(machine, group);
        let present = patch.present(machine, group);
        let [residual, reach] = surface.squared_residual_and_reach(machine, offsets);
        let precision = precisions.group(machine, group);
        let excess = (residual - Lanes::splat(machine, allowance)) * precision;
        let [present, excess, reach] = [present.stored(), excess.stored(), reach.stored()];
        for lane in 0..WIDTH {
            if present[lane] > 0.0 && excess[lane] <= SAMPLE_OFFSET * SAMPLE_OFFSET {
                count += 1;
                insert(&mut nearest, reach[lane]);
            }
        }
    }
    let rank = count.min(SPACING_NEIGHBORS);
    let squared = *nearest.get(rank.checked_sub(1)?)?;
    Some(spacing_of_rank(squared.sqrt(), rank))
}

/// Keeps the least values in order.
#[inline(always)]
fn insert(least: &mut [f64; SPACING_NEIGHBORS], value: f64) {
    if value < least[SPACING_NEIGHBORS - 1] {
        let place = least.partition_point(|&kept| kept <= value);
        least[place..].rotate_right(1);
        least[place] = value;
    }
}

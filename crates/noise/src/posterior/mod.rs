//! The point given its measurement and a surface fitted to its neighbours.

mod chance;
mod displaced;
pub(crate) mod settings;
mod spacing;
mod wide;

use std::f64::consts::SQRT_2;

use cloudtouch_geom::{Covariance, Point3, UncertainPoint, UnitVector3, Vector3};

use crate::index::spacing::is_noisy;
use crate::neighborhoods::Neighborhoods;
use crate::posterior::chance::is_chance;
use crate::posterior::displaced::displaced;
use crate::posterior::settings::{PosteriorSettings, SurfaceError};
use crate::posterior::spacing::{beside_end, tangential_spacing};
use crate::posterior::wide::{possible_variance_about, wide_surface};
use crate::refined::Refined;
use crate::representatives::Representatives;
use crate::scratch::Scratch;
use crate::sensor::noise::SensorNoise;
use crate::surface::patch::{MOST_NEIGHBORS, Patch};
use crate::surface::scatter::possible_variance;
use crate::surface::{Surface, fit_surface};

/// Noise of so many spacings is no longer small beside them ([`SurfaceError::sharp`]).
///
/// [`SurfaceError::sharp`]: crate::SurfaceError::sharp
const SHARP: f64 = 0.25;

/// The point given its measurement and the surface of its neighbours, which are in `scratch` where every point stands
/// for itself; `None` where there is no surface to be fitted. `around` is how far apart samples are about it, m, and
/// `spacing_cap` the most that its own spacing may be, m.
pub(crate) fn posterior(
    index: usize,
    (neighborhoods, representatives, sensor): (
        &Neighborhoods,
        Option<&Representatives>,
        &SensorNoise,
    ),
    [around, spacing_cap]: [f64; 2],
    settings: &PosteriorSettings,
    scratch: &mut Scratch,
) -> Option<Refined> {
    let points = neighborhoods.points();
    let own = &sensor[index];
    let is_all_noise = is_noisy(own, around);
    if is_all_noise {
        // What the cloud is thinned to hangs on all of it.
        scratch.reach = f64::INFINITY;
    }
    let wide =
        is_all_noise.then(|| wide_surface(index, neighborhoods, sensor, around, scratch)).flatten();
    // Whether so far off by chance, who is beside it tells.
    let is_far_off = |wide: Surface| !is_near(&wide, own.variance_along(&wide.normal), settings);
    if representatives.is_some() && wide.is_none_or(is_far_off) {
        neighborhoods.look_around(index, MOST_NEIGHBORS, scratch);
    }
    let Scratch {
        neighbors,
        patch,
        kept_block,
        near_representatives,
        wide_neighbors,
        wide_patch,
        ..
    } = scratch;
    let nearest = neighbors.iter().map(|near| near.index);
    let patch = patch.patch(index, nearest, points, sensor, around);
    let is_wide = wide.is_some();
    let surface = wide.or_else(|| fit_surface(&patch))?;
    let std = own.max_std();
    let spacing = match representatives {
        None => tangential_spacing(&patch, &surface)?,
        Some(kept) => {
            let (positions, in_cloud) = kept.positions();
            let found = near_representatives;
            kept_block.nearest_into(positions, &points[index], MOST_NEIGHBORS, true, found);
            let nearest = found.iter().map(|near| in_cloud(near.index));
            let others = wide_patch.patch(index, nearest, points, sensor, around);
            // One alone stands for no more than its noise.
            tangential_spacing(&others, &surface).unwrap_or(std)
        }
    };
    let sharp = 1.0 - blur(std, around);
    // No limit to the other acts on it unless it acts there.
    let apart = spacing.min(SQRT_2 * spacing_cap);
    let spacing = beside_end(spacing, &surface, sharp).min(spacing_cap);
    let back = displaced(&surface, own, || {
        if is_wide {
            return possible_variance_about(neighborhoods, wide_neighbors);
        }
        possible_variance((0..patch.len()).map(|rank| patch.offset(rank)), &surface.normal)
    });
    let (point, shared) = given_surface(
        (&points[index], own, std),
        (&surface, &patch, back),
        [around, apart, spacing],
        settings,
    );
    Some(Refined { point, spacing, normal: Some(surface.normal), shared })
}

/// Whether a point whose noise has this variance along the normal, m², is so near its surface that it is of it.
fn is_near(surface: &Surface, own_variance: f64, settings: &PosteriorSettings) -> bool {
    surface.height.powi(2) <= settings.trusted_offset.powi(2) * own_variance
}

/// The point given its measurement, with its covariance and the largest standard deviation of that, and the surface
/// fitted to a patch about it; `around` is the spacing of what is measured about it, `apart` how far from one another samples on the
/// surface are, `spacing` that of as many all around.
///
/// With s² the variance of the noise along the normal, V that of the surface, h its height above the
/// point and d the doubt, the point moves by w h, w = s²/(s² + d V), and has the variance
/// w² V + u (o + (1 − o) u³) s² along the normal, u = (1 − w)², o the part of its own noise, less of
/// it where the noise is small beside the spacing, never more than s². Across it the disc of the spacing is
/// widened by the noise where fits to other neighbourhoods face elsewhere: what is along the normal
/// of the one is across that of the other.
///
/// Noise also takes samples past the end of a surface, where it goes on as far as its neighbours can tell, but
/// that these are on one side. Along the surface the point moves `back` by what it was displaced there, in the mean.
fn given_surface(
    (measured, own, std): (&Point3, &Covariance, f64),
    (surface, patch, back): (&Surface, &Patch, Vector3),
    [around, apart, spacing]: [f64; 3],
    settings: &PosteriorSettings,
) -> (UncertainPoint, f64) {
    let error = &settings.surface_error;
    let noise = own.variance_along(&surface.normal);
    let mut prior = variance_of(surface, error, noise);
    let own_variance = patch.own_variance(&surface.normal);
    let blur = blur(noise.sqrt(), around);
    let is_trusted = is_near(surface, own_variance, settings)
        || is_chance(surface, patch, own_variance + prior.min(noise));
    if !is_trusted {
        prior += surface.height.powi(2);
    }
    let weight = share(noise, error.doubt * prior);
    let most = settings.most_shift * noise.sqrt();
    let shift = (weight * surface.height).clamp(-most, most);
    let stays = (1.0 - weight).powi(2);
    let stays_noisy = stays * (error.own_noise + (1.0 - error.own_noise) * stays.powi(3)) * noise;
    let stated = if is_trusted { error.sharp + (1.0 - error.sharp) * blur } else { 1.0 };
    let along = (stated * (weight * weight * prior + stays_noisy) + surface.shared).min(noise);
    let turned = (error.turn * surface.tilt).min(1.0) * std;
    let across = (settings.disc_std * spacing).hypot(turned);
    let normal = surface.normal.into_inner();
    let room = (settings.most_shift * std).powi(2) - shift * shift;
    let back = limited(back, room);
    let point = UncertainPoint {
        mean: measured + normal * shift + back,
        covariance: disc(&surface.normal, along, across, apart, settings),
    };
    (point, if along > 0.0 { (surface.shared / along).min(1.0) } else { 0.0 })
}

/// How far noise of this standard deviation (m) is from small beside a spacing (m), up to 1.
fn blur(std: f64, spacing: f64) -> f64 {
    (std / (SHARP * spacing)).min(1.0)
}

/// A vector, or as much of it as its square is no more than `most`.
fn limited(vector: Vector3, most: f64) -> Vector3 {
    let squared = vector.norm_squared();
    if squared <= most { vector } else { vector * (most.max(0.0) / squared).sqrt() }
}

/// V: how far a surface may be off, given the variance of the noise along its normal.
fn variance_of(surface: &Surface, error: &SurfaceError, noise: f64) -> f64 {
    error.leverage * surface.leverage
        + error.hidden * surface.hidden
        + error.bend * surface.bend
        + error.misfit * surface.misfit
        + error.suspected * surface.suspected
        + error.disagreement * surface.disagreement
        + error.tilt * surface.tilt * noise
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

//! What the surface posterior believes.

use crate::settings_error::{SettingsError, check_not_negative};

/// Parameters of [`Combination::SurfacePosterior`](crate::Combination::SurfacePosterior).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosteriorSettings {
    /// Standard deviation of the disc across the normal, in local spacings. 0.35 by default, a
    /// little more than the 1/√12 of a uniform square of side one.
    pub disc_std: f64,
    /// Standard deviation of what bends between samples, in local spacings.
    pub sampling_std: f64,
    /// A point is not moved by more than so many of its standard deviations along the normal.
    pub most_shift: f64,
    /// A surface more than so many standard deviations off is not trusted to be that of the point:
    /// the square of the distance is added to its variance.
    pub trusted_offset: f64,
    /// How far the fitted surface may be off.
    pub surface_error: SurfaceError,
}

/// The variance of the height of a fitted surface, from what the fit shows: a sum with these factors.
///
/// The defaults were fitted to errors on planes, boxes, boards and spheres of other sizes, noises and
/// spacings than those of the table that judges them (`docs/lab/sigma.md`). Factors above one make up
/// for the choice of the neighbourhood that looks best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceError {
    /// Of the variance that the noise of the neighbours leaves to the height.
    pub leverage: f64,
    /// Of the standard deviation by chance of the variance of the residuals, s²√(2/degrees of
    /// freedom): a misfit no larger does not show.
    pub hidden: f64,
    /// Of the squared height by which a curved surface through the same neighbours differs.
    pub bend: f64,
    /// Of the variance of the residuals beyond the noise.
    pub misfit: f64,
    /// Of what residuals of a larger neighbourhood show beyond noise and chance, as far as those of the
    /// chosen one may hide it: the other side of a thing thinner than the noise.
    pub suspected: f64,
    /// Of what fits to other neighbourhoods differ in height.
    pub disagreement: f64,
    /// Of the variance of the noise, times the squared sine between the normals of these fits.
    pub tilt: f64,
    /// How much more than its own variance the surface is doubted when the point is moved towards it.
    pub doubt: f64,
    /// Of the noise, in a point that is moved only a part of the way; one that stays keeps all.
    pub own_noise: f64,
    /// How soon normals that differ let the noise be in every direction: of their squared sine.
    pub turn: f64,
    /// Of the variance along the normal that the other factors come to, where the noise is nothing
    /// beside the spacing; it rises to all of it where the noise is a quarter of the spacing. Misfits
    /// no larger than the noise, which the others allow for, are rare where the noise is small. Not of a point
    /// farther than [`trusted_offset`](PosteriorSettings::trusted_offset) from the surface.
    pub sharp: f64,
}

impl Default for PosteriorSettings {
    fn default() -> Self {
        Self {
            disc_std: 0.35,
            sampling_std: 0.006,
            most_shift: 3.0,
            trusted_offset: 3.5,
            surface_error: SurfaceError::default(),
        }
    }
}

impl Default for SurfaceError {
    fn default() -> Self {
        Self {
            leverage: 0.31,
            hidden: 0.7,
            bend: 0.84,
            misfit: 1.77,
            suspected: 7.9,
            disagreement: 0.014,
            tilt: 0.6,
            doubt: 2.21,
            own_noise: 0.9,
            turn: 90.0,
            sharp: 0.5,
        }
    }
}

impl PosteriorSettings {
    /// Checks the settings.
    ///
    /// # Errors
    /// When one is negative or not finite.
    pub fn validate(&self) -> Result<(), SettingsError> {
        let SurfaceError {
            leverage,
            hidden,
            bend,
            misfit,
            suspected,
            disagreement,
            tilt,
            doubt,
            own_noise,
            turn,
            sharp,
        } = self.surface_error;
        for (name, value) in [
            ("posterior.disc_std", self.disc_std),
            ("posterior.sampling_std", self.sampling_std),
            ("posterior.most_shift", self.most_shift),
            ("posterior.trusted_offset", self.trusted_offset),
            ("posterior.surface_error.leverage", leverage),
            ("posterior.surface_error.hidden", hidden),
            ("posterior.surface_error.bend", bend),
            ("posterior.surface_error.misfit", misfit),
            ("posterior.surface_error.suspected", suspected),
            ("posterior.surface_error.disagreement", disagreement),
            ("posterior.surface_error.tilt", tilt),
            ("posterior.surface_error.doubt", doubt),
            ("posterior.surface_error.own_noise", own_noise),
            ("posterior.surface_error.turn", turn),
            ("posterior.surface_error.sharp", sharp),
        ] {
            check_not_negative(name, value)?;
        }
        Ok(())
    }
}

//! The surface near a point: a robust local fit over a neighbourhood that grows while it explains
//! the residuals.

mod candidates;
pub(crate) mod patch;
mod regression;
mod reweight;
pub(crate) mod scatter;
mod score;
mod sieve;
mod smallest_axis;
mod vote;

use cloudtouch_geom::{UnitVector3, Vector3};

use crate::lanes::{Kernel, Lanes, Machine, run};
use crate::surface::candidates::best_candidate;
use crate::surface::patch::{Patch, Plane};
use crate::surface::regression::{Coefficients, Frame, regress, squared_residual_and_reach};
use crate::surface::reweight::reweighted;
use crate::surface::score::score;

/// The neighbourhood sizes that are tried.
const SIZES: [usize; 4] = [8, 16, 30, 60];
/// A plane through fewer neighbours than this explains anything.
const LEAST_NEIGHBORS: usize = 4;
/// How often the first plane is fitted anew by the weights of the last.
const FIRST_PASSES: usize = 2;
/// How often those after it are, which begin with that of fewer neighbours.
const LATER_PASSES: usize = 1;

/// The surface near a point, in coordinates relative to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surface {
    /// Normal of the surface nearest the point, of either sign.
    pub(crate) normal: UnitVector3,
    /// Height of the surface above the point along the normal, m.
    pub(crate) height: f64,
    /// What noise and misfit were expected to leave of error when the neighbourhood was chosen, m².
    pub(crate) expected_error: f64,
    /// The same as a part of the variance that the point has along the normal: by that, fits that face elsewhere are
    /// compared. Across rays little is to be known, and little says nothing.
    pub(crate) relative_error: f64,
    /// The variance that the noise of the neighbours gives that height, m².
    pub(crate) leverage: f64,
    /// The variance of a misfit that residuals may hide, m².
    pub(crate) hidden: f64,
    /// The squared difference in height of a curved surface through the same neighbours, m².
    pub(crate) bend: f64,
    /// What the noise does not explain of the variance of the residuals, m².
    pub(crate) misfit: f64,
    /// What the residuals do not show of the noise, beyond chance: an error that the neighbours share, m².
    pub(crate) shared: f64,
    /// What the residuals of a larger neighbourhood vary by beyond noise and chance, as far as this one
    /// may hide it, m².
    pub(crate) suspected: f64,
    /// How far the heights of fits to other neighbourhoods differ beyond their errors, squared, m².
    pub(crate) disagreement: f64,
    /// The mean squared sine between the normals of these fits and this one.
    pub(crate) tilt: f64,
    /// The score of the samples at the point along the surface: which way, and how soon, they get denser, 1/m.
    pub(crate) score: Vector3,
    /// The frame of the fit, in which `coefficients` holds.
    frame: Frame,
    /// Height above the point's tangential position: c₀ + c₁a + c₂b + c₃(a²+b²).
    coefficients: Coefficients,
}

impl Surface {
    /// The squared distances of places from the surface along the normal of the fit, and from the
    /// point across it, m²; the places are relative to the point.
    #[inline(always)]
    pub(crate) fn squared_residual_and_reach<S: Machine>(
        &self,
        machine: S,
        offsets: [Lanes<S>; 3],
    ) -> [Lanes<S>; 2] {
        squared_residual_and_reach(machine, offsets, (&self.frame, &self.coefficients))
    }
}

/// Fits the surface near a point.
///
/// From the best supported plane of a few, each neighbourhood size is refined by Tukey weights;
/// the size and the model (plane, or plane with mean curvature) with the least expected squared
/// error s²·leverage + 2τ² are kept, τ² being what noise does not explain of the residuals. What the
/// other sizes say about height and normal comes with it. `None` when no size determines a plane: too
/// few neighbours, or all about one line.
pub(crate) fn fit_surface(patch: &Patch) -> Option<Surface> {
    run(Fit(patch))
}

struct Fit<'a>(&'a Patch<'a>);

impl Kernel for Fit<'_> {
    type Output = Option<Surface>;

    #[inline(always)]
    fn run<S: Machine>(self, machine: S) -> Option<Surface> {
        fitted(machine, self.0)
    }
}

#[inline(always)]
fn fitted<S: Machine>(machine: S, patch: &Patch) -> Option<Surface> {
    let available = patch.len();
    let mut plane = best_candidate(machine, patch)?;
    let mut best: Option<Surface> = None;
    let mut tried = [None; SIZES.len()];
    for (trial, size) in tried.iter_mut().zip(SIZES) {
        let size = size.min(available);
        if size < LEAST_NEIGHBORS {
            break;
        }
        let nearest = patch.nearest(size);
        let passes = if best.is_none() { FIRST_PASSES } else { LATER_PASSES };
        if let Some(refined) = refined(machine, &nearest, plane, passes)
            && let Some(surface) = measured(machine, &nearest, &refined)
        {
            plane = refined;
            *trial = Some(surface);
            if best.is_none_or(|b| is_better(surface.relative_error, b.relative_error)) {
                best = Some(surface);
            }
        }
        if size == available {
            break;
        }
    }
    let best = best?;
    let (disagreement, tilt) = disagreement(&best, &tried);
    let score = score(machine, patch, best.normal.into_inner(), (&best.frame, &best.coefficients));
    let suspected = suspected(&best, &tried);
    Some(Surface { disagreement, tilt, suspected, score, ..best })
}

/// The plane after so many passes.
#[inline(always)]
fn refined<S: Machine>(
    machine: S,
    patch: &Patch,
    mut plane: Plane,
    passes: usize,
) -> Option<Plane> {
    for _ in 0..passes {
        plane = reweighted(machine, patch, &plane)?;
    }
    Some(plane)
}

/// Less by more than rounding: errors that stand at the variance of the point itself differ by nothing
/// else, and a choice among them would change when the cloud is moved.
#[inline(always)]
fn is_better(error: f64, than: f64) -> bool {
    error < than * (1.0 - 1e-9)
}

/// What the sizes disagree about the height beyond their own errors, m², and about the normal, as the
/// squared sine; both on average.
///
/// Next to a crease each size rounds it off differently and none of the fits notices.
#[inline(always)]
fn disagreement(best: &Surface, tried: &[Option<Surface>]) -> (f64, f64) {
    let normal = best.normal.into_inner();
    let mut count = 0.0;
    let (mut apart, mut tilt) = (0.0, 0.0);
    for other in tried.iter().flatten() {
        let between = other.normal.dot(&normal) * other.height - best.height;
        apart += (between * between - other.expected_error).max(0.0);
        tilt += other.normal.cross(&normal).norm_squared();
        count += 1.0;
    }
    (apart / count, tilt / count)
}

/// What the most telling size no smaller than the chosen one leaves of the variance of its residuals
/// beyond noise and chance, no more than the chosen one may hide, m².
///
/// The second side of a thin board shows in many residuals at once; the size that is chosen is the
/// one where by chance it does not.
#[inline(always)]
fn suspected(best: &Surface, tried: &[Option<Surface>]) -> f64 {
    let mut most = 0.0_f64;
    for other in tried.iter().flatten() {
        // More neighbours, less by chance.
        if other.hidden <= best.hidden {
            most = most.max(other.misfit - other.hidden);
        }
    }
    most.min(best.hidden)
}

/// Height and expected squared error of the surface at the point.
#[inline(always)]
fn measured<S: Machine>(machine: S, patch: &Patch, plane: &Plane) -> Option<Surface> {
    let frame = Frame::new(plane.normal);
    let first = regress(machine, patch, &frame, &[plane.height, 0.0, 0.0, 0.0])?;
    let mut best = (first.flat, first.flat_error);
    // Weights about the plane drop what curves away from it, so the curved surface gets its own.
    if first.may_curve()
        && let Some(second) = regress(machine, patch, &frame, &first.curved)
        && let Some(error) = second.curved_error
        && is_better(error.expected(), best.1.expected())
    {
        best = (second.curved, error);
    }
    let (coefficients, error) = best;
    let [height, on_a, on_b, _] = coefficients;
    let across = frame.normal - frame.tangents[0] * on_a - frame.tangents[1] * on_b;
    let normal = UnitVector3::new_normalize(across);
    let reach = patch.offset(patch.len() - 1).norm_squared();
    Some(Surface {
        normal,
        height: height * normal.dot(&frame.normal),
        expected_error: error.expected(),
        relative_error: error.expected() / patch.own_variance(&normal),
        leverage: error.leverage,
        hidden: error.chance,
        bend: error.bend,
        misfit: error.beyond.max(0.0),
        shared: error.shared(patch.own_variance(&normal), reach) * patch.shows_noise(&normal),
        suspected: 0.0,
        disagreement: 0.0,
        tilt: 0.0,
        score: Vector3::zeros(),
        frame,
        coefficients,
    })
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Vector3, seed};
    use pulp::Scalar256b;

    use super::*;
    use crate::surface::patch::{Offsets, PatchNoise};

    /// Two faces that meet, with noise: candidates, weights, both models and all sizes are needed.
    #[test]
    fn a_fit_is_the_same_to_the_bit_on_any_machine() {
        for draw in 0..200 {
            let unit = |k| 2.0 * seed::unit(seed::derive(5, draw, k)) - 1.0;
            let mut places: Vec<Vector3> = (0..60)
                .map(|i| {
                    let [x, y, noise] = [0, 1, 2].map(|k| unit(3 * i + k));
                    Vector3::new(x, y, 0.7 * (x - 0.2).max(0.0) + 0.03 * noise)
                })
                .collect();
            places.sort_by(|p, q| p.norm_squared().total_cmp(&q.norm_squared()));
            places.truncate(4 + draw as usize % 57);
            let mut offsets = Offsets::default();
            offsets.set(places.into_iter());
            let noise = Covariance::isotropic(3e-4);
            let patch = Patch::new(&offsets, PatchNoise::Uniform(&noise), &noise, 0.2);
            let told = |surface: Option<Surface>| surface.map(|surface| format!("{surface:?}"));
            assert_eq!(told(fit_surface(&patch)), told(Fit(&patch).run(Scalar256b)), "{draw}");
        }
    }
}

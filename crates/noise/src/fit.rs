//! A search for the surface near a point: a robust local fit over a neighbourhood that grows while it
//! explains the residuals.

use crate::aside::aside;
use crate::candidates::best_candidate;
use crate::lanes::{Kernel, Machine, run};
use crate::patch::{MOST_NEIGHBORS, NEAR_NEIGHBORS, Patch, Plane};
use crate::regression::FINAL_CUT;
use crate::reweight::reweighted;
use crate::surface::{Surface, is_better, measured};

/// The neighbourhood sizes that are tried, ...
const SIZES: [usize; 7] = [8, 12, 18, 27, 40, NEAR_NEIGHBORS, MOST_NEIGHBORS];
/// ... the first so many of them always.
const ALWAYS: usize = 6;
/// A neighbourhood of which so many times the error is expected is no part of a wider surface.
const PLAINLY_WORSE: f64 = 2.0;
/// A plane through fewer neighbours than this explains anything.
const LEAST_NEIGHBORS: usize = 4;
/// Residuals beyond so many standard deviations weigh nothing, pass by pass.
const CUTS: [f64; 4] = [3.5, 3.5, FINAL_CUT, FINAL_CUT];

/// Neighbourhoods that were tried.
///
/// From the best supported plane of a few, each neighbourhood size is refined by Tukey weights;
/// the size and the model (plane, or plane with mean curvature) with the least expected squared
/// error s²·leverage + 2τ² are kept, τ² being what noise does not explain of the residuals. What the
/// other sizes say about height and normal comes with it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Fit {
    plane: Option<Plane>,
    best: Option<Surface>,
    tried: [Option<Surface>; SIZES.len()],
    /// How many sizes were.
    count: usize,
}

impl Fit {
    /// Tries the sizes that there are neighbours for; the wide ones while they are not plainly worse than
    /// the others.
    pub(crate) fn grow(&mut self, patch: &Patch) {
        run(Grow { fit: self, patch });
    }

    /// Whether there is something to be gained by more neighbours than the nearest.
    pub(crate) fn may_widen(&self) -> bool {
        self.count == ALWAYS && self.is_open()
    }

    /// Whether the widest neighbourhood that was tried is not plainly worse than the best.
    fn is_open(&self) -> bool {
        let widest = self.count.checked_sub(1).and_then(|last| self.tried[last]);
        widest.zip(self.best).is_some_and(|(widest, best)| {
            widest.expected_error < PLAINLY_WORSE * best.expected_error
        })
    }

    /// The best surface, given all neighbours that were looked at; `None` when no size determines a
    /// plane: too few neighbours, or all about one line.
    pub(crate) fn surface(&self, patch: &Patch) -> Option<Surface> {
        let mut best = self.best?;
        (best.disagreement, best.tilt) = disagreement(&best, &self.tried);
        let no_smaller = self.tried.iter().flatten().filter(|other| other.size >= best.size);
        best.suspected = no_smaller.map(|other| other.excess).fold(0.0, f64::max);
        best.aside = aside(patch, &best);
        Some(best)
    }
}

struct Grow<'a> {
    fit: &'a mut Fit,
    patch: &'a Patch<'a>,
}

impl Kernel for Grow<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Machine>(self, machine: S) {
        let Self { fit, patch } = self;
        if fit.count == 0 {
            fit.plane = best_candidate(machine, patch);
        }
        while fit.count < SIZES.len() {
            let Some(plane) = fit.plane else { return };
            let size = SIZES[fit.count].min(patch.len());
            let before = if fit.count == 0 { LEAST_NEIGHBORS - 1 } else { SIZES[fit.count - 1] };
            if size <= before || (fit.count >= ALWAYS && !fit.is_open()) {
                return;
            }
            let nearest = patch.nearest(size);
            let cuts = if fit.best.is_none() { &CUTS[..] } else { &CUTS[2..] };
            if let Some(refined) = refined(machine, &nearest, plane, cuts)
                && let Some(surface) = measured(machine, &nearest, &refined)
            {
                fit.plane = Some(refined);
                fit.tried[fit.count] = Some(surface);
                if fit.best.is_none_or(|b| is_better(surface.expected_error, b.expected_error)) {
                    fit.best = Some(surface);
                }
            }
            fit.count += 1;
        }
    }
}

/// The plane after a pass by each cut.
#[inline(always)]
fn refined<S: Machine>(machine: S, patch: &Patch, mut plane: Plane, cuts: &[f64]) -> Option<Plane> {
    // Not by an iterator, whose methods would be compiled without vector instructions.
    for &cut in cuts {
        plane = reweighted(machine, patch, &plane, cut)?;
    }
    Some(plane)
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

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Vector3, seed};
    use pulp::Scalar256b;

    use super::*;
    use crate::patch::{Offsets, PatchNoise};

    /// Offsets of so many places with these heights, in order of distance.
    fn offsets(count: u64, draw: u64, height: impl Fn(f64, f64) -> f64) -> Offsets {
        let unit = |k| 2.0 * seed::unit(seed::derive(5, draw, k)) - 1.0;
        let place = |i| {
            let [x, y, noise] = [0, 1, 2].map(|k| unit(3 * i + k));
            Vector3::new(x, y, height(x, noise))
        };
        let mut places: Vec<Vector3> = (0..count).map(place).collect();
        places.sort_by(|p, q| p.norm_squared().total_cmp(&q.norm_squared()));
        let mut offsets = Offsets::default();
        offsets.set(places.into_iter());
        offsets
    }

    fn fit(offsets: &Offsets) -> (Fit, Option<Surface>) {
        let noise = Covariance::isotropic(3e-4);
        let patch = Patch::new(offsets, PatchNoise::Uniform(&noise), &noise, 0.1);
        let mut fit = Fit::default();
        fit.grow(&patch);
        let surface = fit.surface(&patch);
        (fit, surface)
    }

    /// Two faces that meet, with noise: candidates, weights, both models and all sizes are needed.
    #[test]
    fn a_fit_is_the_same_to_the_bit_on_any_machine() {
        for draw in 0..200 {
            let count = 4 + 13 * draw % 237;
            let offsets = offsets(count, draw, |x, noise| 0.7 * (x - 0.2).max(0.0) + 0.03 * noise);
            let noise = Covariance::isotropic(3e-4);
            let patch = Patch::new(&offsets, PatchNoise::Uniform(&noise), &noise, 0.1);
            let mut portable = Fit::default();
            Grow { fit: &mut portable, patch: &patch }.run(Scalar256b);
            assert_eq!(format!("{:?}", fit(&offsets).0), format!("{portable:?}"), "{draw}");
        }
    }

    #[test]
    fn what_is_flat_is_fitted_to_many_neighbours_and_what_waves_to_few() {
        let flat = fit(&offsets(240, 1, |_, noise| 0.02 * noise)).1.unwrap();
        assert!(flat.size >= 120, "{flat:?}");
        let waves = |x: f64, noise| 0.3 * (4.0 * x).sin() + 0.02 * noise;
        let wave = fit(&offsets(240, 1, waves)).1.unwrap();
        assert!(wave.size <= NEAR_NEIGHBORS, "{wave:?}");
    }

    /// A second sheet three deviations off leaves the fit as it is, and doubt.
    #[test]
    fn another_face_beside_is_seen() {
        let sheets = |apart: f64| {
            let other = |x: f64| f64::from((37.0 * x).fract() > 0.3);
            fit(&offsets(240, 2, |x, noise| 0.02 * noise + apart * other(x))).1.unwrap().aside
        };
        assert_eq!(sheets(0.0), 0.0);
        assert_eq!(sheets(0.5), 0.0);
        assert!(sheets(0.052) > 1e-5, "{}", sheets(0.052));
    }
}

//! What lies beside a fitted surface but not on it: another face that the noise half hides.

use crate::lanes::{Kernel, Lanes, Machine, run};
use crate::patch::Patch;
use crate::reweight::tukey;
use crate::surface::Surface;

/// So many times the neighbours of the fit are looked at, if there are as many.
const WIDER: f64 = 2.5;
/// What is farther off than this many standard deviations is another thing, and no doubt about this one.
const CUT: f64 = 4.5;
/// The variance of standard normal residuals weighted by Tukey factors that end at [`CUT`]:
/// ∫ t x² φ / ∫ t φ with t = (1 − x²/4.5²)².
const TUKEY_VARIANCE: f64 = 0.815;

/// The variance by which neighbours spread about a surface beyond noise and chance, m².
pub(crate) fn aside(patch: &Patch, surface: &Surface) -> f64 {
    run(Aside { patch, surface })
}

struct Aside<'a> {
    patch: &'a Patch<'a>,
    surface: &'a Surface,
}

impl Kernel for Aside<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<S: Machine>(self, machine: S) -> f64 {
        let Self { patch, surface } = self;
        let wider = patch.nearest((surface.size as f64 * WIDER) as usize);
        let precisions = wider.precisions(&surface.normal);
        let inverse_cut = 1.0 / (CUT * CUT);
        let [mut total, mut squares] = [Lanes::zero(machine); 2];
        for group in 0..wider.groups() {
            let offsets = wider.group(machine, group);
            let present = wider.present(machine, group);
            let precision = precisions.group(machine, group);
            let [squared, _] = surface.squared_residual_and_reach(machine, offsets);
            let ratio = squared * precision;
            let weight = tukey(machine, ratio * inverse_cut) * present;
            total += weight;
            squares += weight * ratio;
        }
        let total = total.sum();
        if total <= 0.0 {
            return 0.0;
        }
        let chance = (2.0 / total).sqrt();
        let spread = squares.sum() / (TUKEY_VARIANCE * total) - 1.0 - chance;
        spread.max(0.0) * wider.own_variance(&surface.normal)
    }
}

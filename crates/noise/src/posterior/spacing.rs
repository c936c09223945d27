//! How far apart samples are on a surface that was fitted to them.

use crate::index::spacing::{SPACING_NEIGHBORS, spacing_of_rank};
use crate::lanes::{Kernel, Lanes, Machine, WIDTH, run};
use crate::surface::Surface;
use crate::surface::patch::Patch;

/// Samples get denser by this part over a spacing where they are scattered all around, and at a straight end.
const DENSER: [f64; 2] = [0.3, 0.85];
/// A neighbour so many standard deviations off the surface is not a sample of it.
const SAMPLE_OFFSET: f64 = 3.5;

/// The spacing of the samples on the surface, noise across it left out: the sixth least distance
/// across the normal among the neighbours near the surface; `None` when there is none.
pub(super) fn tangential_spacing(patch: &Patch, surface: &Surface) -> Option<f64> {
    run(Spacing { patch, surface })
}

/// The spacing told at a point (m) where it is as far as samples are seen all around. At an end they fill half the
/// disc that it is told from. `sharp` is how small the noise is beside it, up to 1: where that is large, which
/// samples are past the end is not known, and they are as far apart as they seem.
pub(super) fn beside_end(told: f64, surface: &Surface, sharp: f64) -> f64 {
    let [all_around, at_end] = DENSER;
    let denser = surface.score.norm() * told;
    let one_sided = ((denser - all_around) / (at_end - all_around)).clamp(0.0, 1.0);
    told * (1.0 - 0.5 * sharp * one_sided).sqrt()
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

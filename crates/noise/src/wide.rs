//! The surface where the nearest neighbours are all noise.

use std::f64::consts::FRAC_1_SQRT_2;

use crate::neighborhoods::Neighborhoods;
use crate::patch::MOST_NEIGHBORS;
use crate::scratch::Scratch;
use crate::sensor_noise::SensorNoise;
use crate::surface::{Surface, fit_surface};

/// Among as many neighbours from farther away: every fourth or sixteenth of four or sixteen times as
/// many.
const STRIDES: [usize; 2] = [4, 16];
/// How often a wider neighbourhood is gathered.
const PASSES: usize = 3;
/// A wider patch may have this many times the variance.
const WIDER: f64 = 2.0;

/// The surface by neighbours from farther away, where the nearest are all noise: the widest fit that
/// is not plainly worse than a narrower one. `None` where none of them determines a plane.
pub(crate) fn wide_surface(
    index: usize,
    neighborhoods: &Neighborhoods,
    sensor: &SensorNoise,
    spacing: f64,
    scratch: &mut Scratch,
) -> Option<Surface> {
    let mut found: Option<Surface> = None;
    for stride in STRIDES {
        let wide = strided_surface(stride, index, neighborhoods, sensor, spacing, scratch);
        let Some(mut wide) = wide else { continue };
        // Residuals of twice as many neighbours hide less.
        if found.is_some() {
            wide.hidden *= FRAC_1_SQRT_2;
        }
        if found.is_none_or(|narrower| wide.expected_error < WIDER * narrower.expected_error) {
            found = Some(wide);
        }
    }
    found
}

/// The surface by every `stride`-th of as many times more neighbours. What is nearest to a displaced
/// point agrees with it more than it should, so they are gathered again about where the surface
/// seems to be.
fn strided_surface(
    stride: usize,
    index: usize,
    neighborhoods: &Neighborhoods,
    sensor: &SensorNoise,
    spacing: f64,
    scratch: &mut Scratch,
) -> Option<Surface> {
    let points = neighborhoods.points();
    let Scratch { wide_neighbors, wide_patch, .. } = scratch;
    let mut place = points[index];
    let mut found = None;
    for _ in 0..PASSES {
        neighborhoods.nearest_to_into(&place, stride * MOST_NEIGHBORS, wide_neighbors);
        // The point itself is the measurement, not a part of what it is held against.
        let every = (wide_neighbors.iter().skip(stride - 1).step_by(stride))
            .filter(|near| points[near.index] != points[index]);
        let surface = fit_surface(&wide_patch.patch(index, every, points, sensor, spacing))?;
        place = points[index] + surface.normal.into_inner() * surface.height;
        found = Some(surface);
    }
    found
}

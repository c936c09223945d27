//! The surface where the nearest neighbours are all noise.

use std::f64::consts::FRAC_1_SQRT_2;

use cloudtouch_geom::Point3;

use crate::index::neighbor::Neighbor;
use crate::neighborhoods::Neighborhoods;
use crate::scratch::Scratch;
use crate::sensor::noise::SensorNoise;
use crate::surface::patch::MOST_NEIGHBORS;
use crate::surface::scatter::possible_variance_alone;
use crate::surface::{Surface, fit_surface};

/// How often neighbours are gathered at most, of a fourth of the cloud and of a sixteenth: the first tells about where
/// the surface is.
const PASSES: [usize; 2] = [1, 2];
/// A move of which the square is less than this part of the squared error expected is none.
const SETTLED: f64 = 0.25;
/// A wider patch may have this many times the variance.
const WIDER: f64 = 2.0;

/// The surface by neighbours from farther away, where the nearest are all noise: the widest fit that
/// is not plainly worse than a narrower one. Among as many neighbours, of a fourth and of a sixteenth
/// of the cloud. `None` where none of them determines a plane.
pub(crate) fn wide_surface(
    index: usize,
    neighborhoods: &Neighborhoods,
    sensor: &SensorNoise,
    spacing: f64,
    scratch: &mut Scratch,
) -> Option<Surface> {
    let points = neighborhoods.points();
    let Scratch { wide_blocks, wide_neighbors, wide_patch, .. } = scratch;
    let mut found: Option<Surface> = None;
    let mut place = points[index];
    for ((thinned, block), passes) in neighborhoods.thinned().iter().zip(wide_blocks).zip(PASSES) {
        let around = |place: &Point3| {
            // One more than are used, for the point itself is the measurement, not a part of what it
            // is held against.
            let most = MOST_NEIGHBORS + 1;
            block.nearest_into(thinned.positions(), place, most, false, wide_neighbors);
            for near in wide_neighbors.iter_mut() {
                near.index = thinned.index(near.index);
            }
            let others = wide_neighbors.iter().filter(|near| points[near.index] != points[index]);
            fit_surface(&wide_patch.patch(
                index,
                others.take(MOST_NEIGHBORS).map(|near| near.index),
                points,
                sensor,
                spacing,
            ))
        };
        let Some((mut wide, at)) = settled(points[index], place, passes, around) else { continue };
        place = at;
        // Residuals of twice as many neighbours hide less.
        if found.is_some() {
            wide.hidden *= FRAC_1_SQRT_2;
        }
        if found.is_none_or(|narrower| wide.relative_error < WIDER * narrower.relative_error) {
            found = Some(wide);
        }
    }
    found
}

/// The largest variance that noise can have along the surface that [`wide_surface`] found last, m², given the
/// neighbours that it left: as it is about the nearest of them, told once for all that have it nearest.
pub(super) fn possible_variance_about(
    neighborhoods: &Neighborhoods,
    wide_neighbors: &mut Vec<Neighbor>,
) -> f64 {
    let (Some(&Neighbor { index, .. }), Some(least)) =
        (wide_neighbors.first(), neighborhoods.thinned().last())
    else {
        return f64::INFINITY;
    };
    least.told(index, || {
        neighborhoods.nearest_into(index, MOST_NEIGHBORS, wide_neighbors);
        let points = neighborhoods.points();
        possible_variance_alone(
            wide_neighbors.iter().map(|near| points[near.index] - points[index]),
        )
    })
}

/// The surface of a point by what is about a place, and where it is. What is nearest to a displaced
/// point agrees with it more than it should, so the neighbours are gathered again about where the
/// surface seems to be, until it moves by less than it is known.
fn settled(
    point: Point3,
    mut place: Point3,
    passes: usize,
    mut around: impl FnMut(&Point3) -> Option<Surface>,
) -> Option<(Surface, Point3)> {
    let mut found = None;
    for _ in 0..passes {
        let surface = around(&place)?;
        let at = point + surface.normal.into_inner() * surface.height;
        let moved = (at - place).norm_squared();
        place = at;
        found = Some((surface, place));
        if moved < SETTLED * surface.expected_error {
            break;
        }
    }
    found
}

//! The surface by the nearest neighbours of a point.

use cloudtouch_geom::Point3;

use crate::fit::Fit;
use crate::neighborhoods::Neighborhoods;
use crate::patch::{MOST_NEIGHBORS, NEAR_NEIGHBORS};
use crate::positions::Neighbor;
use crate::scratch::{Buffers, Scratch, reach};
use crate::sensor_noise::SensorNoise;
use crate::surface::Surface;

/// A point of a cloud, and what is known of the cloud there.
#[derive(Clone, Copy)]
pub(crate) struct About<'a> {
    pub(crate) index: usize,
    pub(crate) points: &'a [Point3],
    pub(crate) sensor: &'a SensorNoise,
    /// Of the samples, m.
    pub(crate) spacing: f64,
}

/// The surface near a point by its nearest neighbours, the first [`NEAR_NEIGHBORS`] of which are in
/// `scratch`.
pub(crate) fn near_surface(
    about: About<'_>,
    neighborhoods: &Neighborhoods,
    scratch: &mut Scratch,
) -> Option<Surface> {
    let Scratch { far_block, neighbors, patch, .. } = scratch;
    let place = &about.points[about.index];
    let mut asked = NEAR_NEIGHBORS;
    let gather = |count: usize, neighbors: &mut Vec<Neighbor>| {
        if count > NEAR_NEIGHBORS {
            asked = count;
            far_block.nearest_into(neighborhoods.positions(), place, count, true, neighbors);
        }
    };
    let surface = widening(about, gather, neighbors, patch);
    scratch.reach = reach(&scratch.neighbors, asked);
    surface
}

/// The surface by some neighbours, and by more where it takes all of these; `gather` puts so many into a
/// buffer, in order of distance.
pub(crate) fn widening(
    about: About<'_>,
    mut gather: impl FnMut(usize, &mut Vec<Neighbor>),
    neighbors: &mut Vec<Neighbor>,
    buffers: &mut Buffers,
) -> Option<Surface> {
    let About { index, points, sensor, spacing } = about;
    let mut fit = Fit::default();
    gather(NEAR_NEIGHBORS, neighbors);
    let patch = buffers.patch(index, neighbors.iter(), points, sensor, spacing);
    fit.grow(&patch);
    if !fit.may_widen() {
        return fit.surface(&patch);
    }
    gather(MOST_NEIGHBORS, neighbors);
    let patch = buffers.patch(index, neighbors.iter(), points, sensor, spacing);
    fit.grow(&patch);
    fit.surface(&patch)
}

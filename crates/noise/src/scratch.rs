//! Memory that refinement works in.

use cloudtouch_geom::Point3;

use crate::index::block::Block;
use crate::index::neighbor::Neighbor;
use crate::sensor::noise::SensorNoise;
use crate::surface::patch::{NoiseLanes, Offsets, Patch, PatchNoise};

/// Buffers reused from one refinement to the next; holds no results.
#[derive(Debug, Default)]
pub struct Scratch {
    /// Of the cloud, about the last point.
    pub(crate) block: Block,
    /// The same for the few that are asked for without a fit: a block of many would be too wide for
    /// them, and theirs too narrow for the next fit.
    pub(crate) few_block: Block,
    /// What is asked for together.
    pub(crate) places: Vec<Point3>,
    pub(crate) neighbors: Vec<Neighbor>,
    pub(crate) patch: Buffers,
    /// Of the thinned clouds.
    pub(crate) wide_blocks: [Block; 2],
    /// Of the representatives.
    pub(crate) kept_block: Block,
    /// What was found there, by their places among them.
    pub(crate) near_representatives: Vec<Neighbor>,
    /// Neighbours and patch of a wider neighbourhood.
    pub(crate) wide_neighbors: Vec<Neighbor>,
    pub(crate) wide_patch: Buffers,
    /// See [`Self::reach`].
    pub(crate) reach: f64,
}

impl Scratch {
    /// How far (m) the last refinement looked: points farther from the refined one, whether they come,
    /// go or move, change no bit of it. Infinite where it looked at the cloud as a whole.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The points nearest to the one that was refined last, as [`Neighborhoods::nearest`] has them: as
    /// many as its refinement looked at; none about most representatives that are all noise.
    ///
    /// [`Neighborhoods::nearest`]: crate::Neighborhoods::nearest
    pub fn neighbors(&self) -> &[Neighbor] {
        &self.neighbors
    }

    /// The representatives nearest to the one that was refined last, as [`Neighborhoods::nearest`] of
    /// [`Representatives::neighborhoods`] has them: some dozens, or none where no surface was found.
    ///
    /// [`Representatives::neighborhoods`]: crate::Representatives::neighborhoods
    /// [`Neighborhoods::nearest`]: crate::Neighborhoods::nearest
    pub fn near_representatives(&self) -> &[Neighbor] {
        &self.near_representatives
    }
}

#[derive(Debug, Default)]
pub(crate) struct Buffers {
    offsets: Offsets,
    /// Empty where it is the same for all.
    noise: NoiseLanes,
}

impl Buffers {
    /// The neighbours as a patch about point `index`.
    pub(crate) fn patch<'a>(
        &'a mut self,
        index: usize,
        neighbors: impl Iterator<Item = usize> + Clone,
        points: &[Point3],
        sensor: &'a SensorNoise,
        spacing: f64,
    ) -> Patch<'a> {
        self.offsets.set(neighbors.clone().map(|n| points[n] - points[index]));
        let noise = if let Some(covariance) = sensor.as_uniform() {
            PatchNoise::Uniform(covariance)
        } else {
            self.noise.set(neighbors.map(|n| &sensor[n]));
            PatchNoise::Each(&self.noise)
        };
        Patch::new(&self.offsets, noise, &sensor[index], spacing)
    }
}

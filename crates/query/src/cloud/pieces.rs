//! Which of the points of a cloud stand for its surface.

use cloudtouch_noise::{
    Neighborhoods, NoiseError, NoiseModel, Refined, Representatives, Scratch, SensorNoise,
};

use super::makeup::spread::Sample;

/// The points that a surface is fitted at, and that the tree is built over: all, or a few of them
/// where they are far denser than their noise.
#[derive(Debug)]
pub(super) struct Pieces {
    chosen: Option<Representatives>,
}

impl Pieces {
    /// Every point stands for the surface about it.
    pub(super) fn all() -> Self {
        Self { chosen: None }
    }

    /// The points that tell as much as all; which, the noise of a sample of them decides.
    pub(super) fn chosen(
        cloud: &Neighborhoods,
        noise: &SensorNoise,
        sample: &Sample,
    ) -> Result<Self, NoiseError> {
        let sample = (sample.indices.as_slice(), sample.spacings(cloud));
        Ok(Self { chosen: Representatives::choose(cloud, noise, sample)? })
    }

    /// Whether every point stands for itself.
    pub(super) fn is_each(&self) -> bool {
        self.chosen.is_none()
    }

    /// The index in the cloud of every piece, in order.
    pub(super) fn indices(&self, cloud: &Neighborhoods) -> Vec<usize> {
        let count = self.neighborhoods(cloud).points().len() as u32;
        (0..count).map(|piece| self.index(piece)).collect()
    }

    /// The index of a piece in the cloud.
    pub(super) fn index(&self, piece: u32) -> usize {
        self.chosen.as_ref().map_or(piece, |chosen| chosen.indices()[piece as usize]) as usize
    }

    /// Which pieces are near which.
    pub(super) fn neighborhoods<'a>(&'a self, cloud: &'a Neighborhoods) -> &'a Neighborhoods {
        self.chosen.as_ref().map_or(cloud, Representatives::neighborhoods)
    }

    /// The surface at a piece.
    pub(super) fn refine(
        &self,
        piece: u32,
        (model, cloud, noise): (&NoiseModel, &Neighborhoods, &SensorNoise),
        spacing_cap: f64,
        scratch: &mut Scratch,
    ) -> Refined {
        let index = self.index(piece);
        match &self.chosen {
            None => model.refine(index, cloud, noise, spacing_cap, scratch),
            Some(chosen) => {
                model.refine_representative(index, cloud, chosen, noise, spacing_cap, scratch)
            }
        }
    }
}

//! Where samples are far denser than their noise, a few stand for all.

use cloudtouch_geom::Point3;
use rayon::prelude::*;

use crate::error::NoiseError;
use crate::neighborhoods::{Neighbor, Neighborhoods};
use crate::sensor_noise::SensorNoise;
use crate::spacing::{SPACING_NEIGHBORS, is_noisy, spacing_around};

/// A representative stands for the points up to so many spacings from it, and for none beyond the
/// standard deviation of the noise.
const REACH_SPACINGS: f64 = 2.0;
/// Points whose noise is compared with their spacing before all are.
const SAMPLE: usize = 200;
/// The part of these that has to be noisy.
const NOISY_SHARE: f64 = 0.05;

/// The points that stand for a surface, and which are near which.
///
/// Where the noise is larger than the spacing, the surface at a point is fitted to hundreds of others,
/// and its neighbours tell nothing else: it is enough to ask for it every two standard deviations.
#[derive(Debug)]
pub struct Representatives {
    indices: Vec<u32>,
    near: Neighborhoods,
}

impl Representatives {
    /// Chooses among the points of a cloud, whose position noise is `sensor`; `None` where every point
    /// stands for itself.
    ///
    /// The densest places come first, which are those near the surface, so that the choice depends on
    /// neither the frame nor the order of the points. A point whose noise is small is never stood for
    /// by one whose noise is large.
    ///
    /// # Errors
    /// As for [`Neighborhoods::try_new`], which cannot happen for points out of one.
    ///
    /// # Panics
    /// When the length of `sensor` does not belong to the cloud.
    pub fn choose(cloud: &Neighborhoods, sensor: &SensorNoise) -> Result<Option<Self>, NoiseError> {
        assert_eq!(sensor.len(), cloud.points().len(), "one sensor covariance for each point");
        if !is_crowded(cloud, sensor) {
            return Ok(None);
        }
        let indices = chosen(cloud, sensor);
        if indices.len() == cloud.points().len() {
            return Ok(None);
        }
        let places: Vec<Point3> = indices.iter().map(|&i| cloud.points()[i as usize]).collect();
        let near = Neighborhoods::try_new(places)?;
        Ok(Some(Self { indices, near }))
    }

    /// Their indices in the cloud they were chosen from, in order.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Which of them are near which, by their places in [`Self::indices`].
    pub fn neighborhoods(&self) -> &Neighborhoods {
        &self.near
    }

    /// The nearest to a place, by their indices in the cloud, into a buffer, whose old content is
    /// dropped.
    pub(crate) fn nearest_to_into(&self, place: &Point3, k: usize, found: &mut Vec<Neighbor>) {
        self.near.nearest_to_into(place, k, found);
        for near in found {
            near.index = self.indices[near.index] as usize;
        }
    }
}

/// Whether the noise exceeds the spacing at more than a few of some points.
fn is_crowded(cloud: &Neighborhoods, sensor: &SensorNoise) -> bool {
    let count = cloud.points().len();
    let sampled = count.min(SAMPLE);
    let noisy = (0..sampled)
        .map(|s| s * count / sampled)
        .filter(|&index| is_noisy(&sensor[index], Around::of(cloud, index).spacing))
        .count();
    noisy as f64 > NOISY_SHARE * sampled as f64
}

fn chosen(cloud: &Neighborhoods, sensor: &SensorNoise) -> Vec<u32> {
    let count = cloud.points().len();
    let around: Vec<Around> =
        (0..count).into_par_iter().map(|index| Around::of(cloud, index)).collect();
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&i, &j| around[i].squares.total_cmp(&around[j].squares).then(i.cmp(&j)));
    let mut is_represented = vec![false; count];
    let mut chosen = Vec::new();
    for index in order {
        if is_represented[index] {
            continue;
        }
        chosen.push(index as u32);
        let (noise, spacing) = (&sensor[index], around[index].spacing);
        if is_noisy(noise, spacing) {
            let reach = noise.max_std().min(REACH_SPACINGS * spacing);
            for near in cloud.within(index, reach * reach) {
                let noise = sensor[near.index].max_std();
                is_represented[near.index] |= near.squared_distance <= noise * noise;
            }
        }
    }
    chosen.sort_unstable();
    chosen
}

/// How dense the samples are about a point.
struct Around {
    /// The distance between them, m; infinite for one alone.
    spacing: f64,
    /// The sum of the squared distances of the nearest, m². Two points that are each other's sixth
    /// neighbour have the same spacing, but not the same sum: which comes first must not hang on
    /// rounding.
    squares: f64,
}

impl Around {
    fn of(cloud: &Neighborhoods, index: usize) -> Self {
        let near = cloud.nearest(index, SPACING_NEIGHBORS);
        Self {
            spacing: spacing_around(&near).unwrap_or(f64::INFINITY),
            squares: near.iter().map(|near| near.squared_distance).sum(),
        }
    }
}

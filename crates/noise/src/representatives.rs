//! Where samples are far denser than their noise, a few stand for all.

use cloudtouch_geom::Point3;

use crate::error::NoiseError;
use crate::index::positions::Positions;
use crate::index::spacing::is_noisy;
use crate::index::ties::widened;
use crate::neighborhoods::Neighborhoods;
use crate::sensor::noise::SensorNoise;

/// A representative stands for the points up to so many spacings from it, ...
const REACH_SPACINGS: f64 = 2.0;
/// ... or up to this part of the standard deviation of the noise, which hides steps so short, and for
/// none beyond the whole of it.
const REACH_STD: f64 = 0.2;
/// The surface of a point is up to so many standard deviations of its noise away.
const SURFACE_STDS: f64 = 2.0;
/// The part of a sample of the points that has to be noisy.
const NOISY_SHARE: f64 = 0.05;

/// The points that stand for a surface, and which are near which.
///
/// Where the noise is larger than the spacing, the surface at a point is fitted to hundreds of others,
/// and its neighbours tell nothing else: it is enough to ask for it every two spacings.
///
/// ```
/// use cloudtouch_noise::geom::{Covariance, Point3};
/// use cloudtouch_noise::{
///     Neighborhoods, NoiseModel, Representatives, Scratch, SensorNoise, spacings_at,
/// };
///
/// // A floor of 60 by 60 points, 1 cm apart, with 4 cm of noise.
/// let height = |i: i32| 0.056 * (0.7 * f64::from(i * i)).sin();
/// let points: Vec<Point3> = (0..3600)
///     .map(|i| Point3::new(0.01 * f64::from(i / 60), 0.01 * f64::from(i % 60), height(i)))
///     .collect();
/// let sensor = SensorNoise::uniform(Covariance::isotropic(0.04_f64.powi(2)), points.len());
/// let cloud = Neighborhoods::new(points)?;
///
/// // Some hundred points from all over it tell whether the noise exceeds the spacing.
/// let sample: Vec<usize> = (0..cloud.points().len()).step_by(37).collect();
/// let spacings = spacings_at(&cloud, sample.iter().copied());
/// let kept = Representatives::choose(&cloud, &sensor, (&sample, &spacings))?
///     .ok_or("every point stands for itself: refine them all")?;
/// assert!(kept.indices().len() < 1200);
///
/// // The surface is fitted to all points, but asked for at these alone.
/// let (model, mut scratch) = (NoiseModel::default(), Scratch::default());
/// for &index in kept.indices() {
///     let index = index as usize;
///     let refined = model
///         .refine_representative(index, &cloud, &kept, &sensor, f64::INFINITY, &mut scratch);
///     let normal = refined.normal.ok_or("no surface here")?;
///     assert!(refined.point.covariance.std_along(&normal) < 0.04);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Representatives {
    indices: Vec<u32>,
    /// How far apart samples are about each point of the cloud, m; infinite about one alone.
    spacings: Vec<f64>,
    near: Neighborhoods,
}

impl Representatives {
    /// Chooses among the points of a cloud, whose position noise is `sensor`; `None` where every point
    /// stands for itself, as at all but a few of `sample`, indices of points from all over the cloud, some
    /// hundred, with [their spacings](crate::spacings_at). What a choice is not to depend on, such as the order
    /// of the points, they must not either.
    ///
    /// The densest places come first, which are those near the surface, so that the choice depends on
    /// neither the frame nor the order of the points: of places as dense, as those of a grid are, x, y and z tell which
    /// comes first. Of points at one place only the first is ever chosen. A point whose noise is small is never stood for
    /// by one whose noise is large.
    ///
    /// # Errors
    /// As for [`Neighborhoods::new`], which cannot happen for points out of one.
    ///
    /// # Panics
    /// When the length of `sensor` does not belong to the cloud, or an index of `sample`.
    pub fn choose(
        cloud: &Neighborhoods,
        sensor: &SensorNoise,
        sample: (&[usize], &[f64]),
    ) -> Result<Option<Self>, NoiseError> {
        assert_eq!(sensor.len(), cloud.points().len(), "one sensor covariance for each point");
        if !is_crowded(sensor, sample) {
            return Ok(None);
        }
        let (indices, spacings) = chosen(cloud, sensor);
        if indices.len() == cloud.points().len() {
            return Ok(None);
        }
        let places: Vec<Point3> = indices.iter().map(|&i| cloud.points()[i as usize]).collect();
        let near = Neighborhoods::new(places)?;
        Ok(Some(Self { indices, spacings, near }))
    }

    /// Their indices in the cloud they were chosen from, in order.
    pub fn indices(&self) -> &[u32] {
        &self.indices
    }

    /// Which of them are near which, by their places in [`Self::indices`].
    pub fn neighborhoods(&self) -> &Neighborhoods {
        &self.near
    }

    /// How far apart samples are about a point of the cloud they were chosen from or, where these are so many that the
    /// nearest of them are all noise, about the surface that it is of, m; `None` where it is alone. A point that noise
    /// took off that surface is itself among few.
    ///
    /// # Panics
    /// When cloud or noise are not those they were chosen by, or it is no point of these.
    pub(crate) fn spacing(
        &self,
        index: usize,
        cloud: &Neighborhoods,
        sensor: &SensorNoise,
    ) -> Option<f64> {
        let (own, noise) = (self.spacings[index], &sensor[index]);
        let spacing = if is_noisy(noise, own) {
            own
        } else {
            let mut least = own;
            let reach = SURFACE_STDS * noise.max_std();
            cloud.positions().visit_within(
                &cloud.points()[index],
                widened(reach * reach),
                |near| {
                    least = least.min(self.spacings[near.index]);
                },
            );
            if is_noisy(noise, least) { least } else { own }
        };
        spacing.is_finite().then_some(spacing)
    }

    /// Their positions, and the index in the cloud of one of these.
    pub(crate) fn positions(&self) -> (&Positions, impl Fn(usize) -> usize + '_) {
        (self.near.positions(), |place| self.indices[place] as usize)
    }
}

/// Whether the noise exceeds the spacing at more than a few of some points.
fn is_crowded(sensor: &SensorNoise, (indices, spacings): (&[usize], &[f64])) -> bool {
    let is_noisy = |(index, spacing): &(&usize, &f64)| is_noisy(&sensor[**index], **spacing);
    let noisy = indices.iter().zip(spacings).filter(is_noisy).count();
    noisy as f64 > NOISY_SHARE * indices.len() as f64
}

/// The indices that are chosen, in order, and the spacings at all points.
fn chosen(cloud: &Neighborhoods, sensor: &SensorNoise) -> (Vec<u32>, Vec<f64>) {
    let (densities, densest_first) = cloud.densities();
    let mut is_represented = vec![false; densities.len()];
    let mut chosen = Vec::new();
    for &index in densest_first {
        let at = index as usize;
        if is_represented[at] {
            continue;
        }
        chosen.push(index);
        let (noise, spacing) = (&sensor[at], densities[at].spacing);
        if is_noisy(noise, spacing) {
            let std = noise.max_std();
            let reach = std.min((REACH_SPACINGS * spacing).max(REACH_STD * std));
            // Whether what is as far as it reaches is in reach must not hang on rounding.
            cloud.positions().visit_within(&cloud.points()[at], widened(reach * reach), |near| {
                // PERF: mostly told without eigenvalues.
                if !is_represented[near.index] {
                    let (noise, squared) = (&sensor[near.index], near.squared_distance);
                    is_represented[near.index] = !noise.is_within(squared.sqrt())
                        || squared <= widened(noise.max_std().powi(2));
                }
            });
        }
    }
    chosen.sort_unstable();
    (chosen, densities.iter().map(|density| density.spacing).collect())
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, seed};

    use super::*;
    use crate::index::spacing::{SPACING_NEIGHBORS, spacing_around};

    /// Some points twice, and one alone far away.
    #[test]
    fn spacings_are_those_of_the_cloud_to_the_bit() {
        let unit = |i, k| seed::unit(seed::derive(3, i, k));
        let mut points: Vec<Point3> =
            (0..900).map(|i| Point3::new(unit(i, 0), unit(i, 1), 0.05 * unit(i, 2))).collect();
        points.extend_from_within(..90);
        points.push(Point3::new(9.0, 0.0, 0.0));
        let cloud = Neighborhoods::new(points.clone()).unwrap();
        let sensor = SensorNoise::uniform(Covariance::isotropic(0.01), points.len());
        let spacing = |index| spacing_around(&cloud.nearest(index, SPACING_NEIGHBORS));
        let sample: Vec<usize> = (0..100).collect();
        let spacings: Vec<f64> = sample.iter().map(|&i| spacing(i).unwrap()).collect();
        let kept = Representatives::choose(&cloud, &sensor, (&sample, &spacings)).unwrap().unwrap();
        assert!((20..800).contains(&kept.indices().len()), "{}", kept.indices().len());
        for index in kept.indices().iter().map(|&index| index as usize) {
            assert_eq!(kept.spacing(index, &cloud, &sensor), spacing(index), "{index}");
        }
    }
}

//! How far points are off the surface they are on, beside what is stated of their noise.

use std::cell::OnceCell;

use cloudtouch_geom::{Matrix3, Vector3};
use cloudtouch_noise::{Neighborhoods, SensorNoise};

use super::spread::spread;

/// Places that are looked about.
const PLACES: usize = 24;
/// So many of the nearest points are looked at from each, ...
const NEAREST: usize = 96;
/// ... and of all points so many at most, where these do not reach as far as is looked.
const POINTS: usize = 4000;
/// A plane through fewer of them tells nothing.
const LEAST: usize = 12;
/// Within this many standard deviations of the noise, ...
const WIDEST: f64 = 2.0;
/// ... and down by halves to this part of it, points are held against a plane.
const NARROWEST: f64 = 0.05;
/// Points of so much noise that they fill a ball are off any plane by this part of its radius: a ball's
/// own is the root of a fifth.
const OF_BALL: f64 = 0.44;
/// What is on a plane to this part of its noise was rounded to one, as the steps of a disparity are, or is a
/// scan of a single line: it is not overstated.
const EXACT: f64 = 1e-3;
/// Of the noise that is stated they are off a plane by more than this part, whatever the surface is, ...
const LEAST_SHARE: f64 = 0.15;
/// ... and by so much of a noise that is there.
const USUAL_SHARE: f64 = 0.45;

/// Noise that points do not have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Overstated {
    /// Standard deviation stated across the surface, m.
    pub stated: f64,
    /// That from a plane, there, m.
    pub seen: f64,
}

/// What points scatter by where a fourth of the places of a cloud are flatter: elsewhere the surface itself may
/// be bent, or a board.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scatter {
    /// As a part of what the noise that is stated would make of them.
    share: f64,
    overstated: Option<Overstated>,
}

/// Every so-manieth of a sample of the points.
pub(super) fn few_of(sample: &[usize]) -> Vec<usize> {
    sample.iter().copied().step_by(sample.len().div_ceil(PLACES).max(1)).collect()
}

/// About some places of a cloud; `None` where these have too few points about them to tell.
pub(in crate::cloud) fn scatter(
    cloud: &Neighborhoods,
    noise: &SensorNoise,
    places: &[usize],
) -> Option<Scatter> {
    let all = OnceCell::new();
    // PERF: to choose from all points takes longer than everything else here.
    let others = || all.get_or_init(|| spread(cloud.points(), POINTS)).as_slice();
    let found = places.iter().filter_map(|&at| flattest(at, cloud, noise, others));
    let (mut shares, flattest): (Vec<f64>, Vec<Option<Flattest>>) = found.unzip();
    // Places with too few points about them tell nothing.
    let tell = |count: usize| 2 * count >= places.len();
    if !tell(shares.len()) {
        return None;
    }
    shares.sort_by(f64::total_cmp);
    let mut flattest: Vec<Flattest> = flattest.into_iter().flatten().collect();
    flattest.sort_by(|p, q| p.share.total_cmp(&q.share));
    let fourth = flattest.get(flattest.len() / 4).filter(|_| tell(flattest.len()));
    let overstated = fourth.filter(|of| of.share < LEAST_SHARE).map(|of| of.noise);
    Some(Scatter { share: *shares.get(shares.len() / 4)?, overstated })
}

impl Scatter {
    /// Far flatter than what is stated leaves them: only errors that neighbours share could be so large. Not where they
    /// were rounded to planes.
    pub(in crate::cloud) fn overstated(self) -> Option<Overstated> {
        self.overstated
    }

    /// How much of the noise that is stated shows in the points, from 0, where it is overstated, or all near one
    /// another err alike, to 1.
    pub(in crate::cloud) fn shows(self) -> f64 {
        ((self.share - LEAST_SHARE) / (USUAL_SHARE - LEAST_SHARE)).clamp(0.0, 1.0)
    }
}

/// The scale at which the points about a place are on a plane best, beside their noise.
#[derive(Debug, Clone, Copy)]
struct Flattest {
    /// What they are off it, as a part of what the noise would make of them.
    share: f64,
    noise: Overstated,
}

/// The least share at any scale, and where that is the least of those that were not rounded to a plane.
fn flattest<'a>(
    at: usize,
    cloud: &Neighborhoods,
    noise: &SensorNoise,
    others: impl Fn() -> &'a [usize],
) -> Option<(f64, Option<Flattest>)> {
    let points = cloud.points();
    let std = noise[at].max_std();
    let mut radius = WIDEST * std;
    let near = cloud.nearest(at, NEAREST).into_iter();
    let mut near: Vec<Vector3> = near.map(|near| points[near.index] - points[at]).collect();
    let are_all = near.last().is_none_or(|last| last.norm() > radius);
    let others = if are_all { &[] } else { others() };
    let mut far: Vec<Vector3> = others.iter().map(|&i| points[i] - points[at]).collect();
    let mut least = f64::INFINITY;
    let mut best: Option<Flattest> = None;
    while radius >= NARROWEST * std {
        far.retain(|offset| offset.norm() <= radius);
        near.retain(|offset| offset.norm() <= radius);
        let offsets = if far.len() < LEAST { &near } else { &far };
        if offsets.len() < LEAST {
            break;
        }
        let (normal, seen) = off_plane(offsets);
        let stated = noise[at].variance_along(&normal).sqrt();
        let share = seen / stated.min(OF_BALL * radius);
        least = least.min(share);
        if share > EXACT && best.is_none_or(|best| share < best.share) {
            best = Some(Flattest { share, noise: Overstated { stated, seen } });
        }
        radius *= 0.5;
    }
    least.is_finite().then_some((least, best))
}

/// The normal of the plane through places by least squares, and their standard deviation from it.
fn off_plane(offsets: &[Vector3]) -> (Vector3, f64) {
    let count = offsets.len() as f64;
    let middle = offsets.iter().sum::<Vector3>() / count;
    let scatter: Matrix3 = offsets.iter().map(|o| (o - middle) * (o - middle).transpose()).sum();
    let axes = scatter.symmetric_eigen();
    let least = axes.eigenvalues.imin();
    let variance = axes.eigenvalues[least].max(0.0) / (count - 3.0);
    (axes.eigenvectors.column(least).into(), variance.sqrt())
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{PointCloud, TriangleMesh};
    use cloudtouch_noise::SensorModel;
    use cloudtouch_testkit::noise::{NoiseKind, add_noise};
    use cloudtouch_testkit::{scene, surface};

    use super::*;
    use crate::{Cloud, CloudSettings};

    /// Of a surface with this noise, of which is said that.
    fn of(mesh: &TriangleMesh, count: usize, [is, said]: [f64; 2]) -> Option<Overstated> {
        let samples = surface::positions(&surface::sample_surface(mesh, count, 3));
        let points = add_noise(&samples, NoiseKind::Gaussian, is, 4);
        let settings = CloudSettings::new(SensorModel::Isotropic { std: said });
        let cloud = PointCloud::from_points(points);
        Cloud::prepare(&cloud, &settings).unwrap().prepared().overstated()
    }

    #[test]
    fn noise_as_large_as_stated_is_not_overstated() {
        let (room, ball, cube) =
            (scene::room(), scene::sphere(0.05, 4), scene::cuboid([0.12, 0.12, 0.12]));
        for std in [0.001, 0.003, 0.01, 0.03] {
            for (mesh, count) in
                [(&room, 10_000), (&room, 100_000), (&ball, 3_000), (&cube, 10_000)]
            {
                assert_eq!(of(mesh, count, [std; 2]), None, "{std} m, {count} points");
                assert_eq!(of(mesh, count, [std, 3.0 * std]), None, "{std} m, {count} points");
            }
        }
    }

    #[test]
    fn noise_that_nothing_scatters_by_is() {
        // Between points as far apart as that nothing is known.
        assert_eq!(of(&scene::room(), 10_000, [0.002, 0.05]), None);
        for (mesh, count) in [(&scene::room(), 100_000), (&scene::plane_patch(1.0), 40_000)] {
            for stated in [0.05, 0.2, 0.6] {
                let found = of(mesh, count, [0.002, stated])
                    .unwrap_or_else(|| panic!("{stated} m, {count} points"));
                assert!(
                    found.seen < 0.1 * found.stated && found.stated > 0.9 * stated,
                    "{found:?}"
                );
            }
        }
    }
    /// Within a step of the disparity all is on one plane, and so is a scan of a single line.
    #[test]
    fn what_was_rounded_to_planes_tells_nothing() {
        let slope = |i: u64| {
            let [x, y] = [i % 200, i / 200].map(|k| 0.005 * k as f64);
            let step = 0.02;
            Vector3::new(x, y, ((0.5 * x + 0.1 * y) / step).round() * step)
        };
        let points = (0..40_000).map(|i| slope(i).into()).collect();
        let sensor = SensorModel::Isotropic { std: 0.02 / 12.0_f64.sqrt() };
        let by = CloudSettings::new(sensor);
        let cloud = Cloud::prepare(&PointCloud::from_points(points), &by).unwrap();
        assert_eq!(cloud.prepared().overstated(), None);
    }
}

//! How far samples can have been displaced along a surface, by how even the distances between them are.
//!
//! A camera sees by pixels, which are even. Noise across its rays would scatter what it sees.

use cloudtouch_geom::{Matrix3, Vector3};

use crate::surface::patch::MOST_NEIGHBORS;
use crate::surface::regression::Frame;
use crate::surface::smallest_axis::smallest_axis;

/// It is told from so many of the nearest neighbours: the others are nearest to some of them.
const ASKED: usize = 40;
/// Fewer are even by chance.
const LEAST: usize = 20;
/// The deviation of the distances to the nearest of scattered samples, in parts of their mean, is .52, the
/// √(4/π − 1) of a Poisson process; of so few as [`ASKED`] it is hardly ever less than this.
const SCATTERED: f64 = 0.36;
/// Samples of a lattice that are displaced by σ along each axis have distances to their nearest that deviate by .7 σ
/// to σ; so many times as much is held for possible.
const POSSIBLE: f64 = 1.5;

/// The largest variance, m², that noise along one axis in the plane across the normal can have, given the vectors (m)
/// from a point to its neighbours in order of distance: as many as a patch holds, or fewer. Infinite where they are as
/// scattered as by chance.
pub(crate) fn possible_variance(offsets: impl Iterator<Item = Vector3>, normal: &Vector3) -> f64 {
    let tangents = Frame::new(*normal).tangents;
    let mut places = [[0.0; MOST_NEIGHBORS]; 2];
    let mut count = 0;
    for offset in offsets.take(MOST_NEIGHBORS) {
        for (along, tangent) in places.iter_mut().zip(tangents) {
            along[count] = tangent.dot(&offset);
        }
        count += 1;
    }
    let [x, y] = &places;
    let asked = count.min(ASKED);
    if asked < LEAST {
        return f64::INFINITY;
    }
    let mut nearest = [f64::INFINITY; ASKED];
    for other in 0..count {
        // PERF: all of them alike, so that several are compared at once; what it had as its own nearest comes back.
        let own = nearest.get(other).copied();
        for (rank, least) in nearest.iter_mut().enumerate() {
            let squared = (x[rank] - x[other]).powi(2) + (y[rank] - y[other]).powi(2);
            *least = if squared < *least { squared } else { *least };
        }
        if let Some(own) = own {
            nearest[other] = own;
        }
    }
    let distances = || nearest[..asked].iter().map(|squared| squared.sqrt());
    let count = asked as f64;
    let mean = distances().sum::<f64>() / count;
    let variance = distances().map(|distance| (distance - mean).powi(2)).sum::<f64>() / count;
    let told = 1.0 - (variance.sqrt() / (SCATTERED * mean)).powi(4);
    if told > 0.0 { variance * (POSSIBLE / told).powi(2) } else { f64::INFINITY }
}

/// The same in the plane that the neighbours themselves are nearest to; infinite where they are near none.
pub(crate) fn possible_variance_alone(offsets: impl Iterator<Item = Vector3> + Clone) -> f64 {
    let (mut sum, mut squares, mut count) = (Vector3::zeros(), Matrix3::zeros(), 0.0);
    for offset in offsets.clone() {
        sum += offset;
        squares += offset * offset.transpose();
        count += 1.0;
    }
    match smallest_axis(&(squares - sum * sum.transpose() / count)) {
        Some(normal) => possible_variance(offsets, &normal),
        None => f64::INFINITY,
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::seed;

    use super::*;

    /// The neighbours, about the one in the middle, of samples of a plane: of a lattice of steps of one and of
    /// `long`, or scattered, and then displaced by noise of this deviation along each axis.
    fn neighbors(long: Option<f64>, std: f64, draw: u64) -> Vec<Vector3> {
        let uniform = |k| seed::unit(seed::derive(draw, 1, k));
        let normal = |k| {
            let (a, b) =
                (seed::unit(seed::derive(draw, 2, k)), seed::unit(seed::derive(draw, 3, k)));
            (-2.0 * (1.0 - a).ln()).sqrt() * (2.0 * std::f64::consts::PI * b).cos()
        };
        let mut places: Vec<Vector3> = (0..1600_u64)
            .map(|i| {
                let at = match long {
                    Some(long) => Vector3::new((i % 40) as f64, (i / 40) as f64 * long, 0.0),
                    None => Vector3::new(uniform(2 * i), uniform(2 * i + 1), 0.0) * 40.0,
                };
                at + Vector3::new(normal(3 * i), normal(3 * i + 1), normal(3 * i + 2)) * std
            })
            .collect();
        let middle = places[820];
        places.iter_mut().for_each(|place| *place -= middle);
        places.sort_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
        places[1..=MOST_NEIGHBORS].to_vec()
    }

    /// The part that is possible of the variance that there is, in the mean over draws.
    fn possible(long: Option<f64>, std: f64) -> [f64; 2] {
        let mut mean = [0.0; 2];
        for draw in 0..200 {
            let offsets = neighbors(long, std, draw);
            let offsets = offsets.iter().copied();
            let found = [
                possible_variance(offsets.clone(), &Vector3::z()),
                possible_variance_alone(offsets),
            ];
            for (mean, found) in mean.iter_mut().zip(found) {
                *mean += (found / (std * std)).min(1.0) / 200.0;
            }
        }
        mean
    }

    #[test]
    fn noise_that_there_is_is_possible() {
        for std in [0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0] {
            for long in [Some(1.0), Some(2.5), None] {
                let found = possible(long, std);
                assert!(found.iter().all(|&part| part > 0.98), "{long:?}, {std}: {found:?}");
            }
        }
    }

    /// As a camera's: along the normal alone.
    #[test]
    fn samples_as_even_as_a_lattice_were_hardly_displaced_along_it() {
        for (long, along) in [(1.0, 0.0), (1.0, 0.1), (2.5, 0.1), (1.0, 0.2)] {
            let offsets = neighbors(Some(long), along, 7);
            let normal = Vector3::z();
            let possible = possible_variance(offsets.iter().copied(), &normal).sqrt();
            assert!(possible < 2.0 * along + 1e-9, "{long}, {along}: {possible}");
        }
    }

    #[test]
    fn few_neighbours_or_the_same_place_tell_nothing() {
        let same = [Vector3::x(); LEAST];
        let few: Vec<Vector3> = (1..LEAST).map(|x| Vector3::x() * x as f64).collect();
        for offsets in [&[], &few[..1], &few, &same] {
            let offsets = offsets.iter().copied();
            assert_eq!(possible_variance(offsets.clone(), &Vector3::z()), f64::INFINITY);
            assert_eq!(possible_variance_alone(offsets), f64::INFINITY);
        }
    }
}

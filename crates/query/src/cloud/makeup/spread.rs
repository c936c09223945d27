//! Some of the points of a cloud, from all over it.

use std::sync::OnceLock;

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_noise::{Neighborhoods, spacings_at};

/// Points that spacing, noise and distance are told from, at most.
pub(super) const SAMPLE: usize = 200;
/// Shells of equal steps of the squared distance from the middle.
const SHELLS: usize = 4096;
const LAST_SHELL: u16 = SHELLS as u16 - 1;

/// Some hundred of the points of a cloud, from all over it.
#[derive(Debug)]
pub(in crate::cloud) struct Sample {
    pub indices: Vec<usize>,
    /// Told when first asked for.
    spacings: OnceLock<Vec<f64>>,
}

impl Sample {
    /// The spacing about each of them, m, given the cloud that they are of.
    pub(in crate::cloud) fn spacings(&self, cloud: &Neighborhoods) -> &[f64] {
        self.spacings.get_or_init(|| spacings_at(cloud, self.indices.iter().copied()))
    }
}

/// Some hundred of the points, from all over the cloud.
pub(in crate::cloud) fn sample_of(points: &[Point3]) -> Sample {
    Sample { indices: spread(points, SAMPLE), spacings: OnceLock::new() }
}

/// Some of the points, evenly spread by how far they are from the middle of all: probabilities depend on
/// what is told from them, and keep in whatever order and frame the points come.
pub(super) fn spread(points: &[Point3], count: usize) -> Vec<usize> {
    if points.len() <= count {
        return (0..points.len()).collect();
    }
    let sum: Vector3 = points.iter().map(|p| p.coords).sum();
    let middle = Point3::from(sum / points.len() as f64);
    let squared = |p: &Point3| (p - middle).norm_squared();
    // PERF: counted by shells about the middle, only points of those that hold a rank are put in order.
    let outermost = points.iter().map(squared).fold(0.0, f64::max);
    let shell = |p: &Point3| ((squared(p) / outermost * SHELLS as f64) as u16).min(LAST_SHELL);
    let shells: Vec<u16> = points.iter().map(shell).collect();
    let mut counts = vec![0_usize; SHELLS];
    shells.iter().for_each(|&shell| counts[usize::from(shell)] += 1);
    // The product fits: an index holds at most 2³² points.
    let rank = |k: usize| ((2 * k + 1) as u64 * points.len() as u64 / (2 * count) as u64) as usize;
    let (mut is_wanted, mut ranks) = (vec![false; SHELLS], Vec::with_capacity(count));
    let (mut at, mut end, mut left_out) = (0, counts[0], 0);
    for rank in (0..count).map(rank) {
        while end <= rank {
            left_out += if is_wanted[at] { 0 } else { counts[at] };
            at += 1;
            end += counts[at];
        }
        is_wanted[at] = true;
        ranks.push(rank - left_out);
    }
    let with_place = points.iter().zip(0..).zip(shells);
    let wanted = with_place.filter(|(_, shell)| is_wanted[usize::from(*shell)]);
    let mut by_distance: Vec<(f64, u32)> =
        wanted.map(|((p, place), _)| (squared(p), place)).collect();
    let mut chosen = Vec::with_capacity(count);
    select(&mut by_distance, &ranks, 0, &mut chosen);
    chosen
}

/// The points of these ranks among those of rank `from` on, without sorting what is between.
fn select(slice: &mut [(f64, u32)], ranks: &[usize], from: usize, chosen: &mut Vec<usize>) {
    let middle = ranks.len() / 2;
    let Some(&rank) = ranks.get(middle) else { return };
    let order = |p: &(f64, u32), q: &(f64, u32)| p.0.total_cmp(&q.0);
    let (below, &mut (_, index), above) = slice.select_nth_unstable_by(rank - from, order);
    select(below, &ranks[..middle], from, chosen);
    chosen.push(index as usize);
    select(above, &ranks[middle + 1..], rank + 1, chosen);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn points_chosen_by_shells_are_those_of_the_sorted_cloud(
            coordinates in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 8..2000),
            count in 1..200_usize,
            far in prop::option::of(1.0..1e6_f64),
        ) {
            let mut points: Vec<Point3> = coordinates.into_iter().map(Point3::from).collect();
            // One far off leaves all others in a shell.
            points.extend(far.map(|x| Point3::new(x, 0.0, 0.0)));
            let chosen = spread(&points, count);
            let middle: Vector3 = points.iter().map(|p| p.coords).sum::<Vector3>() / points.len() as f64;
            let squared = |i: &usize| (points[*i].coords - middle).norm_squared();
            let mut sorted: Vec<usize> = (0..points.len()).collect();
            sorted.sort_by(|p, q| squared(p).total_cmp(&squared(q)));
            let rank = |k: usize| (2 * k + 1) * points.len() / (2 * count);
            if points.len() > count {
                let expected: Vec<usize> = (0..count).map(|k| sorted[rank(k)]).collect();
                prop_assert_eq!(chosen, expected);
            } else {
                prop_assert_eq!(chosen, (0..points.len()).collect::<Vec<_>>());
            }
        }
    }
}

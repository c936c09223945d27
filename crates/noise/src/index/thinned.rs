//! A part of a cloud, evenly taken, that stands for it where a fit needs no more.

use std::sync::OnceLock;

use crate::finite::is_finite;
use crate::index::positions::Positions;

/// Some of the positions of a cloud.
#[derive(Debug)]
pub(crate) struct Thinned {
    /// Their indices in the cloud.
    indices: Vec<u32>,
    positions: Positions,
    /// What was told about each of them; nothing where nobody asked.
    told: OnceLock<Box<[OnceLock<f64>]>>,
}

impl Thinned {
    /// Every fourth and every sixteenth position, in order of density: dense places and sparse ones
    /// keep their part, and neither the frame nor the order of the points matters. Each position is in
    /// `densest_first` once.
    pub(crate) fn fourth_and_sixteenth(cloud: &Positions, densest_first: &[u32]) -> Vec<Self> {
        let points = cloud.points();
        let mut order = densest_first.to_vec();
        order.retain(|&index| is_finite(&points[index as usize]));
        [4, 16].into_iter().filter_map(|step| Self::every(step, cloud, &order)).collect()
    }

    fn every(step: usize, cloud: &Positions, order: &[u32]) -> Option<Self> {
        let mut indices: Vec<u32> = order.iter().copied().skip(step - 1).step_by(step).collect();
        indices.sort_unstable();
        let points = indices.iter().map(|&index| cloud.points()[index as usize]).collect();
        // Points that could be indexed before can be again.
        let positions = Positions::on_this_thread(points).ok()?;
        Some(Self { indices, positions, told: OnceLock::new() })
    }

    pub(crate) fn positions(&self) -> &Positions {
        &self.positions
    }

    /// What `tell` says of one of them, given by its index in the cloud; it is asked once, and must always say the
    /// same. Of another point it is asked each time.
    pub(crate) fn told(&self, index: usize, tell: impl FnOnce() -> f64) -> f64 {
        let place = self.indices.binary_search_by_key(&index, |&kept| kept as usize);
        match place {
            Ok(place) => {
                let told =
                    self.told.get_or_init(|| vec![OnceLock::new(); self.indices.len()].into());
                *told[place].get_or_init(tell)
            }
            Err(_) => tell(),
        }
    }

    /// The index in the cloud of one of them.
    pub(crate) fn index(&self, place: usize) -> usize {
        self.indices[place] as usize
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Point3, seed};

    use super::*;
    use crate::index::density::{Density, densest_first};

    /// A grid that is the same everywhere, in some order.
    fn grid(places: impl Iterator<Item = usize>) -> Positions {
        let place = |i: usize| Point3::new((i % 43) as f64 / 64.0, (i / 43) as f64 / 64.0, 0.0);
        Positions::new(places.map(place).collect::<Vec<_>>()).unwrap()
    }

    fn cloud(copies: usize) -> Positions {
        let place = |i: u64| Point3::from([0, 1, 2].map(|k| seed::unit(seed::derive(2, i, k))));
        Positions::new((0..1600).map(place).cycle().take(1600 * copies).collect::<Vec<_>>())
            .unwrap()
    }

    fn places(thinned: &Thinned) -> Vec<Point3> {
        let mut places = thinned.positions().points().to_vec();
        places.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
        places
    }

    fn thin(cloud: &Positions) -> Vec<Thinned> {
        Thinned::fourth_and_sixteenth(
            cloud,
            &densest_first(cloud.points(), &Density::everywhere(cloud)),
        )
    }

    /// A cloud stored twice is the cloud.
    #[test]
    fn copies_do_not_count() {
        let (once, twice) = (cloud(1), cloud(2));
        for (once, twice) in thin(&once).iter().zip(&thin(&twice)) {
            assert_eq!(places(once), places(twice));
        }
        assert_eq!(thin(&once)[0].positions().distinct(), 400);
        assert_eq!(thin(&once)[1].positions().distinct(), 100);
    }

    #[test]
    fn the_same_are_taken_of_points_in_another_order() {
        let points = cloud(1).points().to_vec();
        let reversed = Positions::new(points.iter().rev().copied().collect::<Vec<_>>()).unwrap();
        for (a, b) in thin(&cloud(1)).iter().zip(&thin(&reversed)) {
            assert_eq!(places(a), places(b));
            assert_eq!(a.positions().points()[3], cloud(1).points()[a.index(3)]);
        }
    }

    /// Nearly all places of a grid are as dense as one another: which were kept was told by their numbers, and each
    /// copy counted.
    #[test]
    fn how_a_grid_was_numbered_and_its_copies_decided_what_was_kept_of_it() {
        let all = 0..43 * 43;
        let (backwards, twice) = (all.clone().rev(), all.clone().chain(all.clone()));
        let expected = thin(&grid(all));
        for other in [thin(&grid(backwards)), thin(&grid(twice))] {
            for (one, other) in expected.iter().zip(&other) {
                assert_eq!(places(one), places(other));
            }
        }
    }
}

//! The few smallest distances met so far.

use cloudtouch_geom::Point3;

/// The `count` smallest distances of different points, ascending.
#[derive(Debug)]
pub(super) struct Smallest {
    count: usize,
    kept: Vec<(f64, Point3)>,
}

impl Smallest {
    pub(super) fn new(count: usize) -> Self {
        Self { count, kept: Vec::with_capacity(count + 1) }
    }

    /// Takes a point at a distance; a point at the place of another one is not taken again.
    pub(super) fn take(&mut self, distance: f64, point: Point3) {
        let place = self.kept.partition_point(|(kept, _)| *kept < distance);
        // The same place has the same distance, so its twin can only stand right there.
        let twin = |(kept, other): &(f64, Point3)| *kept == distance && *other == point;
        if place >= self.count || self.kept[place..].iter().any(twin) {
            return;
        }
        self.kept.insert(place, (distance, point));
        self.kept.truncate(self.count);
    }

    /// What a distance must be below to change anything; infinite while there are fewer.
    pub(super) fn bound(&self) -> f64 {
        if self.kept.len() < self.count {
            return f64::INFINITY;
        }
        self.kept.last().map_or(0.0, |(distance, _)| *distance)
    }

    /// The distances, ascending: fewer when fewer different points were met.
    pub(super) fn distances(&self) -> Vec<f64> {
        self.kept.iter().map(|(distance, _)| *distance).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twins_count_once_and_ties_do_not() {
        let at = |x: f64| Point3::new(x, 0.0, 0.0);
        let mut smallest = Smallest::new(3);
        for (distance, x) in [(2.0, 2.0), (1.0, 1.0), (1.0, 1.0), (1.0, -1.0)] {
            assert_eq!(smallest.bound(), f64::INFINITY);
            smallest.take(distance, at(x));
        }
        assert_eq!(smallest.distances(), [1.0, 1.0, 2.0]);
        smallest.take(0.5, at(0.5));
        smallest.take(3.0, at(3.0));
        assert_eq!(smallest.distances(), [0.5, 1.0, 1.0]);
        assert_eq!(smallest.bound(), 1.0);
    }
}

//! The room between two parallel planes.

use cloudtouch_geom::{Motion, Point3, Vector3};

use super::surfel::Surfel;

/// Between which heights along a direction all discs of a leaf lie, or all its edges, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Slab {
    pub direction: Vector3,
    low: f64,
    high: f64,
}

impl Slab {
    pub(super) fn around_discs(surfels: &[Surfel], direction: Vector3) -> Self {
        let mut slab = Self::empty(direction);
        for surfel in surfels {
            if let Some(reach) = surfel.disc_reach(&slab.direction) {
                slab.include(&surfel.point.mean, reach);
            }
        }
        slab
    }

    /// Around nothing.
    pub(super) fn empty(direction: Vector3) -> Self {
        Self { direction, low: f64::INFINITY, high: f64::NEG_INFINITY }
    }

    /// Grows to what reaches so far (m) from the height of a place.
    pub(super) fn include(&mut self, place: &Point3, reach: f64) {
        let height = place.coords.dot(&self.direction);
        self.low = self.low.min(height - reach);
        self.high = self.high.max(height + reach);
    }

    /// The same room in another frame.
    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        let direction = motion.vector(&self.direction);
        let by = direction.dot(&motion.point(&Point3::origin()).coords);
        Self { direction, low: self.low + by, high: self.high + by }
    }

    /// The same room in the frame that was moved.
    pub(crate) fn moved_back(&self, motion: &Motion) -> Self {
        let by = self.direction.dot(&motion.point(&Point3::origin()).coords);
        let direction = motion.vector_back(&self.direction);
        Self { direction, low: self.low - by, high: self.high - by }
    }

    /// Whether it holds a place of the disc about a surfel.
    pub(crate) fn may_hold_disc_of(&self, surfel: &Surfel) -> bool {
        let off = self.distance(&surfel.point.mean);
        // PERF: most are within it, or farther than any disc reaches.
        off <= surfel.most_disc_reach()
            && surfel.disc_reach(&self.direction).is_some_and(|reach| off <= reach)
    }

    /// How far a place is from it, m; 0 within.
    pub(crate) fn distance(&self, place: &Point3) -> f64 {
        let height = place.coords.dot(&self.direction);
        let (above, below) = (height - self.high, self.low - height);
        // PERF: comparisons are fewer instructions than `max`, which knows NaN.
        let off = if above > below { above } else { below };
        if off > 0.0 { off } else { 0.0 }
    }

    /// Whether a place is at most so far from the height of some disc.
    pub(crate) fn is_within(&self, place: &Point3, distance: f64) -> bool {
        self.distance(place) <= distance
    }

    /// Whether a place is below all discs, and whether it is above them.
    pub(crate) fn is_left_by(&self, place: &Point3) -> [bool; 2] {
        let height = place.coords.dot(&self.direction);
        [height < self.low, height > self.high]
    }

    /// Whether some place between two ends may be so near to the height of a disc, m.
    pub(crate) fn may_hold(&self, [from, to]: [&Point3; 2], distance: f64) -> bool {
        let (from, to) = (from.coords.dot(&self.direction), to.coords.dot(&self.direction));
        let (lower, upper) = if from < to { (from, to) } else { (to, from) };
        upper + distance >= self.low && lower - distance <= self.high
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::Pose;

    use super::*;

    #[test]
    fn a_slab_holds_in_any_frame_what_it_held() {
        let pose = Pose::from_translation_rpy(Vector3::new(5.0, -2.0, 1.0), [0.3, -1.1, 2.0]);
        let motion = Motion::from(&pose);
        let mut slab = Slab::empty(Vector3::new(0.6, 0.0, 0.8));
        slab.include(&Point3::new(0.1, 0.2, 0.3), 0.05);
        let heights = [-0.051, -0.049, 0.049, 0.051];
        let places = heights.map(|h| Point3::new(0.1, 0.2, 0.3) + slab.direction * h);
        let expected = [false, true, true, false];
        assert_eq!(places.map(|p| slab.is_within(&p, 0.0)), expected);
        let moved = slab.moved(&motion);
        assert_eq!(places.map(|p| moved.is_within(&motion.point(&p), 0.0)), expected);
        let back = moved.moved_back(&motion);
        assert_eq!(places.map(|p| back.is_within(&p, 0.0)), expected);
    }
}

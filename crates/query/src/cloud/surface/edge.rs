//! Edges between neighbouring samples: they stand for the surface between them.

use cloudtouch_geom::{Motion, Point3, Vector3};

/// Edges join samples up to this many of the smaller of their spacings apart.
pub(crate) const EDGE_SPACINGS: f64 = 2.2;
/// The disc about a sample stands for the surface up to so many spacings from it; no edge reaches
/// farther from its own end to its middle.
pub(crate) const DISC_SPACINGS: f64 = 1.1;
/// Edges run along the surface: the sine of their angle to it is at most this.
pub(crate) const EDGE_SLOPE: f64 = 0.5;

/// A tilt smaller than this is rounding.
const ROUNDING: f64 = 1e-6;

/// What [`sine`] is at most.
pub(super) const MOST_SINE: f64 = 1.0 + 2.0 * ROUNDING;

/// |sin| of the angle between two unit vectors, never too little by rounding.
pub(super) fn sine(one: &Vector3, other: &Vector3) -> f64 {
    (1.0 - one.dot(other).powi(2)).max(0.0).sqrt() + ROUNDING
}

/// What [`edge_along`] is at most: the root of 1 + [`EDGE_SLOPE`]², rounded up.
pub(crate) const MOST_ALONG: f64 = 1.12;

/// The most that an edge at a piece with this normal reaches along a unit vector, as a share of its length.
pub(crate) fn edge_along(normal: &Vector3, along: &Vector3) -> f64 {
    EDGE_SLOPE.mul_add(normal.dot(along).abs(), sine(normal, along))
}

/// A sample that edges end at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EdgeEnd {
    /// Where it is, in the cloud's local frame.
    pub place: Point3,
    /// Variance of that across the surface, m².
    pub across: f64,
    /// Which piece of the cloud it is.
    pub piece: u32,
}

/// A straight piece of surface between two neighbours of one cloud.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Edge {
    /// Where it starts and ends.
    pub ends: [Point3; 2],
    /// Half its length, m.
    pub half_length: f64,
    /// Which pieces of the cloud these are.
    pub points: [u32; 2],
    /// Variances of the ends across the surface, m².
    pub across: [f64; 2],
    /// The places in the leaf of the points it joins; `None` for a point of another leaf.
    pub own: [Option<usize>; 2],
}

impl Edge {
    /// Between two ends that have these places in the leaf.
    pub(super) fn between([from, to]: [&EdgeEnd; 2], own: [Option<usize>; 2]) -> Self {
        Self {
            ends: [from.place, to.place],
            half_length: 0.5 * (to.place - from.place).norm(),
            points: [from.piece, to.piece],
            across: [from.across, to.across],
            own,
        }
    }

    /// Halfway between its ends.
    pub(crate) fn middle(&self) -> Point3 {
        nalgebra::center(&self.ends[0], &self.ends[1])
    }

    /// The same edge in another frame.
    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        // PERF: written out, for `map` over arrays is not inlined where thousands are moved.
        let [from, to] = &self.ends;
        Self { ends: [motion.point(from), motion.point(to)], ..*self }
    }

    /// The points of its leaf that it joins, by their places in it.
    pub(crate) fn own_places(&self) -> impl Iterator<Item = usize> {
        self.own.into_iter().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_edge_reaches_farther_along_any_direction_than_stated() {
        let at = |k: i32| 1e-4 * f64::from(k) * std::f64::consts::TAU;
        let along = |k| edge_along(&Vector3::z(), &Vector3::new(at(k).sin(), 0.0, at(k).cos()));
        let most = (0..10_000).map(along).fold(0.0, f64::max);
        assert!(most <= MOST_ALONG && most > MOST_ALONG - 0.01, "{most}");
    }
}

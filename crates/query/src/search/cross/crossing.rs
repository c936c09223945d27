//! Evidence that two surfaces cross between their samples, where a curved surface could still
//! separate the samples themselves.
//!
//! An edge joins two neighbouring samples of one cloud; it stands for the surface between them. A
//! disc about a sample of the other cloud, across its normal, stands for the surface around it. An
//! edge whose ends, or what lies past them, are clearly on two sides of a disc, and that passes close
//! to its middle, crosses it; so does one through a triangle, and a mesh through a disc.

use cloudtouch_geom::{Point3, Vector3, normal};

use crate::cloud::{DISC_SPACINGS, Edge, Onward, Surfel};

use super::side::{CLEAREST, clearness, known_past_to, known_to, less_clear, past};
use super::through_mesh::Through;
use crate::search::compare::facet::Facet;
use crate::search::wrench::{Height, Wrench, force_at};

/// The weight of a disc falls off like a normal density with this many spacings.
const WEIGHT_SPACINGS: f64 = 0.5;
/// A place where a piece of one surface passes through a piece of the other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Crossing {
    /// How clearly, in standard deviations: that of the less clear side.
    pub clear: f64,
    /// How near the middle of the disc it passes, from 1 to 0.
    pub weight: f64,
    /// The same as a probability: both ends on their sides, times the weight.
    pub probability: f64,
    /// Where.
    pub place: Point3,
    /// Unit normal of the surface that is passed, of either sign.
    pub axis: Vector3,
    /// How far the end that is nearer to that surface has come through, m, and its standard
    /// deviation.
    pub depth: f64,
    pub std: f64,
    /// Distance between samples there, m.
    pub spacing: f64,
    /// What these change by as the pose does.
    pub by_pose: CrossingByPose,
}

/// What a crossing changes by as what passes moves and what it passes keeps, or with the pose of B.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CrossingByPose {
    pub clear: Wrench,
    pub weight: Wrench,
    pub depth: Wrench,
}

impl Crossing {
    /// Of two ends at these heights, of unequal sign, known so well, with this weight; `onward` is how clear
    /// the surface is past either.
    fn of(
        (heights, stds): ([Height; 2], [f64; 2]),
        onward: impl Fn(usize) -> Option<Height>,
        weight: Height,
        spacing: f64,
    ) -> Self {
        let size = heights.map(|height| height.value.abs());
        let of_end = |k: usize| clearness(&heights[k], known_to(stds[k], spacing));
        let clear = less_clear([of_end(0), of_end(1)], onward);
        let nearer = usize::from(size[1] < size[0]);
        // Twice the excess over one half: none on the surface, certain far from it.
        let sure = |k: usize| 1.0 - 2.0 * normal::below_zero(size[k], stds[k]);
        let grows = |k: usize| heights[k].by_pose * heights[k].value.signum();
        let by_pose = CrossingByPose {
            clear: if clear.value < CLEAREST { clear.by_pose } else { Wrench::zeros() },
            weight: weight.by_pose,
            depth: grows(nearer),
        };
        Self {
            clear: clear.value.min(CLEAREST),
            weight: weight.value,
            probability: sure(0) * sure(1) * weight.value,
            place: Point3::origin(),
            axis: Vector3::z(),
            depth: size[nearer],
            std: stds[nearer],
            spacing,
            by_pose,
        }
    }

    /// The same where what is passed is what moves.
    pub(super) fn reversed(self) -> Self {
        let CrossingByPose { clear, weight, depth } = self.by_pose;
        Self { by_pose: CrossingByPose { clear: -clear, weight: -weight, depth: -depth }, ..self }
    }
}

/// What a mesh does to the disc about a sample.
pub(super) fn of_mesh(disc: &Surfel, axis: Vector3, through: &Through) -> Crossing {
    let std = disc.across.sqrt();
    let weight = weight_by_pose(&through.off, disc.spacing);
    let heights = [through.above, through.below];
    let of_pair = Crossing::of((heights, [std; 2]), |_| None, weight, disc.spacing);
    Crossing { place: through.place, axis, ..of_pair }
}

pub(in crate::search) fn weight_at(spacings_off: f64) -> f64 {
    (-0.5 * (spacings_off / WEIGHT_SPACINGS).powi(2)).exp()
}

/// The same with what it changes by, so far off the middle.
fn weight_by_pose(off: &Height, spacing: f64) -> Height {
    let value = weight_at(off.value / spacing);
    let slope = -value * off.value / (WEIGHT_SPACINGS * spacing).powi(2);
    Height { value, by_pose: off.by_pose * slope }
}

/// Whether an edge of a leaf crosses a disc; `None` too where the end nearer to the disc's plane is
/// not a point of that leaf: the other leaf has the same edge and counts it.
/// `onward` tells where the surface goes on past either end.
pub(in crate::search) fn through_disc(
    edge: &Edge,
    disc: &Surfel,
    onward: impl Fn(usize) -> Onward,
) -> Option<Crossing> {
    let axis = disc.normal?;
    let middle = disc.point.mean;
    let heights = edge.ends.map(|end| (end - middle).dot(&axis));
    let [above, below] = heights;
    if above * below >= 0.0 {
        return None;
    }
    edge.own[nearer_end(edge, heights)]?;
    let share = above / (above - below);
    let place = edge.ends[0] + (edge.ends[1] - edge.ends[0]) * share;
    let aside = place - middle;
    let off = aside.norm();
    if off.is_nan() || off > DISC_SPACINGS * disc.spacing {
        return None;
    }
    let of_disc = disc.across;
    let stds = edge.across.map(|across| (across + of_disc).sqrt());
    // Where the edge passes moves with it, and along it back into the plane of the disc.
    let away = aside.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
    let along = edge.ends[1] - edge.ends[0];
    let force = away - axis * (away.dot(&along) / axis.dot(&along));
    let off = Height { value: off, by_pose: force_at(&place, &force) };
    let past_end = |k: usize| {
        let Onward { place, across } = onward(k);
        let known = known_past_to((across + of_disc).sqrt(), disc.spacing);
        past(heights[k], height_of(&place, &middle, &axis), known)
    };
    let ends = [0, 1].map(|k| height_of(&edge.ends[k], &middle, &axis));
    let weight = weight_by_pose(&off, disc.spacing);
    let of_pair = Crossing::of((ends, stds), past_end, weight, disc.spacing);
    Some(Crossing { place, axis, ..of_pair })
}

/// The same for a triangle.
pub(super) fn through_facet(
    edge: &Edge,
    facet: &Facet,
    onward: impl Fn(usize) -> Onward,
) -> Option<Crossing> {
    let axis = facet.normal?;
    let pierced = facet.pierced_by(&edge.ends)?;
    edge.own[nearer_end(edge, pierced.heights)]?;
    let stds = edge.across.map(f64::sqrt);
    let spacing = 2.0 * edge.half_length;
    let past_end = |k: usize| {
        let Onward { place, across } = onward(k);
        let height = height_of(&place, &pierced.place, &axis);
        past(pierced.heights[k], height, known_to(across.sqrt(), spacing))
    };
    let ends = [0, 1].map(|k| height_of(&edge.ends[k], &pierced.place, &axis));
    let full = Height { value: 1.0, by_pose: Wrench::zeros() };
    let of_pair = Crossing::of((ends, stds), past_end, full, spacing);
    Some(Crossing { place: pierced.place, axis, ..of_pair })
}

/// Of a place above a plane.
fn height_of(place: &Point3, on_plane: &Point3, axis: &Vector3) -> Height {
    Height { value: (place - on_plane).dot(axis), by_pose: force_at(place, axis) }
}

/// The end with the smaller height; between equals the one that comes first in space, so that both
/// leaves of an edge say the same.
fn nearer_end(edge: &Edge, heights: [f64; 2]) -> usize {
    let key = |k: usize| {
        let end = edge.ends[k];
        (heights[k].abs(), end.x, end.y, end.z)
    };
    usize::from(key(1) < key(0))
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, UncertainPoint};
    use cloudtouch_noise::Refined;

    use super::*;

    fn disc(std: f64) -> Surfel {
        let axis = Vector3::z_axis();
        let covariance = Covariance::from_axis(&axis, std, 0.35);
        let point = UncertainPoint { mean: Point3::origin(), covariance };
        Surfel::new(0, &Refined { point, spacing: 1.0, normal: Some(axis), shared: 0.0 })
    }

    fn upright(x: f64, low: f64, high: f64) -> Edge {
        Edge {
            ends: [Point3::new(x, 0.0, low), Point3::new(x, 0.0, high)],
            half_length: 0.5 * (high - low),
            points: [0, 1],
            across: [0.0; 2],
            own: [Some(0), None],
        }
    }

    /// Where the surface goes on by so much past either end.
    fn through(edge: &Edge, disc: &Surfel, onward: [f64; 2]) -> Option<Crossing> {
        let past = |k: usize| edge.ends[k] + Vector3::z() * onward[k];
        through_disc(edge, disc, |k| Onward { place: past(k), across: edge.across[k] })
    }

    fn at_ends(edge: &Edge, disc: &Surfel) -> Option<Crossing> {
        through(edge, disc, [0.0; 2])
    }

    #[test]
    fn what_lies_past_an_end_tells_where_noise_hides_the_end() {
        let edge = upright(0.0, -0.2, 0.5);
        let clear = |std, onward| through(&edge, &disc(std), onward).unwrap().clear;
        let ends = clear(0.5, [0.0; 2]);
        // The end below is the less clear; then the one above is.
        assert!(clear(0.5, [-0.2, 0.0]) > 1.2 * ends && clear(0.5, [0.0, 0.8]) == ends);
        assert!(clear(0.5, [-2.0, 0.8]) > 1.2 * clear(0.5, [-2.0, 0.0]));
        // On the other side, or where nothing is hidden, it says nothing.
        assert_eq!(clear(0.5, [2.0, 0.0]), ends);
        assert_eq!(clear(0.01, [-0.2, 0.0]), clear(0.01, [0.0; 2]));
        // How deep it is is told by the ends alone.
        let depth = |onward| through(&edge, &disc(0.5), onward).unwrap().depth;
        assert_eq!(depth([-2.0, 0.8]), depth([0.0; 2]));
    }

    #[test]
    fn an_edge_through_the_middle_crosses_as_clearly_as_its_nearer_end() {
        let found = at_ends(&upright(0.0, -0.2, 0.5), &disc(0.1)).unwrap();
        // Known to 0.1 and to a quarter of a spacing, together.
        assert!((found.clear - 0.2 / 0.1_f64.hypot(0.25)).abs() < 1e-12, "{found:?}");
        assert!((found.depth - 0.2).abs() < 1e-12 && found.place == Point3::origin());
        // One spacing off the middle: two standard deviations of the weight.
        let aside = at_ends(&upright(1.0, -0.2, 0.5), &disc(0.1)).unwrap();
        assert!((aside.weight - (-2.0_f64).exp()).abs() < 1e-12);
        assert!(at_ends(&upright(1.6, -0.2, 0.5), &disc(0.1)).is_none());
    }

    #[test]
    fn an_edge_on_one_side_does_not_cross() {
        assert!(at_ends(&upright(0.0, 0.001, 0.5), &disc(0.1)).is_none());
        let mut unknown = disc(0.1);
        unknown.normal = None;
        assert!(at_ends(&upright(0.0, -0.2, 0.5), &unknown).is_none());
    }

    #[test]
    fn noise_larger_than_the_crossing_says_little() {
        let found = at_ends(&upright(0.0, -0.2, 0.5), &disc(30.0)).unwrap();
        assert!(found.clear < 0.01 && found.probability < 0.001, "{found:?}");
    }

    #[test]
    fn of_the_two_leaves_of_an_edge_one_counts_a_crossing() {
        for (low, high) in [(-0.2, 0.5), (-0.5, 0.2), (-0.3, 0.3)] {
            let here = upright(0.0, low, high);
            let there = Edge { ends: [here.ends[1], here.ends[0]], ..here };
            let counted = [here, there].iter().filter_map(|e| at_ends(e, &disc(0.1))).count();
            assert_eq!(counted, 1, "{low} {high}");
        }
    }
}

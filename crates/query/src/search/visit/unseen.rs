//! Leaves of clouds whose surface is not known: what it may be, by what was measured.
//!
//! What a tree knows of such a leaf is loose, for it holds wherever its surface faces and however wide its
//! discs are, and most leaves that it brings together have nothing to do with one another. The pieces of one
//! of them, once they are known, tell that of most others by the box about what was measured there, which
//! spares these their fits.

use cloudtouch_bvh::{NodeId, SurfacePair};
use cloudtouch_geom::{Matrix3, Point3, Vector3};

use crate::body::BodyRef;
use crate::cloud::{DISC_SPACINGS, EDGE_SLOPE, Surfel};
use crate::search::compare::facet::Facet;

use super::leaf::Leaf;
use super::leaves::Leaves;
use super::side::Side;

/// Rounding of distances, relative, generously.
const ROUNDING: f64 = 1e-9;

/// A leaf in the frame of A, before its surface is known.
#[derive(Debug)]
struct Unseen {
    /// The box about what was measured.
    centre: Point3,
    axes: Matrix3,
    half_extents: Vector3,
    /// How far the surface is from that at most, and how far discs and the near halves of edges reach from
    /// there, m.
    room: [f64; 2],
    /// The largest standard deviation of a piece, m.
    std: f64,
}

/// How far something is from an unseen leaf at least.
#[derive(Debug, Clone, Copy)]
pub(in crate::search) struct Parted {
    /// What discs and edges of both stand for, m.
    pub surfaces: f64,
    /// Pieces, m, and their standard deviations, m, in one direction and another.
    gaps: [(f64, f64); 2],
}

impl Parted {
    /// How many deviations pieces are from being within a margin (m) of each other at least; none where they
    /// may be.
    pub(in crate::search) fn deviations_beyond(&self, margin: f64) -> f64 {
        let beyond = |(gap, known): &(f64, f64)| {
            let beyond = gap - margin;
            if beyond > 0.0 { beyond / known } else { 0.0 }
        };
        self.gaps.iter().map(beyond).fold(0.0, f64::max)
    }
}

/// How far apart the surfaces of two leaves are, m, where one of them tells that the other, which is not among those
/// seen, is apart from all of it. `are_loose`: whether what is not seen may be known loosely.
pub(in crate::search) fn told_apart<'a>(
    (a, b): (BodyRef<'a>, BodyRef<'a>),
    pair: &SurfacePair,
    are_loose: [bool; 2],
    (leaves_a, leaves_b): (&mut Leaves<Leaf<'a>>, &mut Leaves<Leaf<'a>>),
    [side_a, side_b]: &mut [Side; 2],
    mut load: impl FnMut(BodyRef<'a>, NodeId, &mut Side) -> Leaf<'a>,
    is_apart: impl Fn(&Parted) -> bool,
) -> Option<f64> {
    let is_unseen = [are_loose[0] && !leaves_a.has(pair.a), are_loose[1] && !leaves_b.has(pair.b)];
    let unseen_a = is_unseen[0].then(|| Unseen::of(a, pair.a, side_a)).flatten();
    let unseen_b = is_unseen[1].then(|| Unseen::of(b, pair.b, side_b)).flatten();
    // The coarser tells more of the other.
    let is_b_first = match (&unseen_a, &unseen_b) {
        (None, None) => return None,
        (Some(a), Some(b)) => b.reach() > a.reach(),
        (unseen_a, _) => unseen_a.is_some(),
    };
    if is_b_first {
        let leaf_b = leaves_b.get_or_load(pair.b, || load(b, pair.b, side_b));
        unseen_a?.apart_from(leaf_b, is_apart)
    } else {
        let leaf_a = leaves_a.get_or_load(pair.a, || load(a, pair.a, side_a));
        unseen_b?.apart_from(leaf_a, is_apart)
    }
}

impl Unseen {
    /// A leaf, moved to the frame of A; none of a mesh.
    fn of(body: BodyRef<'_>, id: NodeId, side: &Side) -> Option<Self> {
        let BodyRef::Cloud(cloud) = body else { return None };
        let node = cloud.tree().leaf(id)?;
        let obb = node.obb();
        let (centre, axes) = match &side.motion {
            None => (obb.centre, obb.axes),
            Some(motion) => (motion.point(&obb.centre), motion.rotation() * obb.axes),
        };
        let room = [node.shift(), node.reach()];
        Some(Self { centre, axes, half_extents: obb.half_extents, room, std: node.max_std() })
    }

    /// How far its surface may reach, m.
    fn reach(&self) -> f64 {
        self.room[1]
    }

    /// How far it is from the surface of a leaf that is known, m, where it is told to be apart from each piece
    /// of that: else `None`.
    fn apart_from(&self, leaf: &Leaf<'_>, is_apart: impl Fn(&Parted) -> bool) -> Option<f64> {
        let mut least = f64::INFINITY;
        let mut is_apart = |parted: Parted| {
            least = least.min(parted.surfaces);
            is_apart(&parted)
        };
        let are_apart = match leaf {
            Leaf::Noisy(leaf) => {
                leaf.surfels.iter().all(|surfel| is_apart(self.parted_from_piece(surfel)))
            }
            Leaf::Exact(leaf) => {
                leaf.facets.iter().all(|facet| is_apart(self.parted_from_facet(facet)))
            }
        };
        are_apart.then_some(least)
    }

    /// From a piece: whatever its edges are, the half that is counted at it is no longer than its disc is wide,
    /// and runs along the surface.
    fn parted_from_piece(&self, surfel: &Surfel) -> Parted {
        let [shift, reach] = self.room;
        let offset = self.centre - surfel.point.mean;
        let beyond = self.axes.tr_mul(&offset).abs() - self.half_extents;
        let slack = ROUNDING * (offset.norm() + self.half_extents.norm());
        let around = beyond.map(|v| v.max(0.0)).norm() - shift - slack;
        let known = (surfel.most_variance + self.std * self.std).sqrt();
        let disc = DISC_SPACINGS * surfel.spacing;
        let Some(normal) = surfel.normal else {
            // It has neither disc nor edges.
            return Parted { surfaces: around - reach, gaps: [(around, known); 2] };
        };
        let along = offset.dot(&normal).abs() - self.half_width(&normal) - shift - slack;
        let known_along = (surfel.across + self.std * self.std).sqrt();
        Parted {
            surfaces: (around - disc).max(along - EDGE_SLOPE * disc) - reach,
            gaps: [(around, known), (along, known_along)],
        }
    }

    fn parted_from_facet(&self, facet: &Facet) -> Parted {
        let [shift, reach] = self.room;
        let way = facet.way_from(&self.centre);
        let slack = ROUNDING * (way.norm() + self.half_extents.norm());
        let toward = way.try_normalize(0.0).map_or(0.0, |n| way.norm() - self.half_width(&n));
        let height = |n: &Vector3| facet.height(&self.centre).abs() - self.half_width(n);
        let apart = toward.max(facet.normal.as_ref().map_or(0.0, height)) - shift - slack;
        Parted { surfaces: apart - reach, gaps: [(apart, self.std); 2] }
    }

    /// Half its width along a unit vector, m.
    fn half_width(&self, n: &Vector3) -> f64 {
        self.axes.tr_mul(n).abs().dot(&self.half_extents)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, UncertainPoint, UnitVector3};
    use nalgebra::Rotation3;
    use proptest::prelude::*;

    use super::*;
    use crate::cloud::End;
    use crate::search::compare::meeting::squared_deviations;
    use crate::search::compare::whitening::Whitening;

    fn vector(of: [f64; 3]) -> Vector3 {
        Vector3::from(of)
    }

    fn unit() -> impl Strategy<Value = Vector3> {
        prop::array::uniform3(-1.0..1.0_f64)
            .prop_filter_map("a direction", |v| vector(v).try_normalize(1e-3))
    }

    /// A box of some centimetres about the origin.
    fn unseen() -> impl Strategy<Value = Unseen> {
        let angles = prop::array::uniform3(-3.0..3.0_f64);
        let sizes = prop::array::uniform3(0.001..0.03_f64);
        (angles, sizes, [0.0..0.01_f64, 0.001..0.02], 0.001..0.01_f64).prop_map(
            |([roll, pitch, yaw], sizes, room, std)| Unseen {
                centre: Point3::origin(),
                axes: Rotation3::from_euler_angles(roll, pitch, yaw).into_inner(),
                half_extents: vector(sizes),
                room,
                std,
            },
        )
    }

    /// Where in the box a point was measured, in half its sides; which way its surface is from there; which way
    /// that reaches.
    type Draw = ([f64; 3], Vector3, Vector3);

    fn draws() -> impl Strategy<Value = Vec<Draw>> {
        let one = (prop::array::uniform3(prop::sample::select(vec![-1.0, 1.0])), unit(), unit());
        prop::collection::vec(one, 60)
    }

    /// A piece of the unseen leaf, as far off as it may be, and a place of its surface.
    fn drawn(unseen: &Unseen, (corner, off, reach): Draw) -> (Surfel, Point3) {
        let measured = unseen.axes * vector(corner).component_mul(&unseen.half_extents);
        let mean = unseen.centre + measured + unseen.room[0] * off;
        let covariance = Covariance::isotropic(unseen.std.powi(2));
        let surfel = surfel(UncertainPoint { mean, covariance }, unseen.room[1], None, unseen.std);
        (surfel, mean + unseen.room[1] * reach)
    }

    fn surfel(point: UncertainPoint, spacing: f64, normal: Option<Vector3>, across: f64) -> Surfel {
        let (end, across) = (End::Nowhere, across * across);
        let most_variance = point.covariance.max_std().powi(2);
        Surfel { index: 0, point, end, spacing, most_variance, across, normal, shared: 0.0 }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn no_piece_of_an_unseen_leaf_is_nearer_to_another(
            unseen in unseen(),
            (way, distance) in (unit(), 0.01..0.15_f64),
            (normal, spacing) in (unit(), 0.001..0.02_f64),
            stds in [0.0002..0.005_f64, 0.001..0.01],
            along in prop::array::uniform2(-1.0..1.0_f64),
            draws in draws(),
        ) {
            let mean = Point3::from(distance * way);
            let [across, wide] = stds;
            let normal = UnitVector3::new_unchecked(normal);
            let point = UncertainPoint { mean, covariance: Covariance::from_axis(&normal, across, wide) };
            let piece = surfel(point, spacing, Some(*normal), across);
            let parted = unseen.parted_from_piece(&piece);
            let (surfaces, deviations) = (parted.surfaces, parted.deviations_beyond(0.0));
            // The end of half an edge that rises as steeply as any, or lies in the disc.
            let aside = normal.cross(&way).try_normalize(1e-6).unwrap_or_else(|| normal.cross(&Vector3::x()));
            let other = normal.cross(&aside);
            let flat = (along[0] * aside + along[1] * other).try_normalize(1e-6).unwrap_or(aside);
            let steep = EDGE_SLOPE.mul_add(-EDGE_SLOPE, 1.0).sqrt() * flat - EDGE_SLOPE * *normal * normal.dot(&way).signum();
            let ends = [flat, steep].map(|along| mean + DISC_SPACINGS * spacing * along);
            for draw in draws {
                let (inside, place) = drawn(&unseen, draw);
                let squared = squared_deviations(&piece, &inside, f64::INFINITY).unwrap();
                prop_assert!(squared.sqrt() >= deviations * (1.0 - 1e-9), "{} and {deviations}", squared.sqrt());
                for end in ends {
                    let gap = (end - place).norm();
                    prop_assert!(gap >= surfaces - 1e-9, "{gap} and {surfaces}");
                }
            }
        }

        #[test]
        fn no_piece_of_an_unseen_leaf_is_nearer_to_a_facet(
            unseen in unseen(),
            corners in prop::array::uniform3(prop::array::uniform3(-0.1..0.1_f64)),
            draws in draws(),
        ) {
            let facet = Facet::new(0, corners.map(Point3::from));
            let parted = unseen.parted_from_facet(&facet);
            let (surfaces, deviations) = (parted.surfaces, parted.deviations_beyond(0.0));
            for draw in draws {
                let (inside, place) = drawn(&unseen, draw);
                let whitening = Whitening::of(&inside);
                let found = facet.squared_deviations(&inside, &whitening, f64::INFINITY).unwrap();
                prop_assert!(found.0.sqrt() >= deviations * (1.0 - 1e-9));
                prop_assert!(facet.way_from(&place).norm() >= surfaces - 1e-9);
            }
        }
    }
}

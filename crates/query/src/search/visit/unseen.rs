//! Leaves of clouds whose surface is not known: what it may be, by what was measured.
//!
//! What a tree knows of such a leaf is loose, for it holds wherever its surface faces and however wide its
//! discs are, and most leaves that it brings together have nothing to do with one another. The pieces of one
//! of them, once they are known, tell that of most others by the box about what was measured there, which
//! spares these their fits.

use cloudtouch_bvh::NodeId;
use cloudtouch_geom::{Matrix3, Motion, Point3, Vector3};

use crate::body::BodyRef;
use crate::cloud::{DISC_SPACINGS, EDGE_SLOPE, Surfel};
use crate::search::compare::facet::Facet;

use super::leaf::Leaf;

/// Rounding of distances, relative, generously.
const ROUNDING: f64 = 1e-9;

/// A leaf in the frame of A, before its surface is known.
#[derive(Debug)]
pub(in crate::search) struct Unseen {
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
struct Parted {
    /// What discs and edges of both stand for, m.
    surfaces: f64,
    deviations: f64,
}

impl Unseen {
    /// A leaf, moved to the frame of A by `motion`, or of A itself; none of a mesh.
    pub(in crate::search) fn of(
        body: BodyRef<'_>,
        id: NodeId,
        motion: Option<&Motion>,
    ) -> Option<Self> {
        let BodyRef::Cloud(cloud) = body else { return None };
        let node = cloud.tree().leaf(id)?;
        let obb = node.obb();
        let (centre, axes) = match motion {
            None => (obb.centre, obb.axes),
            Some(motion) => (motion.point(&obb.centre), motion.rotation() * obb.axes),
        };
        let room = [node.shift(), node.reach()];
        Some(Self { centre, axes, half_extents: obb.half_extents, room, std: node.max_std() })
    }

    /// How far its surface may reach, m: the sooner it is looked at itself, the more it tells of others.
    pub(in crate::search) fn reach(&self) -> f64 {
        self.room[1]
    }

    /// How far it is from the surface of a leaf that is known, m, where no piece of the one has fewer than so
    /// many deviations to a piece of the other, nor crosses one: else `None`.
    pub(in crate::search) fn apart_from(&self, leaf: &Leaf<'_>, deviations: f64) -> Option<f64> {
        let mut least = f64::INFINITY;
        let mut is_apart = |parted: Parted| {
            least = least.min(parted.surfaces);
            parted.surfaces > 0.0 && parted.deviations >= deviations
        };
        let are_apart = match leaf {
            Leaf::Noisy(leaf) => {
                leaf.surfels.iter().all(|surfel| is_apart(self.from_piece(surfel)))
            }
            Leaf::Exact(leaf) => leaf.facets.iter().all(|facet| is_apart(self.from_facet(facet))),
        };
        are_apart.then_some(least)
    }

    /// From a piece: whatever its edges are, the half that is counted at it is no longer than its disc is wide,
    /// and runs along the surface.
    fn from_piece(&self, surfel: &Surfel) -> Parted {
        let [shift, reach] = self.room;
        let offset = self.centre - surfel.point.mean;
        let beyond = self.axes.tr_mul(&offset).abs() - self.half_extents;
        let slack = ROUNDING * (offset.norm() + self.half_extents.norm());
        let around = beyond.map(|v| v.max(0.0)).norm() - shift - slack;
        let known = (surfel.most_variance + self.std * self.std).sqrt();
        let disc = DISC_SPACINGS * surfel.spacing;
        let Some(normal) = surfel.normal else {
            // It has neither disc nor edges.
            return Parted { surfaces: around - reach, deviations: around / known };
        };
        let along = offset.dot(&normal).abs() - self.half_width(&normal) - shift - slack;
        let known_along = (surfel.across + self.std * self.std).sqrt();
        Parted {
            surfaces: (around - disc).max(along - EDGE_SLOPE * disc) - reach,
            deviations: (around / known).max(along / known_along),
        }
    }

    fn from_facet(&self, facet: &Facet) -> Parted {
        let [shift, reach] = self.room;
        let way = facet.way_from(&self.centre);
        let slack = ROUNDING * (way.norm() + self.half_extents.norm());
        let toward = way.try_normalize(0.0).map_or(0.0, |n| way.norm() - self.half_width(&n));
        let height = |n: &Vector3| facet.height(&self.centre).abs() - self.half_width(n);
        let apart = toward.max(facet.normal.as_ref().map_or(0.0, height)) - shift - slack;
        Parted { surfaces: apart - reach, deviations: apart / self.std }
    }

    /// Half its width along a unit vector, m.
    fn half_width(&self, n: &Vector3) -> f64 {
        self.axes.tr_mul(n).abs().dot(&self.half_extents)
    }
}

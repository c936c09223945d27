//! Over how much surface two bodies are about as near as where they are nearest.

use cloudtouch_geom::{Pose, UncertainPoint, normal};

use crate::body::BodyRef;
use crate::mesh::Mesh;

use super::compare::meeting::{deviations_by_pose, squared_deviations};
use super::compare::whitening::Whitening;
use super::run::Found;
use super::visit::leaf::{Leaf, NoisyLeaf};
use super::visit::leaves::Leaves;
use super::wrench::Wrench;

/// A piece counts in full up to this share of the deviations that are looked at beyond the least.
const FULL: f64 = 0.6;

/// The pieces of surface of one body that are looked at, and the other body.
struct Facing<'f, 'a> {
    own: &'f Leaves<Leaf<'a>>,
    others: &'f Leaves<Leaf<'a>>,
    /// The other body where that is a closed mesh, and its local frame from that of A.
    solid: Option<(&'a Mesh, Pose)>,
    is_a: bool,
}

/// A piece of surface that counts.
struct Counted<'f, 'a> {
    leaf: &'f NoisyLeaf<'a>,
    /// Its place in the leaf.
    place: usize,
    /// Its deviations to the other body.
    deviations: f64,
    /// How near it is beside the nearest, from 0 to 1.
    near: f64,
    /// How much of its error is its own, from 0 to 1: what those about it are off by too they say once.
    alone: f64,
    /// How surely it is on one side of the other surface, as far as it is alone, from 0 to 1; less than 0 inside of a
    /// closed mesh.
    side: f64,
}

impl Found<'_> {
    /// Over how many pieces of surface the bodies are about as near as where they are nearest; of two clouds
    /// the fewer, and less those inside of a closed mesh. Continuous.
    pub(crate) fn extent(&self, bodies: (BodyRef<'_>, BodyRef<'_>), a_from_b: &Pose) -> f64 {
        let extents = self.facing(bodies, a_from_b).map(|facing| facing.map(|f| self.sum(&f)));
        extents.into_iter().flatten().reduce(f64::min).unwrap_or(0.0).max(0.0)
    }

    /// What the extent changes by as the pose does.
    pub(crate) fn extent_by_pose(
        &self,
        bodies: (BodyRef<'_>, BodyRef<'_>),
        a_from_b: &Pose,
    ) -> Wrench {
        let of_each = self.facing(bodies, a_from_b).into_iter().flatten();
        let sums = of_each.map(|facing| (self.sum(&facing), facing));
        let fewer = sums.min_by(|(p, _), (q, _)| p.total_cmp(q));
        match fewer {
            Some((sum, facing)) if sum > 0.0 => self.sum_by_pose(&facing),
            _ => Wrench::zeros(),
        }
    }

    /// The pieces of A, and those of B; none of a mesh.
    fn facing<'f>(
        &'f self,
        (a, b): (BodyRef<'f>, BodyRef<'f>),
        a_from_b: &Pose,
    ) -> [Option<Facing<'f, 'f>>; 2] {
        let (of_a, of_b) = (&self.leaves_a, &self.leaves_b);
        let here = Pose::identity();
        [(a, b, of_a, of_b, a_from_b.inverse(), true), (b, a, of_b, of_a, here, false)].map(
            |(body, other, own, others, other_from_a, is_a)| {
                let BodyRef::Cloud(_) = body else { return None };
                let solid = match other {
                    BodyRef::Mesh(mesh) if mesh.has_solids() => Some((mesh, other_from_a)),
                    _ => None,
                };
                Some(Facing { own, others, solid, is_a })
            },
        )
    }

    fn sum(&self, facing: &Facing<'_, '_>) -> f64 {
        let mut sum = 0.0;
        self.visit(facing, |piece| sum += piece.near * piece.side);
        sum
    }

    fn sum_by_pose(&self, facing: &Facing<'_, '_>) -> Wrench {
        let least = self.deviations_by_pose();
        let window = self.window();
        // Where less is looked at than usual, that ends at the same deviations whatever the least are.
        let of_window = if self.is_window_cut() { -least } else { Wrench::zeros() };
        let mut all = Wrench::zeros();
        self.visit(facing, |piece| {
            let Counted { leaf, place, deviations, near, alone, side } = piece;
            let is_on_ramp = near < 1.0;
            let of_piece = facing.deviations_by_pose((leaf, place), deviations);
            all += of_piece * (2.0 * normal::density(deviations) * alone * side.signum() * near);
            if is_on_ramp {
                let share = (deviations - self.deviations) / window;
                let of_share = (of_piece - least - of_window * share) / window;
                all -= of_share * (side / (1.0 - FULL));
            }
        });
        all
    }

    /// Calls `visit` with all pieces that count.
    fn visit<'f>(&self, facing: &Facing<'f, 'f>, mut visit: impl FnMut(Counted<'f, 'f>)) {
        let window = self.window();
        if window <= 0.0 {
            return;
        }
        for leaf in facing.own.in_order() {
            let Leaf::Noisy(leaf) = leaf else { continue };
            for (place, squared) in leaf.squared.iter().enumerate() {
                let deviations = squared.sqrt();
                let share = (deviations - self.deviations) / window;
                let near = ((1.0 - share) / (1.0 - FULL)).clamp(0.0, 1.0);
                let alone = 1.0 - leaf.surfels[place].shared;
                if near > 0.0 && alone > 0.0 {
                    let side = alone * facing.side(leaf, place, deviations);
                    visit(Counted { leaf, place, deviations, near, alone, side });
                }
            }
        }
    }
}

impl Facing<'_, '_> {
    fn side(&self, leaf: &NoisyLeaf<'_>, place: usize, deviations: f64) -> f64 {
        let known = 1.0 - 2.0 * normal::upper_tail(deviations);
        let Some((mesh, mesh_from_a)) = &self.solid else { return known };
        let is_inside =
            mesh.encloses(&mesh_from_a.transform_point(&leaf.surfels[place].point.mean));
        if is_inside { -known } else { known }
    }

    /// What the deviations of a piece to the other body change by as the pose does.
    fn deviations_by_pose(
        &self,
        (leaf, place): (&NoisyLeaf<'_>, usize),
        deviations: f64,
    ) -> Wrench {
        let own = &leaf.surfels[place].point;
        let nearest = nearest_to((leaf, place), self.others, deviations * deviations);
        let of_pair = |other: UncertainPoint| {
            if self.is_a {
                deviations_by_pose(own, &other)
            } else {
                deviations_by_pose(&other, own)
            }
        };
        nearest.and_then(of_pair).unwrap_or_else(Wrench::zeros)
    }
}

/// The place of the other body that a piece is so many squared deviations from.
fn nearest_to(
    (leaf, place): (&NoisyLeaf<'_>, usize),
    others: &Leaves<Leaf<'_>>,
    squared: f64,
) -> Option<UncertainPoint> {
    /// Relative, of the order in which two pieces are asked about.
    const ROUNDING: f64 = 1e-9;
    let surfel = &leaf.surfels[place];
    let whitening = Whitening::of(surfel);
    let mut limit = squared * (1.0 + ROUNDING) + f64::MIN_POSITIVE;
    let mut nearest = None;
    for other in others.all() {
        match other {
            Leaf::Noisy(other) => {
                // What did not have to end is not the nearest.
                let ended = other.surfels.iter().filter(|other| !other.may_end());
                for on_other in ended {
                    if let Some(found) = squared_deviations(surfel, on_other, limit) {
                        (limit, nearest) = (found, Some(on_other.point));
                    }
                }
            }
            Leaf::Exact(other) => {
                for facet in other.facets.iter() {
                    let found = facet.squared_deviations(surfel, &whitening, limit);
                    if let Some((found, way)) = found {
                        let on_mesh = surfel.point.mean + way;
                        (limit, nearest) = (found, Some(UncertainPoint::exact(on_mesh)));
                    }
                }
            }
        }
    }
    nearest
}

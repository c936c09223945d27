//! How deep a cloud is inside a closed mesh: a search along surfaces does not see what lies wholly
//! within.

use std::cmp::Ordering;

use cloudtouch_bvh::{NodeId, Visit};
use cloudtouch_geom::{Point3, Pose, Vector3, normal};
use cloudtouch_noise::Scratch;

use crate::body::BodyRef;
use crate::classifier::Clock;
use crate::cloud::Surfel;
use crate::judge::MOST_DEVIATIONS;
use crate::mesh::{Mesh, Sides};

use super::deepest_first::DeepestFirst;
use crate::search::in_mesh::InMesh;
use crate::search::wrench::{Wrench, force_at};

/// The point of a cloud that is most clearly inside a closed mesh.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inside {
    /// Depth over the largest standard deviation of the point, sampling included: a lonely point is
    /// known badly.
    pub deviations: f64,
    /// Depth, m, and standard deviation toward the surface; while it is looked for, the largest in any
    /// direction.
    pub depth: f64,
    pub std: f64,
    /// The nearest place of the mesh, in the frame of A.
    pub place: Point3,
    /// Unit normal out of the mesh there, in the frame of A.
    pub outward: Vector3,
    /// Distance between samples there, m.
    pub spacing: f64,
}

impl Inside {
    /// What the depth changes by as the pose does.
    pub(crate) fn depth_by_pose(&self, mesh_is_a: bool) -> Wrench {
        let outward = if mesh_is_a { -self.outward } else { self.outward };
        force_at(&self.place, &outward)
    }

    /// The same of the deviations; nothing where these are so many that more say no more, or infinite, of a point that
    /// is exact.
    fn deviations_by_pose(&self, mesh_is_a: bool) -> Wrench {
        if self.deviations >= MOST_DEVIATIONS {
            return Wrench::zeros();
        }
        self.depth_by_pose(mesh_is_a) * (self.deviations / self.depth)
    }

    /// How far what is between the surfaces still counts: all of it for a point on the surface, nothing
    /// for one that is a standard deviation inside, whose distance from the surface no longer parts the
    /// bodies.
    fn share_of_between(&self) -> f64 {
        (1.0 - self.depth / self.std).max(0.0)
    }
}

/// What looking inside found.
#[derive(Debug, Default)]
pub(crate) struct Looked {
    /// `None` where no point is expected inside.
    pub deepest: Option<Inside>,
    /// The leaf that holds it.
    pub leaf: Option<NodeId>,
    /// Whether the clock ended it, or what was enough: others may be more clearly inside.
    pub is_cut_short: bool,
    pub nodes_visited: usize,
    pub leaves_prepared: usize,
}

/// A cloud, a mesh that its points may be inside of, and what is known of the places between them so far.
struct Within<'a> {
    bodies: &'a InMesh<'a>,
    sides: Sides<'a>,
    /// PERF: of a leaf that may hold a point inside, most hold none: these need no fit.
    clear: Sides<'a>,
    scratch: Scratch,
}

/// A leaf of a cloud that may hold a point inside a mesh.
#[derive(Clone, Copy)]
struct LeafWithin {
    leaf: NodeId,
    /// In the frame of the mesh.
    middle: Point3,
    /// From there to its points at most, m.
    reach: f64,
}

/// Looks for points of a cloud inside the mesh it is asked about, until one is clearly so, the time is
/// over, or `is_enough` of an upper bound on the deviations, whatever the search between the surfaces finds; finds nothing where neither body is a mesh.
pub(crate) fn look_inside(
    bodies: (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    clock: &Clock,
    is_enough: impl Fn(f64) -> bool,
) -> Looked {
    let mut looked = Looked::default();
    let Some(bodies) = InMesh::of(bodies, a_from_b) else { return looked };
    let InMesh { cloud, mesh, a_from_mesh, .. } = &bodies;
    let mut deepest = None;
    let mut within = Within::new(&bodies);
    // PERF: what is deepest comes first, since a point that is clearly inside spares all others their fits.
    let leaves = looked.leaves_within(&bodies, clock).into_iter();
    let (inside, others): (Vec<_>, Vec<_>) =
        leaves.partition(|leaf| mesh.is_surely_inside(&leaf.middle));
    let middles: Vec<Point3> = inside.iter().map(|leaf| leaf.middle).collect();
    let in_order = DeepestFirst::new(mesh, &middles).map(|at| inside[at]).chain(others);
    for LeafWithin { leaf, middle, reach } in in_order {
        if looked.deviations() >= MOST_DEVIATIONS {
            break;
        }
        looked.is_cut_short |= clock.is_over();
        if !looked.is_cut_short && within.sides.are_clear_around(&middle, reach) {
            continue;
        }
        looked.is_cut_short |= is_enough(looked.deviations_given(MOST_DEVIATIONS));
        if looked.is_cut_short {
            break;
        }
        deepest = looked.look_into(leaf, &mut within).or(deepest);
    }
    let Within { mut scratch, .. } = within;
    looked.deepest = looked.deepest.zip(deepest).map(|(inside, piece)| {
        let told = cloud.prepared().told(piece, &mut scratch);
        let outward = bodies.mesh_from_cloud.inverse().transform_vector(&inside.outward);
        Inside {
            std: told.point.covariance.std_along(&outward),
            place: a_from_mesh.transform_point(&inside.place),
            outward: a_from_mesh.transform_vector(&inside.outward),
            ..inside
        }
    });
    looked
}

/// Whether a leaf of the cloud alone holds a point inside the mesh so clearly that that is enough: then
/// [`look_inside`] comes by what is.
pub(crate) fn is_enough_of_leaf(
    leaf: NodeId,
    bodies: (BodyRef<'_>, BodyRef<'_>),
    a_from_b: &Pose,
    is_enough: impl Fn(f64) -> bool,
) -> bool {
    let mut looked = Looked::default();
    if let Some(bodies) = InMesh::of(bodies, a_from_b) {
        looked.look_into(leaf, &mut Within::new(&bodies));
    }
    is_enough(looked.deviations_given(MOST_DEVIATIONS))
}

impl<'a> Within<'a> {
    fn new(bodies: &'a InMesh<'a>) -> Self {
        let [sides, clear] = [Sides::of(bodies.mesh), Sides::of(bodies.mesh)];
        Self { bodies, sides, clear, scratch: Scratch::default() }
    }
}

impl Looked {
    /// The deviations between two bodies, given those between their surfaces: negative inside. Rises with
    /// these.
    pub(crate) fn deviations_given(&self, between: f64) -> f64 {
        let of_inside = |inside: Inside| between * inside.share_of_between() - inside.deviations;
        self.deepest.map_or(between, of_inside).max(-MOST_DEVIATIONS)
    }

    /// What these change by as the pose does, given those between the surfaces and what they change by.
    pub(crate) fn deviations_by_pose(
        &self,
        between: f64,
        between_by_pose: Wrench,
        mesh_is_a: bool,
    ) -> Wrench {
        let Some(inside) = self.deepest else { return between_by_pose };
        let share = inside.share_of_between();
        let of_inside = inside.deviations_by_pose(mesh_is_a);
        if share == 0.0 {
            return -of_inside;
        }
        let share_by_pose = inside.depth_by_pose(mesh_is_a) * (-1.0 / inside.std);
        between_by_pose * share + share_by_pose * between - of_inside
    }

    /// How surely a point is inside: from 0, with none or one on the surface, to 1.
    pub(crate) fn surely_inside(&self) -> f64 {
        1.0 - 2.0 * normal::upper_tail(self.deviations())
    }

    /// What this changes by as the pose does.
    pub(crate) fn surely_inside_by_pose(&self, mesh_is_a: bool) -> Wrench {
        let slope = 2.0 * normal::density(self.deviations());
        let of_inside = self.deepest.map(|inside| inside.deviations_by_pose(mesh_is_a) * slope);
        of_inside.unwrap_or_else(Wrench::zeros)
    }

    /// The leaves that may hold a point inside, as far as their surroundings tell.
    fn leaves_within(&mut self, bodies: &InMesh<'_>, clock: &Clock) -> Vec<LeafWithin> {
        let InMesh { cloud, mesh, mesh_from_cloud, .. } = bodies;
        let mut leaves = Vec::new();
        cloud.tree().visit_nodes(|node| {
            self.nodes_visited += 1;
            self.is_cut_short |= clock.is_over();
            if self.is_cut_short {
                return Visit::Prune;
            }
            let obb = node.obb();
            let middle = mesh_from_cloud.transform_point(&obb.centre);
            let reach = obb.radius() + node.shift();
            if mesh.is_surely_clear_of(&middle, reach) {
                return Visit::Prune;
            }
            if node.is_leaf() {
                leaves.push(LeafWithin { leaf: node.id(), middle, reach });
            }
            Visit::Descend
        });
        leaves
    }

    /// Looks at the points of a leaf; which piece is the deepest of all so far, where it is one of these.
    fn look_into(&mut self, leaf: NodeId, within: &mut Within<'_>) -> Option<u32> {
        let Within { bodies, sides, clear, scratch } = within;
        let InMesh { cloud, mesh, mesh_from_cloud, .. } = bodies;
        let shift = cloud.tree().node(leaf).map_or(0.0, |node| node.shift());
        let mut deepest = None;
        let computed = cloud.visit_some_of_leaf(
            leaf,
            |place| !clear.are_clear_around(&mesh_from_cloud.transform_point(place), shift),
            scratch,
            |piece, surfel| {
                if let Some(inside) = self.look_at(surfel, (mesh, sides), mesh_from_cloud) {
                    (self.deepest, self.leaf) = (Some(inside), Some(leaf));
                    deepest = Some(piece);
                }
            },
        );
        self.leaves_prepared += usize::from(computed);
        deepest
    }

    fn deviations(&self) -> f64 {
        self.deepest.map_or(0.0, |inside| inside.deviations)
    }

    /// A point that is more clearly inside than all before, in the frame of the mesh, known no better in any
    /// direction than in all.
    fn look_at(
        &self,
        surfel: &Surfel,
        (mesh, sides): (&Mesh, &mut Sides<'_>),
        mesh_from_cloud: &Pose,
    ) -> Option<Inside> {
        let at = mesh_from_cloud.transform_point(&surfel.point.mean);
        if mesh.is_surely_outside(&at) {
            return None;
        }
        let (place, _) = mesh.nearest(&at);
        let depth = (at - place).norm();
        let std = surfel.most_variance.sqrt();
        let deviations = depth / std.max(f64::MIN_POSITIVE);
        // PERF: on which side it is takes longest to tell.
        if deviations.partial_cmp(&self.deviations()) != Some(Ordering::Greater)
            || !sides.encloses(&at, depth)
        {
            return None;
        }
        // On the surface itself no direction is outward.
        let outward = (place - at).try_normalize(0.0)?;
        Some(Inside { deviations, depth, std, place, outward, spacing: surfel.spacing })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The judge's slope is nothing there, and nothing times infinity was no number.
    #[test]
    fn an_exact_point_deep_inside_has_no_infinite_slope() {
        let place = Point3::new(0.1, 0.0, 0.0);
        let of = |deviations: f64| Inside {
            deviations,
            depth: 0.1,
            std: 0.0,
            place,
            outward: Vector3::x(),
            spacing: 0.01,
        };
        assert_eq!(of(f64::INFINITY).deviations_by_pose(true), Wrench::zeros());
        assert!((of(3.0).deviations_by_pose(true) - Wrench::zeros()).norm() > 1.0);
    }
}

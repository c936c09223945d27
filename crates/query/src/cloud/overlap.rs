//! The points that a leaf shares with those beside it (section 5 of the paper): siblings overlap by a
//! part ε of their parent, and what lies there belongs to both.

use cloudtouch_bvh::{Node, NodeId};
use cloudtouch_geom::Vector3;
use cloudtouch_noise::Scratch;

use super::prepared::Prepared;
use super::surface::room::Room;
use super::surface::surfel::Surfel;

/// A part of space that a node takes of its parent.
struct HalfSpace {
    outward: Vector3,
    /// How far it reaches along that, m.
    reach: f64,
}

impl Prepared {
    /// The surface at the points of a leaf and at those it shares, and whether this call computed it.
    pub(crate) fn shared_leaf(&self, id: NodeId) -> (&[Surfel], bool) {
        let mut computed = false;
        let shared = self.surface.shared.get_or_init(|| Room::new(self.tree.node_slots()));
        let surfels = shared.get_or_init(id.index(), || {
            computed = true;
            let mut scratch = Scratch::default();
            let indices = self.shared_indices(id);
            indices.into_iter().map(|index| self.told(index, &mut scratch)).collect()
        });
        (surfels, computed)
    }

    /// How many points all leaves hold, one that is shared counted in each.
    pub(crate) fn stored_points(&self) -> usize {
        self.tree.leaves().map(|leaf| self.shared_indices(leaf.id()).len()).sum()
    }

    /// The points within every half that led to a leaf, each widened by half of ε of what was halved.
    fn shared_indices(&self, id: NodeId) -> Vec<u32> {
        let Some(leaf) = self.tree.node(id) else { return Vec::new() };
        let halves: Vec<HalfSpace> = std::iter::successors(Some(leaf), |node| self.parent(node))
            .filter_map(|node| self.half_of(&node))
            .collect();
        let points = self.points();
        let within = |index: &u32| {
            let place = points[*index as usize].coords;
            halves.iter().all(|half| half.outward.dot(&place) <= half.reach)
        };
        // Own points are within up to rounding.
        let own = leaf.primitive_indices();
        let others = (0..points.len() as u32).filter(within).filter(|index| !own.contains(index));
        own.iter().copied().chain(others).collect()
    }

    /// The widened half of its parent that a node takes; `None` for the root.
    fn half_of(&self, node: &Node<'_>) -> Option<HalfSpace> {
        let parent = self.parent(node)?;
        let [first, second] = parent.children()?;
        let other = self.tree.node(if first == node.id() { second } else { first })?;
        let axis = parent.obb().axes.column(0).into_owned();
        let away = node.moments().mean - other.moments().mean;
        let outward = if axis.dot(&away) < 0.0 { axis } else { -axis };
        let along = |&index: &u32| outward.dot(&self.points()[index as usize].coords);
        let edge = node.primitive_indices().iter().map(along).fold(f64::NEG_INFINITY, f64::max);
        // Each half reaches half of the overlap over the cut.
        let wider = self.tree.settings().sibling_overlap * parent.obb().half_extents[0];
        Some(HalfSpace { outward, reach: edge + wider })
    }

    fn parent(&self, node: &Node<'_>) -> Option<Node<'_>> {
        self.tree.node(node.parent()?)
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_bvh::TreeSettings;
    use cloudtouch_geom::{Point3, PointCloud};
    use cloudtouch_noise::{MotionNoise, NoiseSettings, SensorModel};

    use super::*;
    use crate::cloud::Preparation;
    use crate::filter::FilterSettings;

    fn line(sibling_overlap: f64) -> Prepared {
        let points = (0..64).map(|i| Point3::new(f64::from(i), 0.0, 0.0)).collect();
        let sensor = SensorModel::Exact;
        let by = Preparation {
            sensor: &sensor,
            filter: &FilterSettings::for_sensor(&sensor),
            noise: NoiseSettings::default(),
            tree: &TreeSettings { max_leaf_points: 16, sibling_overlap, ..TreeSettings::default() },
            motion: MotionNoise::default(),
        };
        Prepared::new(&[(&PointCloud::from_points(points), by)], None).unwrap()
    }

    /// No point was in two leaves, whatever ε: what was cut there was nowhere whole.
    #[test]
    fn leaves_share_the_points_beside_their_cuts() {
        assert_eq!(line(0.0).stored_points(), 64);
        // Halves reach 0.05 · 63 = 3.15 over, three points each; quarters 0.05 · 31 = 1.55, one each,
        // and the cut in the middle cuts them too.
        let shared = line(0.1);
        assert_eq!(shared.stored_points(), 64 + 2 * 3 + 4);
        for leaf in shared.tree().leaves() {
            let (surfels, _) = shared.shared_leaf(leaf.id());
            let own = leaf.primitive_indices();
            assert!(own.iter().all(|index| surfels.iter().any(|s| s.index == *index)));
            assert!(surfels.len() > own.len());
        }
    }
}

//! Surface pieces whose noise model is computed when a query first comes near them, and kept.

use std::sync::OnceLock;

use cloudtouch_bvh::{Node, NodeId, Tree};
use cloudtouch_geom::{Motion, Point3, UncertainPoint, UnitVector3, Vector3};
use cloudtouch_noise::Scratch;

use super::Cloud;
use super::edge::{Edge, edges_of};

/// The piece of surface about a sample, in the cloud's local frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Surfel {
    /// Index among the points the filter kept.
    pub index: u32,
    /// Where the surface is expected, and how well that is known.
    pub point: UncertainPoint,
    /// Distance between samples there, m.
    pub spacing: f64,
    /// The largest variance of `point` in any direction, m²; never too small by rounding.
    pub most_variance: f64,
    /// Unit normal of the surface there, of either sign, where one was fitted.
    pub normal: Option<Vector3>,
}

impl Surfel {
    /// The same piece in another frame.
    pub(crate) fn moved(&self, motion: &Motion) -> Self {
        Self {
            point: motion.uncertain_point(&self.point),
            normal: self.normal.map(|normal| motion.vector(&normal)),
            ..*self
        }
    }

    /// Variance of the position across the surface, m²; zero where no normal was fitted.
    pub(crate) fn variance_across(&self) -> f64 {
        self.normal.map_or(0.0, |normal| self.point.covariance.variance_along(&normal))
    }
}

/// Relative rounding of an eigenvalue, generously.
const ROUNDING: f64 = 1e-9;
/// Points that a spacing is told from, at most.
const REGION_POINTS: usize = 40;

/// One slot per point, and per tree node, of which only those of leaves are ever filled. Each is a
/// pure function of the cloud, so it does not matter which thread fills it.
#[derive(Debug)]
pub(super) struct LazySurface {
    surfels: Vec<OnceLock<Box<Surfel>>>,
    leaves: Vec<OnceLock<Vec<Surfel>>>,
    edges: Vec<OnceLock<Vec<Edge>>>,
    /// What the spacing of each point is limited to, m.
    spacing_caps: Vec<f64>,
}

impl LazySurface {
    pub(super) fn new(tree: &Tree, points: usize) -> Self {
        let mut spacing_caps = vec![0.0; points];
        for leaf in tree.leaves() {
            let cap = spacing_cap(tree, leaf);
            for &index in leaf.primitive_indices() {
                spacing_caps[index as usize] = cap;
            }
        }
        Self {
            surfels: slots(points),
            leaves: slots(tree.node_slots()),
            edges: slots(tree.node_slots()),
            spacing_caps,
        }
    }
}

impl LazySurface {
    /// What the spacing of each point of a leaf is limited to, m.
    pub(super) fn spacing_cap(&self, leaf: Node<'_>) -> f64 {
        leaf.primitive_indices().first().map_or(0.0, |&index| self.spacing_caps[index as usize])
    }
}

fn slots<T>(count: usize) -> Vec<OnceLock<T>> {
    (0..count).map(|_| OnceLock::new()).collect()
}

/// The spacing a point of a leaf may be given at most, on which the tree's bounds rest: half more
/// than that of as many points spread evenly over the two longest sides of the region's box, or on a
/// line.
fn spacing_cap(tree: &Tree, leaf: Node<'_>) -> f64 {
    let around = region(tree, leaf);
    let mut sides: [f64; 3] = (2.0 * around.obb().half_extents).into();
    sides.sort_by(f64::total_cmp);
    let [_, middle, longest] = sides;
    let count = around.primitive_indices().len().max(1) as f64;
    // On a line the sixth neighbour, which the spacing is measured by, is three steps away.
    1.5 * (longest * middle / count).sqrt().max(3.0 * longest / count)
}

/// The largest node around a leaf with few enough points to tell their spacing there.
fn region<'a>(tree: &'a Tree, leaf: Node<'a>) -> Node<'a> {
    let parent = |node: &Node<'a>| node.parent().and_then(|id| tree.node(id));
    let is_small = |node: &Node<'a>| node.primitive_indices().len() <= REGION_POINTS;
    let around = std::iter::successors(Some(leaf), parent).take_while(is_small).last();
    around.unwrap_or(leaf)
}

impl Cloud {
    /// The surface at the points of a node, and whether this call computed it.
    pub(crate) fn leaf(&self, id: NodeId) -> (&[Surfel], bool) {
        let mut computed = false;
        let surfels = self.surface.leaves[id.index()].get_or_init(|| {
            computed = true;
            let Some(leaf) = self.tree.node(id) else { return Vec::new() };
            let mut scratch = Scratch::default();
            let surfel = |&index: &u32| *self.surfel(index, &mut scratch);
            leaf.primitive_indices().iter().map(surfel).collect()
        });
        (surfels, computed)
    }

    /// The edges that start or end at a point of a leaf.
    pub(crate) fn leaf_edges(&self, id: NodeId) -> &[Edge] {
        self.surface.edges[id.index()].get_or_init(|| {
            let Some(leaf) = self.tree.leaf(id) else { return Vec::new() };
            edges_of(self, leaf.primitive_indices())
        })
    }

    /// The surface at the points measured nearest to a place in the local frame.
    pub(crate) fn surfels_near(&self, place: &Point3, count: usize) -> Vec<Surfel> {
        let mut scratch = Scratch::default();
        let nearest = self.neighborhoods.nearest_to(place, count);
        nearest.iter().map(|near| *self.surfel(near.index as u32, &mut scratch)).collect()
    }

    /// The surface at one point.
    pub(super) fn surfel(&self, index: u32, scratch: &mut Scratch) -> &Surfel {
        let place = index as usize;
        self.surface.surfels[place].get_or_init(|| {
            let cap = self.surface.spacing_caps[place];
            let near = &self.neighborhoods;
            let refined = match self.normals.as_ref().map(|normals| normals[place]) {
                Some(normal) => {
                    let sensor = &self.sensor[place];
                    self.noise.with_normal(place, normal, near, sensor, cap, scratch)
                }
                None => self.noise.refine(place, near, &self.sensor, cap, scratch),
            };
            let (point, spacing) = (refined.point, refined.spacing);
            let normal = refined.normal.map(UnitVector3::into_inner);
            let most_variance = point.covariance.max_std().powi(2) * (1.0 + ROUNDING);
            Box::new(Surfel { index, point, spacing, most_variance, normal })
        })
    }
}

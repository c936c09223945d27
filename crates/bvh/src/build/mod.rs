//! Builds top-down: a node that holds too much, or is not flat enough, is cut across its direction of largest
//! variance, at the median or where both parts have little surface; first of all what is far from the rest is set
//! apart.

mod by_area;
mod fit;
mod grow;
mod parts;

use cloudtouch_geom::{Matrix3, Point3, Vector3};

use crate::build::grow::{ALONE, Grown, Growth, LEAST_SHARED};
use crate::build::parts::{Memory, parts_of};
use crate::tree::bounds_list::BoundsList;
use crate::tree::coverage::Coverages;
use crate::tree::node::{Link, NodeData};
use crate::{LeafBounds, Moments, Node, Obb, Primitive, Primitives, Tree, TreeError, TreeSettings};

/// Indices are 32 bit.
const MAX_PRIMITIVES: usize = u32::MAX as usize - 1;

impl Tree {
    /// Builds a tree over the primitives, which may be none.
    ///
    /// A node is split while it has too many primitives or too high a variation (see
    /// [`TreeSettings`]), at the median of the positions along the eigenvector of largest
    /// variance. The median always halves, equal positions being told apart by their index, so
    /// neither duplicates nor a grid can keep the splitting going, and the depth is log₂ n, and a little more:
    /// what is more than four times as far from the middle of all as half of them is set apart first, and
    /// of the rest again, 32 times at most, so that a few returns from far away leave the tree over the others as
    /// it is without them. By [`Split::SurfaceArea`](crate::Split::SurfaceArea) large nodes are cut into parts that are not halves but hold a tenth
    /// at least, where there are two such parts, so that the tree is deeper by some levels.
    ///
    /// O(n log n), on one thread; the result depends on nothing but the input.
    ///
    /// # Errors
    /// When a setting is out of range, or a coordinate, covariance or weight is not a usable
    /// number.
    pub fn build(primitives: Vec<Primitive>, settings: &TreeSettings) -> Result<Self, TreeError> {
        let mut tree = Self::of(Primitives::Each(primitives), settings)?;
        tree.grow(ALONE);
        tree.update_bounds(tree.root);
        Ok(tree)
    }

    /// [`Self::build`] and [`Self::set_leaf_bounds`] in one, on all threads of the pool, with the same
    /// result: bounds that would be replaced at once are never computed. `of_leaf` is given the tree and one
    /// of its leaves, in which all is as it will be but the bounds; what else it says is returned in the
    /// order of the leaves.
    ///
    /// # Errors
    /// As either of the two.
    pub fn build_bounded<T: Send>(
        primitives: Primitives,
        settings: &TreeSettings,
        of_leaf: impl Fn(&Self, Node<'_>) -> (LeafBounds, T) + Sync,
    ) -> Result<(Self, Vec<T>), TreeError> {
        let mut tree = Self::of(primitives, settings)?;
        tree.grow(LEAST_SHARED);
        let said = tree.said_of_leaves(|leaf| of_leaf(&tree, leaf))?;
        tree.take_bounds(&said);
        Ok((tree, said.into_iter().map(|(_, besides)| besides).collect()))
    }

    /// Without any nodes.
    fn of(primitives: Primitives, settings: &TreeSettings) -> Result<Self, TreeError> {
        settings.validate()?;
        if primitives.len() > MAX_PRIMITIVES {
            return Err(TreeError::TooMany { count: primitives.len() });
        }
        primitives.check()?;
        let count = primitives.len();
        Ok(Self {
            settings: *settings,
            primitives,
            refined: BoundsList::default(),
            extents: Vec::new(),
            leaf_of: vec![Link::NONE; count],
            order: (0..count as u32).collect(),
            nodes: Vec::new(),
            coverages: Coverages::default(),
            free: Vec::new(),
            root: None,
            spread_when_built: 0.0,
        })
    }

    /// Discards all nodes and builds anew over the primitives present, with their indices.
    ///
    /// Bounds set by [`Self::set_leaf_bounds`] stay with the primitives; node names change.
    pub fn rebuild(&mut self) {
        self.nodes.clear();
        self.free.clear();
        // The order of indices, so that the result is that of a build and not of the history.
        self.order.sort_unstable();
        self.grow(ALONE);
        self.update_bounds(self.root);
    }

    /// Makes all nodes for `order`, without bounds; halves of at least so many on threads of their own.
    fn grow(&mut self, least_shared: usize) {
        self.root = None;
        if !self.order.is_empty() {
            let root = self.new_node(0, self.order.len() as u32);
            self.root = Some(root);
            let moments = self.fit(root);
            self.partition(root, moments, least_shared);
        }
        self.nodes.shrink_to_fit();
        self.spread_when_built = self.spread();
    }

    /// Splits a fitted leaf, and its halves, as often as the settings ask for; then sets the
    /// bounds of what is below it.
    pub(crate) fn subdivide(&mut self, leaf: u32) {
        self.partition(leaf, self.moments_of(leaf), ALONE);
        self.update_bounds(Some(leaf));
    }

    fn partition(&mut self, leaf: u32, moments: Moments, least_shared: usize) {
        let top = self.nodes[leaf as usize];
        let mut parts = parts_of(&self.primitives, self.indices_of(leaf));
        let growth =
            Growth::new(&self.primitives, &self.settings, self.indices_of(leaf), least_shared);
        let start = top.start as usize;
        let grown = growth.grow((top, moments), &mut parts, &mut Memory::default());
        let slots = self.order[start..].iter_mut();
        slots.zip(&parts).for_each(|(slot, part)| *slot = part.index);
        self.graft(leaf, grown);
    }

    /// Puts what grew in the place of a leaf. Both halves get their names first, then all below the second,
    /// then all below the first.
    fn graft(&mut self, leaf: u32, grown: Grown) {
        let parent = self.nodes[leaf as usize].parent;
        match grown {
            Grown::Halves(halves) => {
                let (top, halves) = *halves;
                let mut add = |half: &Grown| self.add(half.top().under(leaf.into()));
                let names = [add(&halves[0]), add(&halves[1])];
                self.nodes[leaf as usize] = top.under(parent);
                self.nodes[leaf as usize].set_children(Some(names));
                let [first, second] = halves;
                self.graft(names[1], second);
                self.graft(names[0], first);
            }
            Grown::All(nodes) if leaf == 0 && self.nodes.len() == 1 => {
                // PERF: all there is has the names it grew with.
                self.nodes = nodes;
                for id in 0..self.nodes.len() as u32 {
                    self.tell_leaf(id);
                }
            }
            Grown::All(nodes) => {
                let mut names = vec![leaf];
                let mut nodes = nodes.into_iter();
                self.nodes[leaf as usize] = nodes.next().expect("the top is one of them");
                names.extend(nodes.map(|node| self.add(node)));
                for &id in &names {
                    self.rename(id, &names);
                }
                self.nodes[leaf as usize].parent = parent;
            }
        }
    }

    /// Names what is above a node and below it by the names of theirs, and tells what a leaf holds where it is.
    fn rename(&mut self, id: u32, names: &[u32]) {
        let name = |own: u32| names[own as usize];
        let node = &mut self.nodes[id as usize];
        node.parent = node.parent.get().map_or(Link::NONE, |parent| Link::from(name(parent)));
        node.set_children(node.children().map(|children| children.map(name)));
        self.tell_leaf(id);
    }

    /// Tells what a leaf holds where it is.
    fn tell_leaf(&mut self, id: u32) {
        let node = &self.nodes[id as usize];
        if node.is_leaf() {
            for &index in &self.order[node.start as usize..][..node.count as usize] {
                self.leaf_of[index as usize] = Link::from(id);
            }
        }
    }

    pub(crate) fn should_split(&self, id: u32) -> bool {
        let moments = self.moments_of(id);
        self.settings.asks_to_split(moments.count, moments.variation())
    }

    /// A leaf over a range of `order`, not fitted yet.
    pub(crate) fn new_node(&mut self, start: u32, count: u32) -> u32 {
        let obb = Obb {
            centre: Point3::origin(),
            axes: Matrix3::identity(),
            half_extents: Vector3::zeros(),
        };
        self.add(NodeData::leaf(start, count, &obb))
    }

    /// Gives a node the name of one that is not in use any more, if there is one.
    fn add(&mut self, node: NodeData) -> u32 {
        self.coverages.forget();
        if let Some(id) = self.free.pop() {
            self.nodes[id as usize] = node;
            id
        } else {
            self.nodes.push(node);
            self.nodes.len() as u32 - 1
        }
    }
}

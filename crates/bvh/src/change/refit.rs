//! Refit: positions change, the partition stays; and how to tell when it no longer fits.

use crate::{Primitive, Primitives, Tree, TreeError};

impl Tree {
    /// Replaces every primitive, by index, and fits moments, boxes, coverages and bounds anew
    /// without moving a primitive to another leaf.
    ///
    /// The boxes are those a builder would give the same partition. `primitives` has one entry
    /// for each index ([`Self::index_count`]); those of removed ones are ignored. Bounds on an
    /// answer stay right however far the points have moved, only culling gets worse: see
    /// [`Self::quality`]. O(n log n), somewhat faster than a build, and node names stay.
    ///
    /// # Errors
    /// When the count differs, or a coordinate, covariance or weight is not a usable number; the
    /// tree is then unchanged.
    pub fn refit(&mut self, primitives: &[Primitive]) -> Result<(), TreeError> {
        if primitives.len() != self.primitives.len() {
            let (expected, found) = (self.primitives.len(), primitives.len());
            return Err(TreeError::Count { expected, found });
        }
        for &index in &self.order {
            primitives[index as usize].check(index as usize)?;
        }
        self.primitives = Primitives::Each(primitives.to_vec());
        self.tighten();
        Ok(())
    }

    /// Fits every node to the primitives as they are: undoes the slack that insertions and
    /// removals leave in the boxes of the nodes they pass.
    pub fn tighten(&mut self) {
        if let Some(root) = self.root {
            self.fit(root);
        }
        for id in self.preorder(self.root) {
            if let Some(children) = self.nodes[id as usize].children() {
                self.fit_children(id, children);
            }
        }
        self.update_bounds(self.root);
    }

    /// How much looser the leaves have become since the tree was built; 1 when they are as tight.
    ///
    /// The sum of the squared half diagonals of the leaf boxes, relative to that of the root, over
    /// the same number at the last build. About the factor by which pairs to test have grown.
    pub fn quality(&self) -> f64 {
        if self.spread_when_built > 0.0 { self.spread() / self.spread_when_built } else { 1.0 }
    }

    /// Whether [`Self::quality`] has risen above `threshold`; 2 is a reasonable one.
    pub fn should_rebuild(&self, threshold: f64) -> bool {
        self.quality() > threshold
    }

    /// Σ over leaves of radius² / radius² of the root; 0 when the root is a point.
    ///
    /// Squared diagonals instead of areas or volumes, which vanish for flat and thin boxes.
    pub(crate) fn spread(&self) -> f64 {
        let squared_radius = |id: u32| f64::from(self.nodes[id as usize].obb.squared_radius());
        let Some(root) = self.root.map(squared_radius).filter(|&squared| squared > 0.0) else {
            return 0.0;
        };
        self.leaves().map(|leaf| squared_radius(leaf.id().0)).sum::<f64>() / root
    }
}

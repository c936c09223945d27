//! What became of the positions of an index since its tree was built.

use cloudtouch_geom::Point3;

use crate::error::NoiseError;
use crate::index::entries::{PointTree, Threads, tree_of};

/// A position that is not there any more.
pub(crate) const GONE: u32 = u32::MAX;
/// The share of the positions of a tree that may be gone or have come before a new one is better.
const MOST_CHANGED: f64 = 0.25;

/// What became of the positions of a tree.
#[derive(Debug)]
pub(crate) struct Overlay {
    /// By item of the tree: the index that the position has now.
    pub(crate) now: Vec<u32>,
    /// The positions that came, by their indices now.
    pub(crate) added: PointTree,
    pub(crate) added_count: usize,
}

impl Overlay {
    /// After another change to an index of so many positions, each an item of its own in a tree that was
    /// built for it, or under what became of that earlier: `before` says of each point of now which
    /// index it had, if it is where it was. `None` where too much has changed.
    pub(crate) fn after(
        earlier: Option<&Self>,
        count: usize,
        points: &[Point3],
        before: &[Option<u32>],
    ) -> Result<Option<Self>, NoiseError> {
        let mut after = vec![GONE; count];
        for (index, before) in (0..).zip(before) {
            if let Some(slot) = before.and_then(|before| after.get_mut(before as usize)) {
                *slot = index;
            }
        }
        let now: Vec<u32> = match earlier {
            None => after,
            Some(earlier) => {
                let after = |&index: &u32| after.get(index as usize).copied().unwrap_or(GONE);
                earlier.now.iter().map(after).collect()
            }
        };
        let mut is_in_tree = vec![false; points.len()];
        let kept = now.iter().filter(|index| **index != GONE);
        kept.for_each(|&index| is_in_tree[index as usize] = true);
        let came = (0..).zip(&is_in_tree).filter(|(_, is_in_tree)| !**is_in_tree);
        let added: Vec<u32> = came.map(|(index, _)| index).collect();
        let gone = now.len() + added.len() - points.len();
        if (gone + added.len()) as f64 > MOST_CHANGED * now.len() as f64 {
            return Ok(None);
        }
        Ok(Some(Self {
            now,
            added: tree_of(points, &added, Threads::All)?,
            added_count: added.len(),
        }))
    }
}

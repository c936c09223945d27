//! Traversal of one tree: the caller says where to go on.

use crate::{Node, Tree};

/// What to do below a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Visit {
    /// Visit its children, if it has any.
    Descend,
    /// Leave out everything below it.
    Prune,
}

impl Tree {
    /// Hands the nodes to `visit` from the root down, parents before children.
    ///
    /// For a query of one tree against anything that is not a tree. To test against a signed
    /// distance, for instance: prune a node when the distance at `obb().centre` exceeds
    /// `obb().radius() + shift()` and the deviations wanted.
    pub fn visit_nodes(&self, mut visit: impl FnMut(Node<'_>) -> Visit) {
        let mut stack: Vec<Node<'_>> = self.root().into_iter().collect();
        while let Some(node) = stack.pop() {
            if visit(node) == Visit::Descend
                && let Some([left, right]) = self.nodes[node.id as usize].children()
            {
                stack.extend([right, left].map(|id| Node { tree: self, id }));
            }
        }
    }
}

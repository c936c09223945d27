//! What of a mesh a leaf of a cloud was compared with.

use cloudtouch_bvh::NodeId;

/// Where most of so many leaves of a mesh that a leaf of a cloud was compared with first are small beside it, it is
/// compared with all of the mesh.
pub(in crate::search) const FEW: usize = 8;

/// What of a mesh the pieces of a leaf were compared with.
#[derive(Debug, Default)]
pub(in crate::search) enum Compared {
    #[default]
    Nothing,
    First(Box<First>),
    /// With one leaf after another.
    OneByOne,
    WithAll,
}

/// The first leaves of a mesh that a search came by.
#[derive(Debug, Default)]
pub(in crate::search) struct First {
    leaves: [Option<NodeId>; FEW],
    seen: usize,
    /// So many of them are small beside the leaf of the cloud.
    small: usize,
}

impl Compared {
    /// Notes one more leaf. Those that it was compared with where it is to be with all of the mesh now, as once `few`
    /// were seen and most of them are small.
    pub(super) fn next(&mut self, id: NodeId, is_small: bool, few: usize) -> Option<Vec<NodeId>> {
        if matches!(self, Self::Nothing) {
            *self = Self::First(Box::default());
        }
        let Self::First(first) = self else { return None };
        let First { leaves, seen, small } = &mut **first;
        if let Some(next) = leaves.get_mut(*seen) {
            *next = Some(id);
        }
        *seen += 1;
        *small += usize::from(is_small);
        if *seen < few {
            return None;
        }
        let known = (2 * *small > *seen).then(|| leaves.iter().flatten().copied().collect());
        *self = if known.is_some() { Self::WithAll } else { Self::OneByOne };
        known
    }
}

//! Families of scenes for judging accuracy: two bodies, exact truth, fresh observations.
//!
//! A family is a kind of contact; a seed draws one variant of it, with sizes of its own. Scenes are
//! of furniture size, so that clouds of ten thousand points are 1.5 to 3 cm apart (the furniture
//! family and the room of the piano: coarser, the table seen by a camera: finer).

mod depth_view;
mod furniture;
mod grasp;
mod interlocked;
mod labels;
mod motion;
mod observe;
mod piano_room;
mod primitives;
mod seen;
mod tabletop;

pub use observe::{Observation, Side};

use crate::exact::{ExactMesh, Touch};
use motion::Motion;
use observe::Seen;

/// A kind of contact between two bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// A grand piano in a furnished room, both about half size.
    PianoRoom,
    /// A depth image of household objects on a table, and a two-finger gripper.
    Tabletop,
    /// A ball on a thick plate.
    SphereAndPlane,
    /// A triangular prism, its edge or a corner of it ahead, on a thick plate.
    WedgeAndPlane,
    /// Two open sheets without thickness.
    CrossingSheets,
    /// A round peg in a round hole, 1 to 6 cm wider in radius, tilted and displaced.
    PegInHole,
    /// Two tori, most often linked as in a chain.
    InterlockedTori,
    /// A board 2 cm thick against a box, a wedge or another board.
    ThinSlab,
    /// Tables, shelves, chairs and racks in two rows up to 4 m long, against two of them side by
    /// side.
    Furniture,
}

impl Family {
    /// Every family.
    pub const ALL: &[Self] = &[
        Self::PianoRoom,
        Self::Tabletop,
        Self::SphereAndPlane,
        Self::WedgeAndPlane,
        Self::CrossingSheets,
        Self::PegInHole,
        Self::InterlockedTori,
        Self::ThinSlab,
        Self::Furniture,
    ];

    /// Its name in tables: lower case, words joined by hyphens.
    pub fn name(self) -> &'static str {
        match self {
            Self::PianoRoom => "piano-room",
            Self::Tabletop => "tabletop",
            Self::SphereAndPlane => "sphere-and-plane",
            Self::WedgeAndPlane => "wedge-and-plane",
            Self::CrossingSheets => "crossing-sheets",
            Self::PegInHole => "peg-in-hole",
            Self::InterlockedTori => "interlocked-tori",
            Self::ThinSlab => "thin-slab",
            Self::Furniture => "furniture",
        }
    }

    /// The variant that belongs to a seed.
    pub fn scene(self, seed: u64) -> FamilyScene {
        match self {
            Self::PianoRoom => piano_room::scene(seed),
            Self::Tabletop => tabletop::scene(seed),
            Self::SphereAndPlane => primitives::sphere_and_plane(seed),
            Self::WedgeAndPlane => primitives::wedge_and_plane(seed),
            Self::CrossingSheets => primitives::crossing_sheets(seed),
            Self::PegInHole => interlocked::peg_in_hole(seed),
            Self::InterlockedTori => interlocked::tori(seed),
            Self::ThinSlab => primitives::thin_slab(seed),
            Self::Furniture => furniture::scene(seed),
        }
    }
}

/// One variant of a family.
pub struct FamilyScene {
    /// The body that stays; its frame is the scene's. Truth is taken from the whole of it, also
    /// where no sensor sees it.
    pub a: ExactMesh,
    /// The body that moves, in its own frame.
    pub b: ExactMesh,
    /// What counts as a collision of the two.
    pub touch: Touch,
    /// How A and B are observed.
    seen: [Seen; 2],
    motion: Motion,
}

//! The families by name.

use super::{
    bin, bookcase, desk, doorway, furniture, interlocked, kitchen, living_room, piano_room,
    primitives, scene::FamilyScene, setting_down, staircase, tabletop, workbench,
};

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
    /// The corner of a living room with sofa, armchair, lamp, shelf, plant and low table, about half
    /// size; a crate, a chair or a segment of a robot's arm.
    LivingRoom,
    /// A desk with monitor, keyboard, lamp, cups and books before a wall; a gripper or a carton.
    Desk,
    /// A kitchen counter with sink, tap, pots, pans, bowls and bottles; a gripper, empty or with a
    /// bottle in its fingers.
    Kitchen,
    /// A workbench with vice, pipes, elbows, rings, springs and hooks; a drill or a bent bar.
    Workbench,
    /// Jumbled cartons in an open bin; a suction gripper or one more carton.
    BoxesInBin,
    /// A doorway at the end of a corridor with an open door, a bollard and a trolley, about half
    /// size; a mobile robot of the same scale, driving 3.5 to 6 cm above the floor.
    Doorway,
    /// A staircase with rail and wall at 60 to 80 % of full size; a carried box or a wheelchair.
    Staircase,
    /// Cartons, boards, trays and round things set down flat on a table, a shelf or the floor, or put
    /// against a wall: faces along one another.
    SettingDown,
    /// Books and things on the boards of a bookcase; a book or a carton set down between them, or a
    /// gripper.
    Bookcase,
}

/// What a family is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// What users ask about: rooms, furniture, household things, tools.
    Ordinary,
    /// Shapes that are hard for a reason: no thickness, two near faces, contact all around.
    Adversarial,
    /// With meshes of real things, see [`Real`](super::Real).
    Real,
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
        Self::LivingRoom,
        Self::Desk,
        Self::Kitchen,
        Self::Workbench,
        Self::BoxesInBin,
        Self::Doorway,
        Self::Staircase,
        Self::SettingDown,
        Self::Bookcase,
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
            Self::LivingRoom => "living-room",
            Self::Desk => "desk",
            Self::Kitchen => "kitchen",
            Self::Workbench => "workbench",
            Self::BoxesInBin => "boxes-in-bin",
            Self::Doorway => "doorway",
            Self::Staircase => "staircase",
            Self::SettingDown => "setting-down",
            Self::Bookcase => "bookcase",
        }
    }

    /// Whether users live in it, or it is there to find faults.
    pub fn kind(self) -> Kind {
        match self {
            Self::SphereAndPlane
            | Self::WedgeAndPlane
            | Self::CrossingSheets
            | Self::PegInHole
            | Self::InterlockedTori
            | Self::ThinSlab => Kind::Adversarial,
            Self::PianoRoom
            | Self::Tabletop
            | Self::Furniture
            | Self::LivingRoom
            | Self::Desk
            | Self::Kitchen
            | Self::Workbench
            | Self::BoxesInBin
            | Self::Doorway
            | Self::Staircase
            | Self::SettingDown
            | Self::Bookcase => Kind::Ordinary,
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
            Self::LivingRoom => living_room::scene(seed),
            Self::Desk => desk::scene(seed),
            Self::Kitchen => kitchen::scene(seed),
            Self::Workbench => workbench::scene(seed),
            Self::BoxesInBin => bin::scene(seed),
            Self::Doorway => doorway::scene(seed),
            Self::Staircase => staircase::scene(seed),
            Self::SettingDown => setting_down::scene(seed),
            Self::Bookcase => bookcase::scene(seed),
        }
    }
}

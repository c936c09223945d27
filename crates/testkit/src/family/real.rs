//! Families of real meshes, for whoever has the files: the caller reads them.

use cloudtouch_geom::TriangleMesh;

use super::{bin, desk, kitchen, place::placed, scene::FamilyScene};
use crate::exact::Touch;

/// What the families below are made of, as the files have it, m.
pub struct RealMeshes {
    /// A grand piano, open or closed: `piano_m.stl`, `piano_closed_m.stl`.
    pub piano: TriangleMesh,
    /// A furnished room of 6 m × 6 m × 3 m, open: `room_m.stl`.
    pub room: TriangleMesh,
    /// A gripper, closed, x out of its palm: `pr2_gripper_lowres.stl`.
    pub pr2_gripper: TriangleMesh,
    /// A hand, closed, z out of its palm: `panda_hand.obj`.
    pub panda_hand: TriangleMesh,
}

/// A family whose bodies, or the moving one of them, are not of our own design.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Real {
    /// The piano in the room, both at 40 % of full size and wholly seen; open surfaces, of which a
    /// crossing counts.
    PianoInRoom,
    /// [`Family::Kitchen`](super::Family::Kitchen) with the PR2's gripper.
    Pr2InKitchen,
    /// [`Family::BoxesInBin`](super::Family::BoxesInBin) with the PR2's gripper.
    Pr2InBin,
    /// [`Family::Desk`](super::Family::Desk) with the Panda's hand.
    PandaAtDesk,
}

impl Real {
    /// Every one; all are ordinary.
    pub const ALL: &[Self] =
        &[Self::PianoInRoom, Self::Pr2InKitchen, Self::Pr2InBin, Self::PandaAtDesk];

    /// Its name in tables, unlike that of any [`Family`](super::Family).
    pub fn name(self) -> &'static str {
        match self {
            Self::PianoInRoom => "real-piano-room",
            Self::Pr2InKitchen => "real-pr2-kitchen",
            Self::Pr2InBin => "real-pr2-bin",
            Self::PandaAtDesk => "real-panda-desk",
        }
    }

    /// The variant that belongs to a seed: what is ours in it differs, and where paths lead.
    pub fn scene(self, meshes: &RealMeshes, seed: u64) -> FamilyScene {
        match self {
            Self::PianoInRoom => {
                let [room, piano] =
                    [&meshes.room, &meshes.piano].map(|mesh| mesh.clone().scaled(0.4));
                FamilyScene::of_meshes(&room, &piano, Touch::Surfaces, seed)
            }
            Self::Pr2InKitchen => kitchen::with_hand(&z_ahead(&meshes.pr2_gripper), seed),
            Self::Pr2InBin => bin::with_hand(&z_ahead(&meshes.pr2_gripper), seed),
            Self::PandaAtDesk => desk::with_hand(&meshes.panda_hand, seed),
        }
    }
}

/// Turned so that what was along x is along z.
fn z_ahead(mesh: &TriangleMesh) -> TriangleMesh {
    placed(mesh, [0.0; 3], [0.0, -std::f64::consts::FRAC_PI_2, 0.0])
}

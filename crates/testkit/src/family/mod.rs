//! Families of scenes for judging accuracy: two bodies, exact truth, fresh observations.
//!
//! A family is a kind of contact; a seed draws one variant of it, with sizes of its own. Scenes are
//! of furniture size, so that clouds of ten thousand points are 1 to 3 cm apart (the furniture
//! family and the room of the piano: coarser, the table seen by a camera and hands: finer).

mod bin;
mod bookcase;
mod depth_view;
mod desk;
mod doorway;
mod draw_poses;
mod ends;
mod furniture;
mod grasp;
mod guided;
mod hands;
mod interlocked;
mod kinds;
mod kitchen;
mod living_room;
mod lounge;
mod motion;
mod observation;
mod pair;
mod piano_room;
mod pieces;
mod place;
mod primitives;
mod real;
mod scene;
mod seeing;
mod seen;
mod setting_down;
mod staircase;
mod tabletop;
mod tools;
mod vessels;
mod wanted;
mod workbench;

pub use kinds::{Family, Kind};
pub use observation::{Observation, Side};
pub use real::{Real, RealMeshes};
pub use scene::FamilyScene;

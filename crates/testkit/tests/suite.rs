//! All tests of this crate's interface, one module a behaviour: one program to link.

mod camera;
mod exact;
mod family_observations;
mod family_poses;
mod family_real;
mod goodness_of_fit;
mod hard_cases;
mod scenes;
mod stability;

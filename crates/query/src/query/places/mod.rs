//! Where the bodies touch, and how far apart they are there.

pub(super) mod contacts;
mod parting;
pub(super) mod points;
pub(super) mod spots;

//! How near the surfaces are, and how deep one body is inside the other.

pub(super) mod beyond;
pub(super) mod compared;
mod deepest_first;
pub(super) mod inside;
pub(super) mod nearest;
pub(super) mod settled;

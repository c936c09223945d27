//! What an answer does where the object moves: slopes, ways out, and poses that are uncertain.

mod directions;
mod gap_by_pose;
pub(super) mod gradient;
mod misclassified_by_pose;
mod nearing;
pub(super) mod penetration;
pub(super) mod uncertain;

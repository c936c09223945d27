//! What keeps a query from a decision.

use serde::Serialize;

/// Why a verdict is [`Verdict::Undecided`](crate::Verdict::Undecided).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Undecided {
    /// More of a body's surface than [`Safeguards::max_unseen`](crate::Safeguards::max_unseen) lies
    /// where the single depth image of the other saw nothing: see [`Unseen`](crate::Unseen).
    Unseen,
    /// The surface of a cloud, or of a mesh that is closed but for a few triangles, is all around the other
    /// body: it is in a hollow space, or within a solid. A cloud that knows where its sensor stood tells which,
    /// and a mesh whose holes are filled.
    Enclosed,
    /// Sizes or distance of the bodies cannot be meant: one of them is in another unit.
    Units,
    /// One body fits between the points of the other, or these lie in clumps with nothing known between.
    Sparse,
    /// The noise stated for a cloud is larger than the other body, or far larger than its points have and
    /// not small beside the other body.
    Noise,
    /// The points of a cloud span no surface: they are on a line, or are one.
    NoSurface,
    /// Too many rows of a cloud without image layout have no return, or were taken for the robot itself: what
    /// is there is not known.
    Missing,
    /// The sensor stated for a cloud cannot have seen it.
    Sensor,
    /// A classifier could not be trained.
    Unsolved,
    /// What was culled, cut short by a deadline, or too noisy to be told apart could still collide.
    Bounds,
}

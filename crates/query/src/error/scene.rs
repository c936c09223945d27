//! Why a scene cannot be changed as asked.

use cloudtouch_geom::message::number;

/// Why a scene cannot be changed as asked; it is left as it was.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// Two bodies of one name.
    #[error("the scene has a body named `{name}`: give the new one another name, or replace it")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// No body has this name.
    #[error("the scene has no body named `{name}`: add it first, unless it was removed already")]
    UnknownName {
        /// The name.
        name: String,
    },
    /// A pose has an entry that is NaN, infinite, or a translation beyond 1e10 m.
    #[error(
        "the pose of `{name}` contains {}: every entry must be finite, and at most 1e10 m",
        number(*value)
    )]
    Pose {
        /// Whose pose.
        name: String,
        /// What was found.
        value: f64,
    },
    /// A body would move with itself.
    #[error(
        "`{name}` cannot be attached to `{to}`, which moves with `{name}`: detach `{to}` first, or \
         attach to another body"
    )]
    Circle {
        /// What was to be attached.
        name: String,
        /// To what: itself, or something attached to it.
        to: String,
    },
    /// A body that others move with is to be removed.
    #[error("`{attached}` is attached to `{name}`: detach or remove it before `{name}`")]
    HoldsOthers {
        /// What was to be removed.
        name: String,
        /// The first body attached to it.
        attached: String,
    },
    /// A body that moves with none is to be detached.
    #[error("`{name}` is attached to no body: there is nothing to detach it from")]
    NotAttached {
        /// What was to be detached.
        name: String,
    },
    /// A pair of one body.
    #[error("`{name}` and itself are no pair: allow two bodies to touch")]
    OneBody {
        /// The name.
        name: String,
    },
    /// A body is to be changed that somebody else holds too.
    #[error("the body of `{name}` is shared: drop the other holders, or put another in its place")]
    Shared {
        /// The name.
        name: String,
    },
}

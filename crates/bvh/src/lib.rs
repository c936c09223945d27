#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod build;
mod change;
mod error;
mod gap;
mod queue;
mod settings;
mod surfaces;
mod traverse;
mod tree;

/// Points, covariances and poses, of which primitives are made.
pub use cloudtouch_geom as geom;

pub use change::patch::Patched;
pub use error::TreeError;
pub use gap::{Gap, signed_gap};
pub use settings::{Split, Traversal, TraversalSettings, TreeSettings};
pub use surfaces::settled::Settled;
pub use surfaces::sought::{Sought, SurfaceOutcome};
pub use surfaces::{SurfaceFlow, SurfacePair, urgency_of_roots, visit_surfaces};
pub use traverse::{Flow, LeafPair, Outcome, traverse};
pub use tree::Tree;
pub use tree::bounds::LeafBounds;
pub use tree::moments::Moments;
pub use tree::node::NodeId;
pub use tree::obb::Obb;
pub use tree::primitive::Primitive;
pub use tree::primitives::Primitives;
pub use tree::view::Node;
pub use tree::visit::Visit;

#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod apart;
mod bounding;
mod bounds;
mod bounds_list;
mod build;
mod coverage;
mod error;
mod examine;
mod fit;
mod gap;
mod insert;
mod leakage;
mod moments;
mod node;
mod obb;
mod parts;
mod patch;
mod primitive;
mod primitives;
mod queue;
mod refit;
mod remove;
mod settings;
mod surfaces;
mod traverse;
mod tree;
mod validate;
mod view;
mod visit;

pub use bounds::LeafBounds;
pub use error::TreeError;
pub use gap::{Gap, signed_gap};
pub use moments::Moments;
pub use node::NodeId;
pub use obb::Obb;
pub use patch::Patched;
pub use primitive::Primitive;
pub use primitives::Primitives;
pub use settings::{Traversal, TraversalSettings, TreeSettings};
pub use surfaces::{
    Sought, SurfaceFlow, SurfaceOutcome, SurfacePair, urgency_of_roots, visit_surfaces,
};
pub use traverse::{Flow, LeafPair, Outcome, traverse};
pub use tree::Tree;
pub use view::Node;
pub use visit::Visit;

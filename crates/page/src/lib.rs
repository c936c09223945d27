#![doc = include_str!("../README.md")]
#![warn(clippy::print_stdout, clippy::print_stderr)]

mod answer;
mod body;
mod cast;
mod coarse;
mod data;
mod document;
mod encode;
mod escape;
mod fact;
mod facts;
mod inside;
mod likely;
mod of_scene;
mod page;
mod share;
mod shortlist;
mod thin;
mod upright;
mod view;
pub mod words;

pub use body::{Body, Shape};
pub use cast::Cast;
pub use document::notebook_frame;
pub use fact::Fact;
pub use inside::larger_of_both;
pub use page::Page;
pub use shortlist::Shortlist;
pub use view::{Asked, Standing, View};

/// Points of all clouds of a page together; beyond it clouds are thinned, large ones more than small ones.
pub const MOST_POINTS: usize = 300_000;

/// Triangles of all meshes of a page together; beyond it meshes are drawn coarser.
pub const MOST_TRIANGLES: usize = 150_000;

/// Points with a probability of their own in all views together; beyond it the likeliest are told.
pub const MOST_LIKELY: usize = 200_000;

/// Views that a page is meant for: what gathers more keeps those that are the likeliest to collide.
pub const MOST_VIEWS: usize = 500;

//! What can be wrong with the input, in words.

mod change;
mod filter;
mod prepare;
mod query;
mod scene;

pub use change::ChangeError;
pub use filter::FilterError;
pub use prepare::PrepareError;
pub use query::{QueryError, SettingsError, SubdivisionError};
pub use scene::SceneError;

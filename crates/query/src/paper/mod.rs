//! The paper's algorithm, whole: Pan, Chitta and Manocha, "Probabilistic Collision Detection between
//! Noisy Point Clouds using Robust Classification" (ISRR 2011).
//!
//! Each point stands for a normal distribution (sections 4.1 and 4.2), pairs of tree nodes are
//! descended by chance (section 5), each pair of leaves is separated by a robust classifier (section
//! 4.3), and the probabilities of points on the wrong side of it are pooled (section 4.4).
//!
//! A body prepared here cannot be asked on the default path, nor the other way round; a
//! [`Mesh`](crate::Mesh) is exact and can be asked on both.
//!
//! ```compile_fail
//! use cloudtouch::{Cloud, geom::Pose, paper::PaperQuery};
//! fn mixed(query: &PaperQuery, cloud: &Cloud) {
//!     let _ = query.run(cloud, cloud, &Pose::identity());
//! }
//! ```

mod add;
mod body;
mod classify;
mod cloud;
mod cloud_settings;
mod contacts;
mod explain;
mod inside;
mod leaf_pair;
mod leaf_pairs;
mod plane;
mod run;
mod settings;
mod signed;
mod task;
mod tied;
mod weights;

pub use body::PaperBodyRef;
pub use cloud::PaperCloud;
pub use cloud_settings::{PaperCloudSettings, PaperModel, PaperNoise};
pub use explain::{ClassifiedPoint, LeafClassifier};
pub use run::PaperQuery;
pub use settings::{MeshPoints, PaperSettings, Pooling, Scaling};

pub use crate::record::Closeness;
pub use cloudtouch_noise::RadiusRule;
pub use cloudtouch_svm::Kernel;

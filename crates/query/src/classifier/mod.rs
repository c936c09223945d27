//! One robust classifier (sections 4.1 to 4.3 of the paper): its points, its training and the surface
//! it finds. Which points are put before it, and what becomes of its answer, a path decides.

mod clock;
mod pair;
mod settings;
mod surface;
mod train;

pub(crate) use clock::Clock;
pub(crate) use pair::{PairAnswer, PairPoint, PairPoints, centroid};
pub(crate) use settings::ClassifierSettings;
pub(crate) use surface::{SETTLED, Surface};
pub(crate) use train::{Trained, by_kernel};

//! One robust classifier (sections 4.1 to 4.3 of the paper): its points, its training, the surface it
//! finds, and where that says the bodies touch. Which points are put before it, a path decides.

mod clock;
mod contacts;
mod pair;
mod plane;
mod settings;
mod surface;
mod train;

pub(crate) use clock::Clock;
pub(crate) use contacts::most_probable_place;
pub(crate) use pair::{PairAnswer, PairPoint, PairPoints, centroid};
pub(crate) use plane::{Plane, by_plane};
pub(crate) use settings::ClassifierSettings;
#[cfg(test)]
pub(crate) use surface::Surface;
pub(crate) use train::by_kernel;

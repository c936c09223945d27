//! Two pieces of surface: how far apart they are, in metres and in standard deviations.

pub(super) mod facet;
pub(super) mod meeting;
pub(super) mod triangle;
pub(super) mod whitening;

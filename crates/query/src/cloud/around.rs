//! What was measured around a place, whatever surface is made of it.

use cloudtouch_geom::Point3;

use super::prepared::Prepared;

impl Prepared {
    /// Calls `visit` with the places measured at most so far from one, m: of the pieces that the tree is
    /// built over. Local frame.
    pub(crate) fn visit_places_within(
        &self,
        place: &Point3,
        distance: f64,
        mut visit: impl FnMut(&Point3),
    ) {
        let pieces = self.near_pieces();
        pieces.visit_within(place, distance, |near| visit(&pieces.points()[near.index]));
    }
}

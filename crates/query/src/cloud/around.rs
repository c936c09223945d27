//! What was measured around a place, whatever surface is made of it.

use cloudtouch_geom::Point3;

use super::prepared::Prepared;

impl Prepared {
    /// The places measured at most so far from one, m: of the pieces that the tree is built over. Local
    /// frame.
    pub(crate) fn places_within(&self, place: &Point3, distance: f64) -> Vec<Point3> {
        let pieces = self.near_pieces();
        let within = pieces.within(place, distance);
        within.iter().map(|near| pieces.points()[near.index]).collect()
    }
}

//! What was measured around a place, whatever surface is made of it.

use std::f64::consts::PI;

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

    /// Calls `visit` with all places measured at most so far from one, m. Local frame.
    pub(crate) fn visit_measured_within(
        &self,
        place: &Point3,
        distance: f64,
        mut visit: impl FnMut(&Point3),
    ) {
        let points = self.points();
        self.neighborhoods.visit_within(place, distance, |near| visit(&points[near.index]));
    }

    /// The place measured nearest to one, local frame.
    pub(crate) fn measured_nearest(&self, place: &Point3) -> Option<Point3> {
        let nearest = self.neighborhoods.nearest_to(place, 1);
        nearest.first().map(|near| self.points()[near.index])
    }

    /// How far apart samples are about a place in the local frame, m: those of one surface of that density,
    /// whether they lie in clumps or not.
    pub(crate) fn spacing_about(&self, place: &Point3) -> f64 {
        /// Enough that several scans of the same rays have no more in a clump.
        const NEIGHBORS: usize = 64;
        let near = self.neighborhoods.nearest_to(place, NEIGHBORS);
        let reach = near.last().map_or(0.0, |last| last.squared_distance.sqrt());
        reach * (PI / near.len().max(1) as f64).sqrt()
    }
}

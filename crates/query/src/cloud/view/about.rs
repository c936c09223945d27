//! Whether a view saw all places about one.

use cloudtouch_geom::Vector3;

use super::raster::{Raster, Seen};
use super::seen::HOLE_CELLS;
use super::straight::REACH;

/// Cells along the edge of a block, of which the one that was seen least far tells.
const BLOCK: usize = 8;

impl Raster {
    /// Whether it saw all places no farther than a distance (m) from where a ray leads. It may have where this does not
    /// say so: a panorama never does.
    pub(super) fn sees_about(&self, ray: &Vector3, distance: f64) -> bool {
        let Some([low, high]) = self.blocks_about(ray, distance) else { return false };
        let farthest = ray.norm() + distance;
        let seen = &self.seen().blocks;
        let columns = self.grid.size[0].div_ceil(BLOCK);
        (low[1]..=high[1]).all(|y| (low[0]..=high[0]).all(|x| farthest <= seen[y * columns + x]))
    }

    /// The first and the last block that such places are seen in; `None` where some may be beside the view.
    fn blocks_about(&self, ray: &Vector3, distance: f64) -> Option<[[usize; 2]; 2]> {
        let spot = self.lens.spot(ray)?;
        let reach = spot.reach(distance)?;
        let cell_at =
            |sign: f64| self.grid.cell([0, 1].map(|axis| spot.at[axis] + sign * reach[axis]));
        let corners = [cell_at(-1.0)?, cell_at(1.0)?];
        let block = |cell: [isize; 2]| cell.map(|k| k as usize / BLOCK);
        Some(corners.map(block))
    }

    pub(super) fn seen(&self) -> &Seen {
        self.seen.get_or_init(|| self.all_seen())
    }

    fn all_seen(&self) -> Seen {
        let [columns, rows] = self.grid.size;
        let across = columns.div_ceil(BLOCK);
        let mut seen = Seen {
            about: Vec::with_capacity(columns * rows),
            blocks: vec![f64::INFINITY; across * rows.div_ceil(BLOCK)],
        };
        for (y, x) in (0..rows).flat_map(|y| (0..columns).map(move |x| (y, x))) {
            let nearest = self.nearest_about([x as isize, y as isize]);
            let block = &mut seen.blocks[y / BLOCK * across + x / BLOCK];
            *block = block.min(if nearest.is_finite() { nearest } else { 0.0 });
            seen.about.push(nearest);
        }
        seen
    }

    /// The range of the nearest return of a cell and those around it, m; infinite without one.
    fn nearest_about(&self, cell: [isize; 2]) -> f64 {
        let nearest = |cells: &mut dyn Iterator<Item = ([isize; 2], usize)>| {
            cells.map(|(_, cell)| self.cells[cell].nearest()).fold(f64::INFINITY, f64::min)
        };
        let around = nearest(&mut self.grid.around(cell, [HOLE_CELLS.max(REACH); 2]));
        let is_empty = |own: usize| self.cells[own].is_empty();
        if around.is_finite() && self.grid.index(cell[0], cell[1]).is_some_and(is_empty) {
            // Across the hole that it is in.
            return around.min(nearest(&mut self.brink(cell)));
        }
        around
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use cloudtouch_geom::{Point3, unit};
    use nalgebra::UnitQuaternion;
    use proptest::prelude::*;

    use super::*;
    use crate::cloud::view::seen::Sight;

    /// Of 80 by 60 pixels, with a wall aslant, a board before it and some pixels without return.
    fn raster(turn: UnitQuaternion<f64>) -> Raster {
        let ray = |column: usize, row: usize| {
            Vector3::new((column as f64 - 39.5) / 60.0, (row as f64 - 29.5) / 60.0, 1.0)
        };
        let pixels = (0..60).flat_map(|row| (0..80).map(move |column| (column, row)));
        let is_measured = |&(column, row): &(usize, usize)| {
            (column * 31 + row * 17) % 23 > 1
                && !((50..60).contains(&column) && (20..26).contains(&row))
        };
        let depth = |column: usize, row: usize| {
            let aslant = (2.0 + 0.01 * column as f64) / (1.0 + 0.004 * (row as f64 - 47.0));
            if (20..35).contains(&column) { 1.2 } else { aslant }
        };
        let measured = pixels
            .filter(is_measured)
            .map(|(c, r)| (Point3::from(turn.transform_vector(&(ray(c, r) * depth(c, r)))), 0.003));
        Raster::new((&Point3::origin(), &turn, None), measured, &[], [80, 60]).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// By looking at places one by one.
        #[test]
        fn of_what_is_seen_about_a_place_each_place_is(
            turned in prop::array::uniform3(-3.0..3.0_f64),
            place in (-0.7..0.7_f64, -0.5..0.5_f64, 0.1..2.4_f64),
            distance in 0.0..0.4_f64,
            ways in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 60),
        ) {
            let turn = UnitQuaternion::from_euler_angles(turned[0], turned[1], turned[2]);
            let raster = raster(turn);
            let ray = turn.transform_vector(&(Vector3::new(place.0, place.1, 1.0) * place.2));
            if raster.sees_about(&ray, distance) {
                let ways = ways.into_iter().map(Vector3::from).filter(|way| way.norm() > 1e-3);
                for way in ways.filter_map(|way| unit(&way).ok()) {
                    for share in [0.3, 1.0] {
                        let sight = raster.sight(&(ray + way.into_inner() * distance * share));
                        prop_assert_eq!(sight, Sight::Seen);
                    }
                }
            }
        }
    }

    #[test]
    fn it_is_said_of_what_is_well_before_everything_and_of_nothing_near_a_thing_or_a_rim() {
        let raster = raster(UnitQuaternion::identity());
        let sees = |x: f64, z: f64, distance| {
            raster.sees_about(&(Vector3::new(x, 0.3, 1.0) * z), distance)
        };
        assert!(sees(0.3, 0.8, 0.1) && sees(0.3, 1.5, 0.1) && sees(-0.15, 0.9, 0.1));
        // Before the board, behind it, and beside it; past the view, and about the camera.
        assert!(!sees(-0.15, 1.15, 0.1) && !sees(-0.15, 1.5, 0.1) && !sees(0.0, 1.5, 0.2));
        assert!(!sees(0.65, 0.8, 0.1) && !sees(0.3, 0.1, 0.2));
    }
}

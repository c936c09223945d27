//! Which of some points a place is beside.

use std::collections::HashMap;

use cloudtouch_geom::{Point3, Vector3, bounding_box};

/// Which points are within a distance of a place.
#[derive(Debug, Clone)]
pub(super) struct Near {
    points: Vec<Point3>,
    within: f64,
    /// The box around all places that may be as near.
    corners: [Point3; 2],
    /// By cubes as wide as that distance, the points in each and in those that touch it.
    cells: HashMap<[i64; 3], Vec<u32>>,
}

impl Near {
    pub(super) fn of(points: Vec<Point3>, within: f64) -> Self {
        let margin = Vector3::repeat(within);
        let ends = bounding_box(&points).map(|(low, high)| [low - margin, high + margin]);
        let corners = ends.unwrap_or([Point3::from(Vector3::repeat(f64::INFINITY)); 2]);
        let mut near = Self { points, within, corners, cells: HashMap::new() };
        let steps = || -1..=1_i64;
        for index in 0..near.points.len() {
            let [x, y, z] = near.cell(&near.points[index]);
            for (dx, dy, dz) in steps()
                .flat_map(|dx| steps().flat_map(move |dy| steps().map(move |dz| (dx, dy, dz))))
            {
                near.cells.entry([x + dx, y + dy, z + dz]).or_default().push(index as u32);
            }
        }
        near
    }

    fn cell(&self, place: &Point3) -> [i64; 3] {
        [0, 1, 2].map(|k| (place[k] / self.within).floor() as i64)
    }

    /// The points that are as near to a place.
    pub(super) fn to<'a>(&'a self, place: &'a Point3) -> impl Iterator<Item = u32> + 'a {
        let [low, high] = &self.corners;
        let may_be = (0..3).all(|k| low[k] <= place[k] && place[k] <= high[k]);
        let cell = may_be.then(|| self.cells.get(&self.cell(place))).flatten();
        let is_near =
            move |index: &&u32| (self.points[**index as usize] - place).norm() <= self.within;
        cell.into_iter().flatten().filter(is_near).copied()
    }

    /// Of each point whether any of these places is as near to it.
    pub(super) fn with_any_of(&self, places: &[Point3]) -> Vec<bool> {
        let mut has = vec![false; self.points.len()];
        for place in places {
            self.to(place).for_each(|index| has[index as usize] = true);
        }
        has
    }
}

//! On which side of a closed mesh whole cells of space are: what is known of most places without a sum
//! over triangles.

use cloudtouch_geom::{Point3, Vector3};

/// So many cells for each triangle, ...
const CELLS_PER_TRIANGLE: usize = 8;
/// ... but no fewer and no more than these.
const LEAST_CELLS: usize = 4096;
const MOST_CELLS: usize = 32_768;
/// A cell counts as crossed by what misses it by this share of the size of the mesh, far more than
/// rounding.
const ROUNDING: f64 = 1e-9;
/// Rings of cells are counted up to this many: what reaches farther is looked at in parts.
const MOST_RINGS: u8 = 7;

/// What is known of all places of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cell {
    /// The surface may pass through it.
    Crossed,
    Inside,
    /// Outside, as everything in so many rings of cells around it is.
    Outside(u8),
}

/// A grid over the bounding box of a closed mesh.
#[derive(Debug)]
pub(super) struct Cells {
    low: Point3,
    /// Side of a cell, m.
    side: f64,
    counts: [usize; 3],
    cells: Vec<Cell>,
}

impl Cells {
    /// Of triangles without a border between two corners of a box; `is_inside` tells of a place off
    /// the surface. It is asked once for all cells that are joined by their faces: off the surface a
    /// winding number does not change.
    pub(super) fn new(
        triangles: &[[Point3; 3]],
        [low, high]: [Point3; 2],
        is_inside: impl Fn(&Point3) -> bool,
    ) -> Self {
        let extents = high - low;
        let wanted = (CELLS_PER_TRIANGLE * triangles.len()).clamp(LEAST_CELLS, MOST_CELLS);
        let per_axis = (wanted as f64).cbrt().floor();
        let side = extents.amax() / per_axis;
        let count = |extent: f64| ((extent / side).ceil() as usize).clamp(1, per_axis as usize);
        let counts = [0, 1, 2].map(|k| if side > 0.0 { count(extents[k]) } else { 1 });
        let cells = vec![Cell::Outside(0); counts.iter().product()];
        let mut grid = Self { low, side, counts, cells };
        for triangle in triangles {
            grid.cross(triangle, ROUNDING * extents.amax());
        }
        grid.tell_sides(is_inside);
        grid.count_rings();
        grid
    }

    /// What is known of a place within the box.
    pub(super) fn at(&self, place: &Point3) -> Cell {
        self.cells[self.index(self.containing(place))]
    }

    /// How far (m) everything around a place within the box is outside, for certain: less, by up to a
    /// cell, than it is.
    pub(super) fn clear_around(&self, place: &Point3) -> f64 {
        let at = self.containing(place);
        let Cell::Outside(rings) = self.cells[self.index(at)] else { return 0.0 };
        let off = (place - self.low) / self.side;
        let to_border = (0..3).map(|k| {
            let within = off[k] - at[k] as f64;
            within.min(1.0 - within)
        });
        // A place that rounding put beyond its cell is nearer than its border by as much.
        self.side * (f64::from(rings) + to_border.fold(1.0, f64::min) - ROUNDING).max(0.0)
    }

    fn containing(&self, place: &Point3) -> [usize; 3] {
        let off = (place - self.low) / self.side;
        // Negative and NaN become 0.
        [0, 1, 2].map(|k| (off[k] as usize).min(self.counts[k] - 1))
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    fn middle(&self, at: [usize; 3]) -> Point3 {
        self.low + Vector3::from(at.map(|k| k as f64 + 0.5)) * self.side
    }

    /// Marks the cells in the box of a triangle that its plane passes.
    fn cross(&mut self, corners: &[Point3; 3], rounding: f64) {
        let [a, b, c] = corners;
        let room = Vector3::repeat(rounding);
        let first = self.containing(&(a.inf(&b.inf(c)) - room));
        let last = self.containing(&(a.sup(&b.sup(c)) + room));
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
        // What the heights of middles rise by from cell to cell; a triangle without a normal may be
        // anywhere in its box.
        let normal = normal.unwrap_or_else(Vector3::zeros);
        let (rise, reach) = (normal.x * self.side, 0.5 * self.side * normal.lp_norm(1) + rounding);
        for z in first[2]..=last[2] {
            for y in first[1]..=last[1] {
                let start = [first[0], y, z];
                let height = normal.dot(&(self.middle(start) - a));
                let row = self.index(start);
                for (k, cell) in self.cells[row..=row + last[0] - first[0]].iter_mut().enumerate() {
                    if (k as f64).mul_add(rise, height).abs() <= reach {
                        *cell = Cell::Crossed;
                    }
                }
            }
        }
    }

    fn tell_sides(&mut self, is_inside: impl Fn(&Point3) -> bool) {
        let mut is_told = vec![false; self.cells.len()];
        let mut waiting = Vec::new();
        for index in 0..self.cells.len() {
            if is_told[index] || self.cells[index] == Cell::Crossed {
                continue;
            }
            let side = match is_inside(&self.middle(self.place_of(index))) {
                true => Cell::Inside,
                false => Cell::Outside(0),
            };
            is_told[index] = true;
            waiting.push(index);
            while let Some(index) = waiting.pop() {
                self.cells[index] = side;
                let at = self.place_of(index);
                for axis in 0..3 {
                    for next in [at[axis].wrapping_sub(1), at[axis] + 1] {
                        let mut beside = at;
                        beside[axis] = next;
                        if next >= self.counts[axis] {
                            continue;
                        }
                        let beside = self.index(beside);
                        if !is_told[beside] && self.cells[beside] != Cell::Crossed {
                            is_told[beside] = true;
                            waiting.push(beside);
                        }
                    }
                }
            }
        }
    }

    fn place_of(&self, index: usize) -> [usize; 3] {
        let [x, y, _] = self.counts;
        [index % x, index / x % y, index / (x * y)]
    }

    /// Counts along one axis after the other: the rings that are free in all directions are those that
    /// the least free cell of each line of cells leaves.
    fn count_rings(&mut self) {
        // One more than the rings.
        let free = |cell: &Cell| if matches!(cell, Cell::Outside(_)) { MOST_RINGS + 1 } else { 0 };
        let mut free: Vec<u8> = self.cells.iter().map(free).collect();
        let mut step = 1;
        for count in self.counts {
            for start in 0..free.len() {
                if start / step % count == 0 {
                    spread(&mut free, start, step, count);
                }
            }
            step *= count;
        }
        for (cell, free) in self.cells.iter_mut().zip(free) {
            if let Cell::Outside(rings) = cell {
                *rings = free.saturating_sub(1);
            }
        }
    }
}

/// To each cell of a line the least, over all cells of it, of the larger of what is free there and how
/// far that is.
fn spread(free: &mut [u8], start: usize, step: usize, count: usize) {
    let line: Vec<u8> = (0..count).map(|k| free[start + k * step]).collect();
    for (k, &here) in line.iter().enumerate() {
        let mut least = here;
        let mut away = 1;
        while away < least {
            let before = k.checked_sub(usize::from(away)).and_then(|k| line.get(k));
            for &free in [before, line.get(k + usize::from(away))].into_iter().flatten() {
                least = least.min(free.max(away));
            }
            away += 1;
        }
        free[start + k * step] = least;
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use cloudtouch_geom::{Pose, TriangleMesh, seed};
    use cloudtouch_testkit::scene;
    use proptest::prelude::*;

    use super::*;
    use crate::mesh::prepare::Mesh;

    /// Closed ones, turned: of long and of short triangles, with a cavity, of two bodies that overlap, and
    /// a sheet with its own back.
    fn shapes() -> Vec<TriangleMesh> {
        let turned = |mesh: &TriangleMesh| {
            scene::moved(mesh, &Pose::from_translation_rpy(Vector3::zeros(), [0.3, -0.5, 1.1]))
        };
        let inward = |mesh: TriangleMesh| {
            let triangles = mesh.triangles().iter().map(|&[a, b, c]| [a, c, b]).collect();
            TriangleMesh::new(mesh.vertices().to_vec(), triangles).unwrap()
        };
        let there = Pose::from_translation(Vector3::repeat(0.3));
        let overlapping = [scene::cuboid([0.8; 3]), scene::moved(&scene::cuboid([0.5; 3]), &there)];
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let vertices = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
        let faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        vec![
            scene::torus(0.3, 0.1, 48),
            turned(&scene::torus(0.3, 0.1, 13)),
            turned(&scene::cuboid([1.0, 0.2, 0.01])),
            turned(&scene::assemble([scene::cuboid([1.0; 3]), inward(scene::cuboid([0.5; 3]))])),
            turned(&scene::assemble(overlapping)),
            turned(&TriangleMesh::new(vertices.clone(), faces.clone()).unwrap()),
            TriangleMesh::new(vertices, faces).unwrap(),
            turned(&scene::piano()),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn cells_say_what_winding_numbers_and_distances_do(
            places in prop::collection::vec(prop::array::uniform3(0.0..1.0_f64), 200),
        ) {
            for shape in shapes() {
                let mesh = Mesh::prepare(&shape).unwrap();
                let triangles: Vec<_> = (0..mesh.triangle_count()).map(|t| mesh.corners(t)).collect();
                let [low, high] = mesh.corners_of_box();
                let is_inside = |place: &Point3| mesh.winding.plain(place).abs() > 0.5;
                let cells = Cells::new(&triangles, [low, high], is_inside);
                for place in &places {
                    let place = low + Vector3::from(*place).component_mul(&(high - low));
                    let (nearest, _) = mesh.nearest(&place);
                    prop_assert!(cells.clear_around(&place) <= (nearest - place).norm());
                    match cells.at(&place) {
                        Cell::Crossed => {}
                        Cell::Inside => prop_assert!(is_inside(&place)),
                        Cell::Outside(_) => prop_assert!(!is_inside(&place)),
                    }
                }
            }
        }
    }

    /// What is told at once of a way, a closer look bears out; and of most that is clear it is told.
    #[test]
    fn a_way_that_is_surely_clear_is_clear() {
        let (mut sure, mut clear) = (0, 0);
        for shape in shapes() {
            let mesh = Mesh::prepare(&shape).unwrap();
            let [low, high] = mesh.corners_of_box();
            let place = |i: u64| {
                let unit = Vector3::from([0, 1, 2].map(|k| seed::unit(seed::derive(9, i, k))));
                low + (unit * 3.0 - Vector3::repeat(1.0)).component_mul(&(high - low))
            };
            for i in 0..100 {
                let (from, to) = (place(2 * i), place(2 * i + 1));
                let to = from + 0.3 * (to - from);
                let distance = 0.1 * mesh.size() * seed::unit(seed::derive(10, i, 0));
                let is_clear = mesh.is_clear_of_way([&from, &to], distance);
                let is_sure = mesh.is_surely_clear_of_way([&from, &to], distance, 4);
                assert!(is_clear || !is_sure, "{from} to {to}, {distance}");
                sure += usize::from(is_sure);
                clear += usize::from(is_clear);
            }
        }
        assert!(10 * sure > 7 * clear && clear > 400, "{sure} of {clear}");
    }

    #[test]
    fn most_cells_of_a_ball_are_known_and_those_at_its_surface_are_not() {
        let mesh = Mesh::prepare(&scene::sphere(0.4, 4)).unwrap();
        let triangles: Vec<_> = (0..mesh.triangle_count()).map(|t| mesh.corners(t)).collect();
        let cells = Cells::new(&triangles, mesh.corners_of_box(), |p| p.coords.norm() < 0.4);
        let known = cells.cells.iter().filter(|cell| **cell != Cell::Crossed).count();
        assert!(10 * known > 8 * cells.cells.len(), "{known} of {}", cells.cells.len());
        assert_eq!(cells.at(&Point3::origin()), Cell::Inside);
        assert_eq!(cells.at(&Point3::new(0.4, 0.0, 0.0)), Cell::Crossed);
        // A corner of the box is 29 cm off the ball.
        let corner = cells.clear_around(&Point3::new(0.39, 0.39, 0.39));
        assert!((0.1..0.27).contains(&corner), "{corner}");
    }
}

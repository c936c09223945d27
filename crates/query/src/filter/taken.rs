//! What was taken for the robot, and is rather of something beside it.

use std::collections::HashMap;

use cloudtouch_geom::Point3;

use super::self_points::SelfMesh;

/// Standard deviations that noise hardly brings a point off a link.
const CLEARLY: f64 = 3.0;
/// A surface goes on beside the robot where points that stay are within so many paddings.
const GOES_ON: f64 = 1.5;

/// Points within the padding of a link that are farther from it than noise brings them, where points beside them
/// stayed. What the robot's own surface has there because joints or the base are a little off ends with the robot.
#[derive(Debug, Clone)]
pub(crate) struct Taken {
    links: Vec<SelfMesh>,
    /// As wide as the largest padding.
    cells: Cells,
    /// Each with the distance, m, from all links from which on it may be what is there.
    points: HashMap<[i64; 3], Vec<(Point3, f64)>>,
}

impl Taken {
    /// Of points that a filter removed, each with its standard deviation, m, and those that it kept; and the share of
    /// the removed that is farther from every link than any noise brings them. Nothing where none is to be told.
    pub(crate) fn of<'a>(
        removed: impl Iterator<Item = (&'a Point3, f64)>,
        kept: &[Point3],
        robot: &[SelfMesh],
    ) -> (Option<Self>, f64) {
        /// Standard deviations that no noise reaches.
        const DEVIATIONS: f64 = 6.0;
        let widest = robot.iter().map(|link| link.padding).fold(0.0, f64::max);
        let cells = Cells { width: widest };
        let mut points: HashMap<_, Vec<_>> = HashMap::new();
        let (mut all, mut beyond) = (0_usize, 0_usize);
        let links: Vec<_> = robot.iter().map(|link| (link.distances(), link.padding)).collect();
        for (point, std) in removed {
            all += 1;
            let away = links.iter().map(|(distance, padding)| distance(point, *padding));
            let away = away.fold(f64::INFINITY, f64::min);
            beyond += usize::from(away > DEVIATIONS * std);
            if away > CLEARLY * std {
                let entry = (*point, away - CLEARLY * std);
                points.entry(cells.of(point)).or_default().push(entry);
            }
        }
        cells.keep_beside(&mut points, kept);
        let taken = (!points.is_empty()).then(|| Self { links: robot.to_vec(), cells, points });
        (taken, beyond as f64 / all.max(1) as f64)
    }

    /// Whether something may be at a place near the robot, which the filter took for it.
    pub(crate) fn may_be_at(&self, place: &Point3) -> bool {
        let near = |width: f64| {
            let cells = Cells::around(self.cells.of(place)).filter_map(|at| self.points.get(&at));
            cells.flatten().filter(move |(point, _)| (point - place).norm() <= width)
        };
        if near(self.cells.width).next().is_none() {
            return false;
        }
        let away = self.links.iter().map(|link| link.distances()(place, link.padding));
        let away = away.fold(f64::INFINITY, f64::min);
        away.is_finite() && near(self.cells.width).any(|(_, from)| away >= *from)
    }
}

/// A grid of cubes.
#[derive(Debug, Clone, Copy)]
struct Cells {
    width: f64,
}

impl Cells {
    fn of(self, place: &Point3) -> [i64; 3] {
        [0, 1, 2].map(|k| (place[k] / self.width).floor() as i64)
    }

    /// A cell and all that touch it.
    fn around([x, y, z]: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
        let steps = || -1..=1;
        steps().flat_map(move |dx| {
            steps().flat_map(move |dy| steps().map(move |dz| [x + dx, y + dy, z + dz]))
        })
    }

    /// Keeps those with a point that stayed nearby.
    fn keep_beside(self, points: &mut HashMap<[i64; 3], Vec<(Point3, f64)>>, kept: &[Point3]) {
        let within = GOES_ON * self.width;
        let wide = Self { width: within };
        let mut beside: HashMap<[i64; 3], Vec<Point3>> = HashMap::new();
        for (point, _) in points.values().flatten() {
            Self::around(wide.of(point)).for_each(|at| {
                beside.entry(at).or_default();
            });
        }
        if beside.is_empty() {
            return;
        }
        for point in kept {
            if let Some(cell) = beside.get_mut(&wide.of(point)) {
                cell.push(*point);
            }
        }
        let stays = |(point, _): &(Point3, f64)| {
            let near = Self::around(wide.of(point)).filter_map(|at| beside.get(&at)).flatten();
            near.into_iter().any(|kept| (kept - point).norm() <= within)
        };
        points.values_mut().for_each(|of_cell| of_cell.retain(stays));
        points.retain(|_, of_cell| !of_cell.is_empty());
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what cannot be unwrapped fails the test")]
mod tests {
    use std::sync::Arc;

    use cloudtouch_geom::Pose;
    use cloudtouch_testkit::scene;

    use super::*;
    use crate::mesh::Mesh;

    const PADDING: f64 = 0.02;

    /// A bar of 6 by 6 cm whose underside is so high, m.
    fn bar(height: f64) -> SelfMesh {
        let mesh = Arc::new(Mesh::prepare(&scene::cuboid([0.4, 0.06, 0.06])).unwrap());
        let at = nalgebra::Vector3::new(0.0, 0.0, height + 0.03);
        SelfMesh { mesh, cloud_from_link: Pose::from_translation(at), padding: PADDING }
    }

    fn table(link: &SelfMesh) -> [Vec<Point3>; 2] {
        let point =
            |k: i32| Point3::new(0.01 * f64::from(k % 61 - 30), 0.01 * f64::from(k / 61 - 30), 0.0);
        let is_within = link.distances();
        let (near, far): (Vec<_>, Vec<_>) =
            (0..61 * 61).map(point).partition(|p| is_within(p, PADDING).is_finite());
        [near, far]
    }

    #[test]
    fn a_table_under_a_bar_is_there_below_and_nothing_is_above_it() {
        let link = bar(0.008);
        let [removed, kept] = table(&link);
        let with_std = removed.iter().map(|point| (point, 0.001));
        let (taken, share) = Taken::of(with_std, &kept, &[link]);
        let taken = taken.unwrap();
        assert_eq!(share, 1.0);
        let at = |z: f64| taken.may_be_at(&Point3::new(0.1, 0.03, z));
        // On the bar, just below it, in the noise of the table, in the table, and too far from the bar.
        let found = [0.008, 0.005, 0.002, -0.004, -0.03].map(at);
        assert_eq!(found, [false, false, true, true, false]);
        assert!(!taken.may_be_at(&Point3::new(0.1, 0.0, 0.08)), "over the bar");
    }

    #[test]
    fn what_ends_with_the_robot_or_is_within_its_noise_is_the_robot() {
        let link = bar(0.008);
        let [removed, kept] = table(&link);
        let own = [Point3::new(0.0, 0.0, 0.078)];
        let of = |removed: &[Point3], std: f64, kept: &[Point3]| {
            Taken::of(removed.iter().map(|point| (point, std)), kept, std::slice::from_ref(&link)).0
        };
        assert!(of(&removed, 0.01, &kept).is_none());
        assert!(of(&removed, 0.001, &[]).is_none());
        assert!(of(&own, 0.001, &kept).is_none());
        assert!(of(&[], 0.001, &kept).is_none());
    }
}

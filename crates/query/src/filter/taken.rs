//! What was taken for the robot, and is rather of something beside it.

use cloudtouch_geom::Point3;

use super::beside::Near;
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
    /// Which of them are within the largest padding of a place.
    near: Near,
    /// Of each the distance, m, from all links from which on it may be what is there.
    from: Vec<f64>,
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
        let links: Vec<_> = robot.iter().map(|link| (link.distances(), link.padding)).collect();
        let (mut all, mut beyond) = (0_usize, 0_usize);
        let mut points = Vec::new();
        for (point, std) in removed {
            all += 1;
            let mut away = f64::INFINITY;
            for (distance, padding) in &links {
                away = away.min(distance(point, *padding));
                if away <= CLEARLY * std {
                    break;
                }
            }
            beyond += usize::from(away > DEVIATIONS * std);
            if away > CLEARLY * std {
                points.push((*point, away - CLEARLY * std));
            }
        }
        let places = |points: &[(Point3, f64)]| points.iter().map(|(at, _)| *at).collect();
        let mut is_beside =
            Near::of(places(&points), GOES_ON * widest).with_any_of(kept).into_iter();
        points.retain(|_| is_beside.next() == Some(true));
        let taken = (!points.is_empty()).then(|| Self {
            links: robot.to_vec(),
            near: Near::of(places(&points), widest),
            from: points.iter().map(|(_, from)| *from).collect(),
        });
        (taken, beyond as f64 / all.max(1) as f64)
    }

    /// Whether something may be at a place near the robot, which the filter took for it.
    pub(crate) fn may_be_at(&self, place: &Point3) -> bool {
        let from = self.near.to(place).map(|index| self.from[index as usize]);
        let from = from.fold(f64::INFINITY, f64::min);
        if from == f64::INFINITY {
            return false;
        }
        let away = self.links.iter().map(|link| link.distances()(place, link.padding));
        let away = away.fold(f64::INFINITY, f64::min);
        away.is_finite() && away >= from
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

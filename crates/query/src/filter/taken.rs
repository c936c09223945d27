//! What was taken for the robot, and is rather of something beside it.

use std::sync::Arc;

use cloudtouch_geom::{Point3, Vector3, bounding_box};
use cloudtouch_noise::{Neighbor, Neighborhoods, NoiseError};

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
    /// The largest of their paddings, m.
    padding: f64,
    points: Arc<Neighborhoods>,
    /// The box around all places within that padding of the points.
    around: [Point3; 2],
    /// Of each point the distance, m, from all links from which on it may be what is there.
    from: Vec<f64>,
}

impl Taken {
    /// Of points that a filter removed, each with its standard deviation, m, and those that it kept; and the share of
    /// the removed that is farther from every link than any noise brings them. Nothing where none is to be told.
    ///
    /// # Errors
    /// When there are too many of them.
    pub(crate) fn of<'a>(
        removed: impl Iterator<Item = (&'a Point3, f64)>,
        kept: &[Point3],
        robot: &[SelfMesh],
    ) -> Result<(Option<Self>, f64), NoiseError> {
        /// Standard deviations that no noise reaches.
        const DEVIATIONS: f64 = 6.0;
        let padding = robot.iter().map(|link| link.padding).fold(0.0, f64::max);
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
        let share = beyond as f64 / all.max(1) as f64;
        let points = going_on(points, kept, GOES_ON * padding)?;
        let places: Vec<Point3> = points.iter().map(|(at, _)| *at).collect();
        let Some(around) = around(&places, padding) else { return Ok((None, share)) };
        let from = points.iter().map(|(_, from)| *from).collect();
        let points = Arc::new(Neighborhoods::new(places)?);
        Ok((Some(Self { links: robot.to_vec(), padding, points, around, from }), share))
    }

    /// The same of those of its points that are still so; `None` of none.
    ///
    /// # Errors
    /// When there are too many of them.
    pub(crate) fn only(
        &self,
        is_still: impl Fn(&Point3) -> bool,
    ) -> Result<Option<Self>, NoiseError> {
        let all = self.points.points().iter().zip(&self.from);
        let (places, from): (Vec<Point3>, Vec<f64>) = all.filter(|(at, _)| is_still(at)).unzip();
        let Some(around) = around(&places, self.padding) else { return Ok(None) };
        let points = Arc::new(Neighborhoods::new(places)?);
        Ok(Some(Self { links: self.links.clone(), points, around, from, ..*self }))
    }

    /// Whether one of its points is within its padding of a place.
    pub(crate) fn is_about(&self, place: &Point3) -> bool {
        is_in(&self.around, place) && self.points.is_any_within(place, self.padding)
    }

    /// Whether something that the filter took for the robot may be at a place near it, or within a margin (m) of one.
    pub(crate) fn may_be_within(&self, place: &Point3, margin: f64) -> bool {
        let mut from = f64::INFINITY;
        let [low, high] = self.around;
        let room = Vector3::repeat(margin);
        if is_in(&[low - room, high + room], place) {
            let take = |near: Neighbor| from = from.min(self.from[near.index]);
            self.points.visit_within(place, self.padding + margin, take);
        }
        if from == f64::INFINITY {
            return false;
        }
        // Any place within the margin is farther from the links by that at most, and as much nearer.
        let away = self.links.iter().map(|link| link.distances()(place, link.padding + margin));
        let away = away.fold(f64::INFINITY, f64::min);
        away.is_finite() && away + margin >= from
    }
}

/// Those of some points that others are so near to, m.
fn going_on(
    mut points: Vec<(Point3, f64)>,
    others: &[Point3],
    within: f64,
) -> Result<Vec<(Point3, f64)>, NoiseError> {
    let places: Vec<Point3> = points.iter().map(|(at, _)| *at).collect();
    let Some(around) = around(&places, within) else { return Ok(points) };
    let places = Neighborhoods::new(places)?;
    let mut goes_on = vec![false; points.len()];
    for other in others.iter().filter(|other| is_in(&around, other)) {
        places.visit_within(other, within, |near| goes_on[near.index] = true);
    }
    let mut goes_on = goes_on.into_iter();
    points.retain(|_| goes_on.next() == Some(true));
    Ok(points)
}

/// The box around all places so near to some points, m; `None` of none.
fn around(points: &[Point3], within: f64) -> Option<[Point3; 2]> {
    let margin = Vector3::repeat(within);
    bounding_box(points).map(|(low, high)| [low - margin, high + margin])
}

fn is_in([low, high]: &[Point3; 2], place: &Point3) -> bool {
    (0..3).all(|k| low[k] <= place[k] && place[k] <= high[k])
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
        let (taken, share) = Taken::of(with_std, &kept, &[link]).unwrap();
        let taken = taken.unwrap();
        assert_eq!(share, 1.0);
        let at = |z: f64| taken.may_be_within(&Point3::new(0.1, 0.03, z), 0.0);
        // On the bar, just below it, in the noise of the table, in the table, and too far from the bar.
        let found = [0.008, 0.005, 0.002, -0.004, -0.03].map(at);
        assert_eq!(found, [false, false, true, true, false]);
        assert!(!taken.may_be_within(&Point3::new(0.1, 0.0, 0.08), 0.0), "over the bar");
        // From half a centimetre over the table a margin of three millimetres reaches it, and none far from the bar does.
        let near = |z: f64, margin: f64| taken.may_be_within(&Point3::new(0.1, 0.03, z), margin);
        assert!(near(0.005, 0.003) && !near(0.005, 0.001) && !near(0.2, 0.1));
    }

    #[test]
    fn what_ends_with_the_robot_or_is_within_its_noise_is_the_robot() {
        let link = bar(0.008);
        let [removed, kept] = table(&link);
        let own = [Point3::new(0.0, 0.0, 0.078)];
        let of = |removed: &[Point3], std: f64, kept: &[Point3]| {
            Taken::of(removed.iter().map(|point| (point, std)), kept, std::slice::from_ref(&link))
                .unwrap()
                .0
        };
        assert!(of(&removed, 0.01, &kept).is_none());
        assert!(of(&removed, 0.001, &[]).is_none());
        assert!(of(&own, 0.001, &kept).is_none());
        assert!(of(&[], 0.001, &kept).is_none());
    }
}

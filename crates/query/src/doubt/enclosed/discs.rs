//! Directions that end on a surface each of whose samples stands for a disc in its tangent plane. Unlike a ball it
//! covers nothing that is seen along the surface: just above a floor half of all directions are open.

use cloudtouch_bvh::Visit;
use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_noise::Scratch;

use crate::cloud::{DISC_SPACINGS, Prepared, Surfel};

use super::squares::CLOSED;
use super::way::Way;

/// The radius of a disc in spacings: of samples at random a thousandth of a surface is in none.
const RADIUS: f64 = 1.5;
/// Where it is asked whether a sensor sees past them: four in a million are in none.
const RADIUS_BEFORE_SENSOR: f64 = 2.0;
/// A disc of RADIUS that closes a direction in whose square there is no sample is no farther away, in spacings:
/// from the middle of one of the smallest to its side are 11°, which it is as wide as at 8, and spacings vary.
const FARTHEST_BESIDE: f64 = 16.0;

/// This share of the directions from a place of the body's own is closed where they are from its middle: its
/// other places are nearer to the surface, and where samples are few more of them find no disc by chance.
const CLOSED_BESIDE: f64 = 0.94;

/// Of the samples nearest to a place so many tell whether it is on their surface ...
const NEAREST: usize = 20;
/// ... as it is so many standard deviations of a fit from it: discs are all around in there, by chance.
const DEVIATIONS: f64 = 3.0;

/// The surface of a cloud.
pub(super) struct Discs<'a> {
    cloud: &'a Prepared,
    scratch: Scratch,
}

impl<'a> Discs<'a> {
    pub(super) fn of(cloud: &'a Prepared) -> Self {
        Self { cloud, scratch: Scratch::default() }
    }

    /// Whether it closes all but a few of the directions from a place, of which some are `empty` of samples, by
    /// what is near enough to.
    pub(super) fn close_empty(&mut self, place: &Point3, directions: &Directions) -> bool {
        let near = FARTHEST_BESIDE * self.cloud.makeup().spacing;
        self.close(directions.empty.iter(), place, near, directions.most_open(CLOSED))
    }

    /// Whether it closes all but some of the directions from a place near one from which it does.
    pub(super) fn close_all(&mut self, place: &Point3, directions: &Directions) -> bool {
        // Where they are open is found soonest so.
        let all = directions.empty.iter().chain(&directions.filled);
        self.close(all, place, f64::INFINITY, directions.most_open(CLOSED_BESIDE))
    }

    fn close<'d>(
        &mut self,
        directions: impl Iterator<Item = &'d Vector3>,
        place: &Point3,
        length: f64,
        most_open: usize,
    ) -> bool {
        let ways = directions.filter_map(|direction| Way::toward(place, direction, length));
        ways.filter(|way| !self.cross(way, RADIUS)).nth(most_open).is_none()
    }

    /// Whether it lies between two places.
    pub(super) fn part(&mut self, one: &Point3, other: &Point3) -> bool {
        let way = other - one;
        Way::toward(one, &way, way.norm()).is_some_and(|way| self.cross(&way, RADIUS_BEFORE_SENSOR))
    }

    /// Whether a place is on it as well as is known: whether that is a collision tells what is near.
    pub(super) fn hold(&mut self, place: &Point3) -> bool {
        let near = self.cloud.fits_near(place, NEAREST, &mut self.scratch);
        near.iter().any(|(_, surfel)| is_on(surfel, place))
    }

    /// Whether a disc of this radius, in spacings, is across a way.
    fn cross(&mut self, way: &Way, radius: f64) -> bool {
        let (cloud, scratch) = (self.cloud, &mut self.scratch);
        let mut is_crossed = false;
        cloud.tree().visit_nodes(|node| {
            let reach = node.shift() + radius / DISC_SPACINGS * node.reach();
            if is_crossed || !way.may_pass(&node.obb(), reach) {
                return Visit::Prune;
            }
            if node.is_leaf() {
                let is_near = |place: &Point3| way.distance_to(place) <= reach;
                cloud.visit_some_of_leaf(node.id(), is_near, scratch, |_, surfel| {
                    is_crossed = is_crossed || is_across(surfel, radius, way);
                });
            }
            Visit::Descend
        });
        is_crossed
    }
}

/// Whether the disc about a sample, of a radius in spacings, is across a way; one without a normal is not.
fn is_across(surfel: &Surfel, radius: f64, way: &Way) -> bool {
    let place = surfel.normal.and_then(|normal| way.meets_plane(&surfel.point.mean, &normal));
    place.is_some_and(|place| (place - surfel.point.mean).norm() <= radius * surfel.spacing)
}

fn is_on(surfel: &Surfel, place: &Point3) -> bool {
    surfel.normal.is_some_and(|normal| {
        let offset = place - surfel.point.mean;
        let across = normal.dot(&offset);
        across.abs() <= DEVIATIONS * surfel.across.sqrt()
            && (offset - across * normal).norm() <= RADIUS * surfel.spacing
    })
}

/// Directions all around, told apart by whether there are samples in them.
pub(super) struct Directions {
    filled: Vec<Vector3>,
    empty: Vec<Vector3>,
}

impl Directions {
    pub(super) fn new(all: impl Iterator<Item = Vector3>, hold: impl Fn(&Vector3) -> bool) -> Self {
        let (filled, empty) = all.partition(hold);
        Self { filled, empty }
    }

    fn most_open(&self, closed: f64) -> usize {
        ((1.0 - closed) * (self.filled.len() + self.empty.len()) as f64) as usize
    }
}

//! What an image knows of places.

use cloudtouch_geom::{Point3, Vector3};

use super::image::Image;
use super::raster::Raster;
use super::seen::Sight;

/// How far away what is too near to be trusted counts as seen, m.
pub(in crate::cloud) const AT_SENSOR: f64 = 1e-3;

/// What hides a place from a camera.
#[derive(Debug, Clone, Copy)]
pub(in crate::cloud) enum Hiding {
    /// The robot itself: nothing is known to have come.
    Robot,
    /// What is there, and its standard deviation, m.
    Thing(Point3, f64),
    /// Nothing all around the place's direction, or what is too near to be trusted.
    Unknown,
}

/// A view with its raster, all in the cloud's local frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seeing<'a> {
    pub(super) image: &'a Image,
    pub(super) raster: &'a Raster,
}

impl Seeing<'_> {
    /// What is known by the image of a place in a body of such a breadth, m. Where the robot itself was there was nothing
    /// else, whatever the camera saw.
    pub(crate) fn sight(&self, place: &Point3, breadth: f64) -> Sight {
        let sight = self.sight_of_returns(place, breadth);
        if sight != Sight::Seen && self.was_robot(place) { Sight::Seen } else { sight }
    }

    /// The same by what the camera measured alone.
    pub(crate) fn sight_of_returns(&self, place: &Point3, breadth: f64) -> Sight {
        let ray = place - self.image.sensor_origin;
        match self.raster.sight(&ray) {
            Sight::Seen if self.is_coarse(&ray, breadth) => Sight::Hole,
            sight => sight,
        }
    }

    /// Whether the camera saw all places no farther than a distance (m) from one, for bodies of such a breadth, m; it may
    /// have where this does not say so.
    pub(crate) fn sees_about(&self, place: &Point3, distance: f64, breadth: f64) -> bool {
        let ray = place - self.image.sensor_origin;
        let is_coarse = |pixel: f64| pixel * (ray.norm() + distance) > breadth;
        !self.pixel().is_some_and(is_coarse) && self.raster.sees_about(&ray, distance)
    }

    /// Whether a body of such a breadth, m, fits between what pixels saw about a place, or lines of a scanner: nothing
    /// that it could hit need have been met.
    fn is_coarse(&self, ray: &Vector3, breadth: f64) -> bool {
        self.raster.apart(ray).is_some_and(|apart| apart * ray.norm() > breadth)
    }

    /// Whether the camera looked past a place with this standard deviation (m): all that it met in its direction and
    /// around it, or the plane that this is on, is clearly behind it.
    pub(in crate::cloud) fn looks_past(&self, place: &Point3, std: f64) -> bool {
        let ray = place - self.image.sensor_origin;
        self.raster.looks_past(&ray, std) || self.raster.is_before_plane(&ray, std)
    }

    /// What hides a place that is behind returns.
    pub(in crate::cloud) fn hiding(&self, place: &Point3) -> Hiding {
        let ray = place - self.image.sensor_origin;
        let Some([range, std]) = self.raster.hiding(&ray) else { return Hiding::Unknown };
        let thing = self.image.sensor_origin + ray.normalize() * range;
        if self.was_robot(&thing) {
            Hiding::Robot
        } else if range > 2.0 * AT_SENSOR {
            Hiding::Thing(thing, std)
        } else {
            Hiding::Unknown
        }
    }

    /// Whether a place that it counts as seen is behind its returns, and behind what another image met so near to it
    /// that this may be the same surface, known better.
    pub(in crate::cloud) fn is_known_better_by(&self, other: &Self, place: &Point3) -> bool {
        let noise = self.raster.behind_by_noise(&(place - self.image.sensor_origin));
        let is_hidden = |noise: f64| match other.hiding(place) {
            Hiding::Thing(thing, _) => (thing - place).norm() <= noise,
            Hiding::Robot | Hiding::Unknown => false,
        };
        noise.is_some_and(is_hidden)
    }

    fn was_robot(&self, place: &Point3) -> bool {
        self.image.robot.iter().any(|link| link.held(place))
    }

    /// Whether it is of the scene as it was after all images before it.
    pub(in crate::cloud) fn is_later(&self) -> bool {
        self.image.is_later
    }

    /// How far apart its pixels are, per metre of distance, if it is no panorama.
    pub(in crate::cloud) fn pixel(&self) -> Option<f64> {
        self.raster.pixel()
    }
}

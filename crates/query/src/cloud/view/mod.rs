//! A single depth image: what its camera did not look at, or not see, was never seen to be empty.

mod about;
mod extent;
mod grid;
mod lens;
mod lines;
pub(super) mod near;
mod past;
pub(super) mod range;
pub(super) mod raster;
mod robot;
pub(super) mod seen;
mod straight;

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use cloudtouch_geom::{Point3, PointCloud, Vector3};
use cloudtouch_noise::SensorNoise;
use nalgebra::UnitQuaternion;

use crate::cloud::view::raster::Raster;
use crate::cloud::view::seen::Sight;
use crate::filter::SelfMesh;

/// How far away what is too near to be trusted counts as seen, m.
pub(super) const AT_SENSOR: f64 = 1e-3;

/// A scan that is a depth image.
#[derive(Debug, Clone)]
pub(super) struct Image {
    /// Where the sensor stood, m, and which way it looked: x right, y down for a camera, z up for a scanner.
    pub sensor_origin: Point3,
    pub turn: UnitQuaternion<f64>,
    /// Which points are its.
    pub points: Range<usize>,
    /// Of a laser scanner, though all may lie ahead, the bearing about z in its frame where those of its view begin, rad.
    pub scanner: Option<f64>,
    /// How many columns and rows of pixels are where these are, those without return too.
    pub pixels: [usize; 2],
    /// The links of the robot that were taken out of it.
    pub robot: Vec<SelfMesh>,
    /// Rays of returns that were left out for their range, up to where they say that there is nothing, m.
    pub beyond: Arc<[Vector3]>,
    /// Returns that are none of the points.
    pub others: Arc<[OtherReturn]>,
    /// Whether it is of the scene as it was after all images before it.
    pub is_later: bool,
}

/// A return that is no point of the cloud and still says how far was seen.
#[derive(Debug, Clone, Copy)]
pub(super) struct OtherReturn {
    /// From the sensor to it, m.
    pub ray: Vector3,
    /// An upper bound of its standard deviations, m.
    pub std: f64,
}

impl Image {
    /// Of an organised cloud, a scanner's or not ([`Self::scanner`]), given what was kept of it, from which rows (none of a
    /// collision map), the links that were taken out, and the rows of what was too far, with their rays, and of others
    /// that are no points.
    pub(super) fn of(
        (scan, scanner): (&PointCloud, Option<f64>),
        (kept, rows): (&PointCloud, &[usize]),
        robot: Vec<SelfMesh>,
        beyond: &[(usize, Vector3)],
        others: &[(usize, OtherReturn)],
    ) -> Self {
        let looked_at = (rows.iter())
            .chain(beyond.iter().map(|(row, _)| row))
            .chain(others.iter().map(|(row, _)| row));
        Self {
            sensor_origin: kept.sensor_origin(),
            turn: *kept.from_sensor().rotation(),
            points: 0..rows.len(),
            scanner,
            pixels: pixels_about(scan, looked_at).unwrap_or([kept.len(), 1]),
            robot,
            beyond: beyond.iter().map(|(_, ray)| *ray).collect(),
            others: others.iter().map(|(_, other)| *other).collect(),
            is_later: false,
        }
    }
}

/// Columns and rows of the part of an image that these of its pixels are in, with and without return.
fn pixels_about<'a>(
    image: &PointCloud,
    mut rows: impl Iterator<Item = &'a usize>,
) -> Option<[usize; 2]> {
    let (width, _) = image.image_size?;
    let at = |row: &usize| [row / width, row % width];
    let first = at(rows.next()?);
    let widen = |[low, high]: [[usize; 2]; 2], row: &usize| {
        let at = at(row);
        [[0, 1].map(|k| low[k].min(at[k])), [0, 1].map(|k| high[k].max(at[k]))]
    };
    let [low, high] = rows.fold([first; 2], widen);
    Some([1, 0].map(|k| high[k] - low[k] + 1))
}

/// Where the sensor stood, and the raster of its view once that is needed.
#[derive(Debug)]
pub(crate) struct SingleView {
    /// In the cloud's local frame.
    image: Image,
    raster: OnceLock<Option<Arc<Raster>>>,
    robot_passed: OnceLock<Option<f64>>,
}

impl SingleView {
    /// Of an image in a frame that lies at `origin` in that of the cloud.
    pub(super) fn new(image: Image, origin: &Vector3) -> Self {
        let sensor_origin = image.sensor_origin - origin;
        let robot = image.robot.iter().map(|link| link.seen_from(origin)).collect();
        let image = Image { sensor_origin, robot, ..image };
        Self { image, raster: OnceLock::new(), robot_passed: OnceLock::new() }
    }

    /// The view over its raster, given what it measured and with which noise; `None` where the measured points have no
    /// directions.
    pub(crate) fn over<'a>(&'a self, measured: (&[Point3], &SensorNoise)) -> Option<Seeing<'a>> {
        Some(Seeing { image: &self.image, raster: self.raster(measured)? })
    }

    /// As [`Seeing::robot_passed`], told when first asked for.
    pub(super) fn robot_passed(&self, measured: (&[Point3], &SensorNoise)) -> Option<f64> {
        let tell = || self.over(measured).and_then(|seeing| seeing.robot_passed());
        if self.image.robot.is_empty() { None } else { *self.robot_passed.get_or_init(tell) }
    }

    fn raster(&self, (points, noise): (&[Point3], &SensorNoise)) -> Option<&Raster> {
        let raster = self.raster.get_or_init(|| {
            let Image { sensor_origin, turn, scanner, pixels, beyond, others, .. } = &self.image;
            let own =
                self.image.points.clone().map(|index| (points[index], noise[index].std_bound()));
            let others = others.iter().map(|other| (sensor_origin + other.ray, other.std));
            let sensor = (sensor_origin, turn, *scanner);
            Raster::new(sensor, own.chain(others), beyond, *pixels).map(Arc::new)
        });
        raster.as_deref()
    }

    /// The same view as it was measured, whatever becomes of its points, in a frame that lies at
    /// `shift` in the old one; `None` where the measured points have no directions.
    pub(super) fn settled(
        &self,
        measured: (&[Point3], &SensorNoise),
        shift: &Vector3,
    ) -> Option<Self> {
        let _made = self.raster(measured)?;
        let none = Image {
            points: 0..0,
            beyond: Arc::default(),
            others: Arc::default(),
            ..self.image.clone()
        };
        let settled = Self::new(none, shift);
        let (raster, robot_passed) = (self.raster.clone(), self.robot_passed.clone());
        Some(Self { raster, robot_passed, ..settled })
    }
}

/// What hides a place from a camera.
#[derive(Debug, Clone, Copy)]
pub(super) enum Hiding {
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
    image: &'a Image,
    raster: &'a Raster,
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

    /// Whether the camera looked past a place with this standard deviation (m), in its direction and in all around it.
    pub(super) fn looks_past(&self, place: &Point3, std: f64) -> bool {
        self.raster.looks_past(&(place - self.image.sensor_origin), std)
    }

    /// What hides a place that is behind returns.
    pub(super) fn hiding(&self, place: &Point3) -> Hiding {
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
    pub(super) fn is_known_better_by(&self, other: &Self, place: &Point3) -> bool {
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
    pub(super) fn is_later(&self) -> bool {
        self.image.is_later
    }

    /// How far apart its pixels are, per metre of distance, if it is no panorama.
    pub(super) fn pixel(&self) -> Option<f64> {
        self.raster.pixel()
    }
}

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Pose, seed};
    use cloudtouch_testkit::camera::DepthCamera;
    use cloudtouch_testkit::exact::ExactMesh;
    use cloudtouch_testkit::scene;

    use super::*;

    const STD: f64 = 0.004;

    /// What is known beyond doubt from all measured points around a ray, looked at one by one.
    fn by_every_ray(points: &[Point3], place: &Point3, pixel: f64) -> Option<Sight> {
        let aside = |p: &Point3| p.coords.angle(&place.coords) / pixel;
        let around = |pixels: f64| points.iter().filter(move |p| aside(p) < pixels);
        let ranges = || around(8.0).map(|p| p.coords.norm());
        let range = place.coords.norm();
        if place.z <= 0.0 {
            Some(Sight::BehindCamera)
        } else if around(14.0).next().is_none() {
            Some(Sight::Hole)
        } else if around(1.0).next().is_none() {
            None
        } else if range < ranges().fold(f64::INFINITY, f64::min) {
            Some(Sight::Seen)
        } else {
            let farthest = ranges().fold(0.0, f64::max);
            (range > farthest + 4.0 * STD).then_some(Sight::BehindReturns)
        }
    }

    /// A block before a wall with a window, from a camera that may be turned any way.
    #[test]
    fn the_raster_says_what_every_single_ray_says() {
        let at = |x: f64, y: f64, z: f64| Pose::from_translation(Vector3::new(x, y, z));
        let part = |size: [f64; 3], pose: &Pose| scene::moved(&scene::cuboid(size), pose);
        let wall = ExactMesh::new(&scene::assemble([
            part([2.0, 4.0, 0.05], &at(-1.3, 0.0, 2.5)),
            part([2.0, 4.0, 0.05], &at(1.3, 0.0, 2.5)),
        ]));
        let block = ExactMesh::new(&part([0.4; 3], &at(-0.4, 0.2, 1.4)));
        let camera = DepthCamera::default();
        let image = camera.scan(&[&wall, &block], &Pose::identity(), 3);
        let seen: Vec<Point3> = image.points.into_iter().filter(|p| p.z.is_finite()).collect();
        let noise = SensorNoise::uniform(Covariance::isotropic(STD * STD), seen.len());
        let mut told = [0; 4];
        for turn in [[0.0; 3], [0.7, -1.1, 2.9], [-2.0, 0.3, 0.4]] {
            let turned = Pose::from_translation_rpy(Vector3::zeros(), turn);
            let points: Vec<Point3> = seen.iter().map(|p| turned.transform_point(p)).collect();
            let image = Image {
                scanner: None,
                sensor_origin: Point3::origin(),
                turn: *turned.rotation(),
                points: 0..points.len(),
                pixels: [points.len(), 1],
                robot: Vec::new(),
                beyond: Arc::default(),
                others: Arc::default(),
                is_later: false,
            };
            let view = SingleView::new(image, &Vector3::zeros());
            let seeing = view.over((&points, &noise)).expect("points with directions");
            for index in 0..700 {
                let unit = |k: u64| 2.0 * seed::unit(seed::derive(7, index, k)) - 1.0;
                let place = Point3::new(2.0 * unit(0), 1.5 * unit(1), 1.5 + 2.0 * unit(2));
                let Some(sure) = by_every_ray(&seen, &place, 1.0 / camera.focal_px) else {
                    continue;
                };
                let found = seeing.sight(&turned.transform_point(&place), f64::INFINITY);
                let agrees = match sure {
                    // Where nothing was measured the reference does not tell a hole from the rim.
                    Sight::Hole => matches!(found, Sight::Hole | Sight::OutsideView),
                    // The camera's back is told from what it measured, not from its axis.
                    Sight::BehindCamera => {
                        matches!(found, Sight::BehindCamera | Sight::OutsideView)
                    }
                    Sight::BehindReturns => found.is_behind(),
                    sure => found == sure,
                };
                assert!(agrees, "{place}: {found:?}, but {sure:?} by every ray");
                told[match sure {
                    Sight::Seen => 0,
                    Sight::BehindCamera => 1,
                    Sight::CloseBehind | Sight::BehindReturns => 2,
                    Sight::Hole | Sight::OutsideView | Sight::OutOfRange => 3,
                }] += 1;
            }
        }
        assert!(told.iter().all(|&count| count > 50), "{told:?}");
    }
}

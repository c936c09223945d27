//! One image with the raster of what it saw.

use std::sync::{Arc, OnceLock};

use cloudtouch_geom::{Point3, Vector3};
use cloudtouch_noise::SensorNoise;

use super::image::Image;
use super::raster::Raster;
use super::seeing::Seeing;

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
    pub(in crate::cloud) fn new(image: Image, origin: &Vector3) -> Self {
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
    pub(in crate::cloud) fn robot_passed(
        &self,
        measured: (&[Point3], &SensorNoise),
    ) -> Option<f64> {
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
    pub(in crate::cloud) fn settled(
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

#[cfg(test)]
mod tests {
    use cloudtouch_geom::{Covariance, Pose, seed};
    use cloudtouch_testkit::camera::DepthCamera;
    use cloudtouch_testkit::exact::ExactMesh;
    use cloudtouch_testkit::scene;

    use super::*;
    use crate::cloud::view::seen::Sight;

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

//! The depth images of the table: fresh rays each time, known noise, veils.

use cloudtouch_geom::{Covariance, Point3, PointCloud, Vector3, seed};
use parry3d_f64::{
    math::Vector,
    query::{Ray, RayCast},
};
use rand::RngExt;

use super::{observation::Observation, seen::in_sight};
use crate::{
    camera::DepthCamera,
    exact::{ExactMesh, parry_vector},
    noise::{NoiseKind, unit_error},
    random::small_rotation,
    surface::{SurfaceSample, scaled_normal},
};

/// Height over width of the image.
const ASPECT: f64 = 0.75;

/// How far the camera turns between images, rad: enough that every image has its own rays.
const UNREST: f64 = 0.01;

/// A camera at the origin of the body's frame, looking along z.
pub(super) struct DepthView {
    /// Half the width of the image at 1 m.
    half_width: f64,
    /// The share of pixels with a return.
    hit_share: f64,
    /// The distance of what is in the middle of the scene, m.
    distance: f64,
}

impl DepthView {
    pub(super) fn new(body: &ExactMesh, half_width: f64, distance: f64) -> Self {
        let mut view = Self { half_width, hit_share: 1.0, distance };
        let hits = view.returns(body, &view.camera(10_000), 0);
        view.hit_share = hits.iter().flatten().count() as f64 / hits.len() as f64;
        view
    }

    pub(super) fn spacing(&self, points: usize) -> f64 {
        self.distance / self.camera(points).focal_px
    }

    /// Every return of an image of about `points` of them, without noise or veil.
    pub(super) fn surface(&self, body: &ExactMesh, points: usize, seed: u64) -> Vec<SurfaceSample> {
        self.returns(body, &self.camera(points), seed).into_iter().flatten().collect()
    }

    /// Whether the camera sees this point of the surface, or nearly (5 mm).
    pub(super) fn sees(&self, body: &ExactMesh, point: &Point3) -> bool {
        let in_image = point.z > 0.0
            && (point.x / point.z).abs() < self.half_width
            && (point.y / point.z).abs() < self.half_width * ASPECT;
        in_image
            && in_sight(body, &Point3::origin(), &(point * (1.0 - 0.005 / point.coords.norm())))
    }

    pub(super) fn observe(
        &self,
        body: &ExactMesh,
        points: usize,
        noise: NoiseKind,
        std: f64,
        [sampling, errors]: [u64; 2],
    ) -> Observation {
        let camera = self.camera(points);
        let mut truth = self.returns(body, &camera, sampling);
        let depths: Vec<f64> = truth.iter().map(|t| t.map_or(f64::NAN, |t| t.position.z)).collect();
        let mut veils = seed::generator(seed::derive(sampling, 0, 1));
        let mut errors = seed::generator(errors);
        let mut cloud =
            PointCloud { image_size: Some((camera.width, camera.height)), ..PointCloud::default() };
        let mut covariances = Vec::new();
        for i in 0..truth.len() {
            // Every pixel draws the same numbers whatever it sees.
            let [chance, mix] = [veils.random::<f64>(), veils.random::<f64>()];
            let error = unit_error(noise, &mut errors).z;
            let Some(sample) = truth[i] else {
                cloud.points.push(Point3::from(Vector3::repeat(f64::NAN)));
                covariances.push(Covariance::isotropic(0.0));
                continue;
            };
            let mut point = sample.position;
            if let Some(other) = camera.depth_across_edge(&depths, i)
                && chance < camera.veil_probability
            {
                truth[i] = None;
                point *= 1.0 + mix * (other / point.z - 1.0);
            }
            // An error as large as the depth itself would put the point behind the camera.
            let ray = point.coords / point.z;
            let depth = (point.z + error * std * point.z * point.z).max(0.1 * point.z);
            cloud.points.push(if std == 0.0 { point } else { Point3::from(ray * depth) });
            let variance = (std * depth * depth).powi(2);
            covariances.push(Covariance::from_symmetric(&(ray * ray.transpose() * variance)));
        }
        cloud.covariances = Some(covariances);
        Observation { cloud, truth, std }
    }

    /// The camera whose image has about so many returns.
    fn camera(&self, points: usize) -> DepthCamera {
        let width = (points as f64 / self.hit_share / ASPECT).sqrt();
        DepthCamera {
            width: width.round() as usize,
            height: (width * ASPECT).round() as usize,
            focal_px: 0.5 * width / self.half_width,
            edge_step: 0.04,
            ..DepthCamera::default()
        }
    }

    /// What each pixel's ray hits, the camera turned a little by the seed.
    fn returns(
        &self,
        body: &ExactMesh,
        camera: &DepthCamera,
        seed: u64,
    ) -> Vec<Option<SurfaceSample>> {
        let turn = small_rotation(UNREST, &mut seed::generator(seed));
        (0..camera.width * camera.height)
            .map(|i| {
                let ray = turn * camera.ray(i % camera.width, i / camera.width);
                first_hit(body, &ray, camera.max_depth)
            })
            .collect()
    }
}

/// The first point of the body on a ray from the origin, up to so many times its length.
fn first_hit(body: &ExactMesh, ray: &Vector3, max: f64) -> Option<SurfaceSample> {
    let cast = Ray::new(Vector::ZERO, parry_vector(ray));
    let hit = body.shape().cast_local_ray_and_get_normal(&cast, max, false)?;
    let triangle = hit.subshape as usize;
    Some(SurfaceSample {
        position: Point3::from(ray * hit.time_of_impact),
        normal: scaled_normal(&body.mesh().corners(triangle)).normalize(),
        triangle,
    })
}
